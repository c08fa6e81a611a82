use nalgebra::{DMatrix, DVector};
use wayfix_estimation_traits::LogWeight;

use super::em::Expectation;
use crate::{
    Gaussian, GaussianError, HierarchicalGaussianParams, IterationError, PooledGroupEstimate,
    gaussian::check_dimension,
};

/// A Gaussian estimated from groups, and the course of the iteration.
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchicalGaussianFit {
    /// $`N(μ, Σ)`$: the distribution of a new group's $`θ`$.
    pub gaussian: Gaussian<DVector<f64>>,
    /// $`\log p(y, μ, Σ)`$ in nats, at the start and after every iteration; it never falls, but for rounding.
    pub objective: Vec<LogWeight>,
}

impl HierarchicalGaussianFit {
    /// How many steps of EM were made.
    pub fn iterations(&self) -> usize {
        self.objective.len() - 1
    }
}

/// Estimates the distribution of groups from their observations: the mode of $`p(μ, Σ \mid y)`$. [Schulz & Fox 2004, Eq. 10, Fig. 2]
///
/// Group $`j`$ has its own $`θ_j ∼ N(μ, Σ)`$ and shows some of its coordinates through noise. The $`θ_j`$ are integrated out in closed
/// form, and $`\log p(y \mid μ, Σ) + \log p(μ, Σ)`$ climbs by expectation maximization [Dempster, Laird & Rubin 1977], every step of which
/// is at least as high as the one before. Coordinates not seen are taken as missing at random. Groups without any observation have no effect.
/// Where much is missing there may be several optima; this finds the one above independent coordinates, from where it starts.
///
/// ```
/// use wayfix_gaussian_core::{PooledGroupEstimate, HierarchicalGaussianParams, fit_hierarchical};
/// let mut groups = vec![PooledGroupEstimate::new(2); 4];
/// for (group, values) in groups.iter_mut().zip([[1.0, 1.0], [3.0, 2.0], [1.0, 2.0], [3.0, 3.0]]) {
///     group.observe(&[0, 1], &values, &[0.0, 0.0])?;
/// }
/// // Without noise, gaps and hyperpriors: the sample mean and covariance.
/// let fit = fit_hierarchical(&groups, &HierarchicalGaussianParams::default())?;
/// assert!((fit.gaussian.mean()[1] - 2.0).abs() < 1e-12 && (fit.gaussian.covariance()[(0, 1)] - 0.5).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IterationError::NotConverged`] with the fit so far. [`IterationError::Step`] when sizes differ or a parameter is out of range; without a
/// hyperprior of $`Σ`$ when there are no more groups than coordinates ([`GaussianError::TooFew`]: the covariance would be singular) or a
/// covariance becomes singular on the way; without a hyperprior of $`μ`$ when no group shows some coordinate.
pub fn fit_hierarchical(
    groups: &[PooledGroupEstimate],
    params: &HierarchicalGaussianParams,
) -> Result<HierarchicalGaussianFit, IterationError<Box<HierarchicalGaussianFit>>> {
    let groups = check(groups, params)?;
    let mut gaussian = start(&groups, params)?;
    let mut objective = Vec::new();
    loop {
        let expectation = Expectation::new(&groups, params, &gaussian)?;
        objective.push(expectation.objective);
        let left = left_to_gain(&objective);
        if left <= params.tolerance {
            return Ok(HierarchicalGaussianFit { gaussian, objective });
        }
        let iterations = objective.len() - 1;
        if iterations >= params.max_iterations {
            let last = Box::new(HierarchicalGaussianFit { gaussian, objective });
            return Err(IterationError::NotConverged {
                what: "hierarchical Gaussian",
                last,
                iterations,
                step: left,
            });
        }
        gaussian = expectation.maximize(params, &gaussian)?;
    }
}

/// The groups with observations, if they and the hyperpriors together determine a Gaussian.
fn check<'a>(
    groups: &'a [PooledGroupEstimate],
    params: &HierarchicalGaussianParams,
) -> Result<Vec<&'a PooledGroupEstimate>, GaussianError> {
    let Some(first) = groups.first() else { return Err(GaussianError::Empty { what: "groups" }) };
    let dimension = first.dimension();
    params.check(dimension)?;
    for group in groups {
        check_dimension("group", dimension, group.dimension())?;
    }
    let speaking: Vec<_> = groups.iter().filter(|group| group.observed().next().is_some()).collect();
    if params.covariance_prior.is_none() && speaking.len() <= dimension {
        let what = "groups with observations";
        return Err(GaussianError::TooFew { what, needed: dimension + 1, got: speaking.len() });
    }
    let unseen = |index: &usize| speaking.iter().all(|group| group.estimate(*index).is_none());
    if params.mean_prior.is_none()
        && let Some(coordinate) = (0..dimension).find(unseen)
    {
        return Err(GaussianError::Unobserved { coordinate });
    }
    Ok(speaking)
}

/// Independent coordinates, each with the moments of its own pooled observations and of the hyperpriors.
fn start(
    groups: &[&PooledGroupEstimate],
    params: &HierarchicalGaussianParams,
) -> Result<Gaussian<DVector<f64>>, GaussianError> {
    let dimension = groups.first().map_or_else(
        || params.mean_prior.as_ref().map_or(0, |prior| prior.mean.len()),
        |group| group.dimension(),
    );
    let mut mean = DVector::zeros(dimension);
    let mut variances = DVector::zeros(dimension);
    for index in 0..dimension {
        let values: Vec<f64> =
            groups.iter().filter_map(|group| group.estimate(index)).map(|(value, _)| value).collect();
        let (m, kappa) =
            params.mean_prior.as_ref().map_or((0.0, 0.0), |prior| (prior.mean[index], prior.pseudo_groups));
        let n = values.len() as f64;
        mean[index] = (values.iter().sum::<f64>() + kappa * m) / (n + kappa);
        let scatter: f64 = values.iter().map(|value| (value - mean[index]).powi(2)).sum();
        let (psi, earlier) = params
            .covariance_prior
            .as_ref()
            .map_or((0.0, 0.0), |prior| (prior.scale()[(index, index)], prior.pseudo_groups()));
        variances[index] = (scatter + psi) / (n + earlier);
    }
    Gaussian::new(mean, DMatrix::from_diagonal(&variances))
}

/// Aitken's estimate of what further iterations gain, if the gains continue as a geometric series. [Böhning et al. 1994]
fn left_to_gain(objective: &[LogWeight]) -> f64 {
    let [.., before, last, now] = objective else { return f64::INFINITY };
    let (earlier, gain) = (last - before, now - last);
    // Below the rounding of the objective itself, a gain cannot be distinguished from none.
    if gain.abs() <= 16.0 * f64::EPSILON * now.abs() {
        return 0.0;
    }
    let rate = gain / earlier;
    if rate < 1.0 { gain * rate / (1.0 - rate) } else { f64::INFINITY }
}
