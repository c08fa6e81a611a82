use nalgebra::{DMatrix, DVector};
use wayfix_estimation_traits::LogWeight;

use super::posterior::GroupPosterior;
use crate::{
    Gaussian, GaussianError, HierarchicalGaussianParams, MeanPrior, PooledGroupEstimate, cholesky, symmetrize,
};

/// The expected sufficient statistics of the groups under $`(μ, Σ)`$, summed, and $`\log p(μ, Σ, y)`$.
pub(super) struct Expectation {
    n_groups: f64,
    /// $`\sum_j E[θ_j - μ]`$.
    shift: DVector<f64>,
    /// $`\sum_j E[(θ_j - μ)(θ_j - μ)^T]`$.
    scatter: DMatrix<f64>,
    pub(super) objective: LogWeight,
}

impl Expectation {
    /// The expectation step, with $`θ_j`$ integrated out in closed form.
    pub(super) fn new(
        groups: &[&PooledGroupEstimate],
        params: &HierarchicalGaussianParams,
        estimate: &Gaussian<DVector<f64>>,
    ) -> Result<Self, GaussianError> {
        let (mean, covariance) = (estimate.mean(), estimate.covariance());
        let d = mean.len();
        let mut expectation = Self {
            n_groups: groups.len() as f64,
            shift: DVector::zeros(d),
            scatter: DMatrix::zeros(d, d),
            objective: log_hyperprior(params, mean, covariance)?,
        };
        for group in groups {
            let posterior = GroupPosterior::new(group, mean, covariance)?;
            expectation.scatter += posterior.covariance;
            expectation.scatter.ger(1.0, &posterior.shift, &posterior.shift, 1.0);
            expectation.shift += posterior.shift;
            expectation.objective += posterior.log_evidence;
        }
        if expectation.objective.is_finite() {
            Ok(expectation)
        } else {
            Err(GaussianError::NotFinite { what: "objective" })
        }
    }

    /// The maximization step: where $`E[\log p(μ, Σ, θ, y)]`$ is highest, a mean and a scatter in which the hyperpriors count as groups.
    pub(super) fn maximize(
        self,
        params: &HierarchicalGaussianParams,
        estimate: &Gaussian<DVector<f64>>,
    ) -> Result<Gaussian<DVector<f64>>, GaussianError> {
        let Self { n_groups, mut shift, mut scatter, .. } = self;
        let mut weight = n_groups;
        let mut n_scatters = n_groups;
        if let Some(MeanPrior { mean, pseudo_groups }) = &params.mean_prior {
            let deviation = mean - estimate.mean();
            scatter.ger(*pseudo_groups, &deviation, &deviation, 1.0);
            shift += deviation * *pseudo_groups;
            weight += pseudo_groups;
            n_scatters += 1.0; // N(m, Σ/κ) has one |Σ|, whatever κ
        }
        let step = shift / weight;
        scatter.ger(-weight, &step, &step, 1.0);
        if let Some(prior) = &params.covariance_prior {
            scatter += prior.scale();
            n_scatters += prior.pseudo_groups();
        }
        symmetrize(&mut scatter);
        Gaussian::new(estimate.mean() + step, scatter / n_scatters)
    }
}

fn log_hyperprior(
    params: &HierarchicalGaussianParams,
    mean: &DVector<f64>,
    covariance: &DMatrix<f64>,
) -> Result<LogWeight, GaussianError> {
    let of_covariance =
        params.covariance_prior.as_ref().map_or(Ok(0.0), |prior| prior.log_density(covariance))?;
    let of_mean = match &params.mean_prior {
        None => 0.0,
        Some(prior) => {
            let scaled = covariance / prior.pseudo_groups;
            Gaussian::from_parts_unchecked(prior.mean.clone(), scaled).log_density(mean)?
        }
    };
    cholesky("learned", covariance)?;
    Ok(of_covariance + of_mean)
}
