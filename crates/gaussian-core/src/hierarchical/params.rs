use nalgebra::DVector;

use crate::{GaussianError, InverseWishart, gaussian::check_dimension};

/// How a hierarchical Gaussian is fitted: hyperpriors and when to stop. The default has flat hyperpriors.
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchicalGaussianParams {
    /// Hyperprior of $`Σ`$; without it there must be more groups than coordinates. Default none: flat.
    pub covariance_prior: Option<InverseWishart>,
    /// Hyperprior of $`μ`$; without it every coordinate must be seen in some group. Default none: flat.
    pub mean_prior: Option<MeanPrior>,
    /// Stop when by Aitken's estimate fewer nats than this are left to gain. Default 1e-9: the estimate is then about
    /// $`\sqrt{2·10^{-9}/N}`$ standard deviations from the optimum.
    pub tolerance: f64,
    /// Give up after so many iterations. Default 10 000.
    pub max_iterations: usize,
}

impl Default for HierarchicalGaussianParams {
    fn default() -> Self {
        Self { covariance_prior: None, mean_prior: None, tolerance: 1e-9, max_iterations: 10_000 }
    }
}

/// $`μ ∼ N(m, Σ/κ)`$: worth $`κ`$ earlier groups whose mean was $`m`$. With an [`InverseWishart`] the two are a
/// normal-inverse-Wishart hyperprior.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanPrior {
    /// $`m`$.
    pub mean: DVector<f64>,
    /// $`κ`$, positive; a weak prior has much less than 1.
    pub pseudo_groups: f64,
}

impl HierarchicalGaussianParams {
    pub(super) fn check(&self, dimension: usize) -> Result<(), GaussianError> {
        if let Some(prior) = &self.covariance_prior {
            check_dimension("covariance prior", dimension, prior.scale().nrows())?;
        }
        if let Some(prior) = &self.mean_prior {
            check_dimension("mean prior", dimension, prior.mean.len())?;
            if !prior.mean.iter().all(|entry| entry.is_finite()) {
                return Err(GaussianError::NotFinite { what: "mean of the mean prior" });
            }
            check_positive("pseudo-groups of the mean prior", prior.pseudo_groups)?;
        }
        check_positive("tolerance", self.tolerance)
    }
}

fn check_positive(what: &'static str, value: f64) -> Result<(), GaussianError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(GaussianError::Parameter { what, value, range: "positive and finite" })
    }
}
