use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{LogWeight, Manifold, StateAlloc, to_f64};

use super::{GaussianMixture, log_sum_exp, prune::check_max_components};
use crate::{Gaussian, GaussianError, IterationError, cholesky, moment_matched};

impl<X: Manifold> GaussianMixture<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// Merges pairs until at most `most` components are left, each time the pair that costs least by Runnalls' bound.
    ///
    /// $`B_{ij} = \tfrac12 \big((w_i + w_j) \log\det Σ_{ij} - w_i \log\det Σ_i - w_j \log\det Σ_j\big)`$ bounds the Kullback-Leibler divergence that
    /// the merge adds. Mean and covariance of the mixture stay as they are (on vectors exactly). [Runnalls 2007]
    ///
    /// ```
    /// use nalgebra::Vector1;
    /// use wayfix_gaussian_core::{Gaussian, GaussianMixture};
    /// let at = |x: f64| Gaussian::from_sigmas(Vector1::new(x), &Vector1::new(1.0));
    /// let mixture = GaussianMixture::from_weights(vec![(1.0, at(0.0)?), (1.0, at(9.0)?), (1.0, at(0.2)?)])?;
    /// let reduced = mixture.reduce_runnalls(2)?;
    /// assert!((reduced.components()[0].mean()[0] - 0.1).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if `most` is 0, a covariance (unchecked) is not positive definite or a merge finds no mean.
    pub fn reduce_runnalls(self, most: usize) -> Result<Self, IterationError<X>> {
        check_max_components(most)?;
        let mut hypotheses =
            self.into_log_weighted().into_iter().map(Hypothesis::new).collect::<Result<Vec<_>, _>>()?;
        let mut costs: Vec<Vec<f64>> = Vec::new();
        for i in 0..hypotheses.len() {
            let row: Result<_, IterationError<X>> =
                (0..i).map(|j| hypotheses[i].cost(&hypotheses[j])).collect();
            costs.push(row?);
        }
        while hypotheses.len() > most {
            let (i, j) = cheapest(&costs);
            hypotheses[j] = hypotheses[i].merged(&hypotheses[j])?;
            hypotheses.remove(i);
            costs.remove(i);
            costs.iter_mut().skip(i).for_each(|row| {
                row.remove(i);
            });
            for k in 0..hypotheses.len() {
                if k != j {
                    costs[k.max(j)][k.min(j)] = hypotheses[j].cost(&hypotheses[k])?;
                }
            }
        }
        let weighted = hypotheses.into_iter().map(|h| (h.log_weight, h.gaussian)).collect();
        Ok(Self::from_log_weights(weighted)?)
    }
}

/// The pair `(i, j)`, `j < i`, of least cost, the first among equals.
fn cheapest(costs: &[Vec<f64>]) -> (usize, usize) {
    let pairs = costs.iter().enumerate().flat_map(|(i, row)| (0..row.len()).map(move |j| (i, j)));
    pairs.min_by(|a, b| costs[a.0][a.1].total_cmp(&costs[b.0][b.1])).unwrap_or((1, 0))
}

/// A component with the logarithm of its determinant, which every cost needs.
struct Hypothesis<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    log_weight: LogWeight,
    gaussian: Gaussian<X>,
    log_determinant: f64,
}

impl<X: Manifold> Hypothesis<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    fn new((log_weight, gaussian): (LogWeight, Gaussian<X>)) -> Result<Self, GaussianError> {
        let log_determinant = to_f64(cholesky("component", gaussian.covariance())?.ln_determinant());
        Ok(Self { log_weight, gaussian, log_determinant })
    }

    fn merged(&self, other: &Self) -> Result<Self, IterationError<X>> {
        Ok(Self::new(merge_pair((self.log_weight, &self.gaussian), (other.log_weight, &other.gaussian))?)?)
    }

    fn cost(&self, other: &Self) -> Result<f64, IterationError<X>> {
        let (wi, wj) = (self.log_weight.exp(), other.log_weight.exp());
        let merged = self.merged(other)?;
        Ok(0.5
            * ((wi + wj) * merged.log_determinant - wi * self.log_determinant - wj * other.log_determinant))
    }
}

/// One component with the weight, mean and covariance of two.
pub(super) fn merge_pair<X: Manifold>(
    (first_weight, first): (LogWeight, &Gaussian<X>),
    (second_weight, second): (LogWeight, &Gaussian<X>),
) -> Result<(LogWeight, Gaussian<X>), IterationError<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let log_weight = log_sum_exp(&[first_weight, second_weight]);
    if log_weight == f64::NEG_INFINITY {
        return Ok((log_weight, first.clone())); // two hypotheses of zero weight
    }
    let shares = [(first_weight - log_weight).exp(), (second_weight - log_weight).exp()];
    Ok((log_weight, moment_matched(&shares, &[first.clone(), second.clone()])?))
}
