use nalgebra::DMatrix;
use statrs::function::gamma::ln_gamma;
use wayfix_estimation_traits::LogWeight;

use crate::{GaussianError, check_covariance, cholesky, gaussian::check_dimension, symmetrize};

/// The inverse-Wishart distribution $`W^{-1}(Ψ, ν)`$ of a covariance, its conjugate prior. [Gelman et al. 2003, appendix A]
///
/// $`p(Σ) ∝ |Σ|^{-(ν + d + 1)/2}\, e^{-\frac12 \mathrm{tr}(Ψ Σ^{-1})}`$
///
/// It counts like $`ν + d + 1`$ earlier groups with the mean scatter $`Ψ / (ν + d + 1)`$, its mode.
///
/// ```
/// use nalgebra::DMatrix;
/// use wayfix_gaussian_core::InverseWishart;
/// let prior = InverseWishart::from_mode(&DMatrix::from_diagonal_element(2, 2, 0.5), 4.0)?;
/// assert_eq!(prior.scale()[(0, 0)], 0.5 * (4.0 + 2.0 + 1.0));
/// let at_mode = prior.log_density(&prior.mode())?;
/// assert!(at_mode > prior.log_density(&(prior.mode() * 1.1))?);
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct InverseWishart {
    scale: DMatrix<f64>,
    degrees_of_freedom: f64,
    log_normalizer: f64,
}

impl InverseWishart {
    /// By its scale matrix $`Ψ`$ and degrees of freedom $`ν`$.
    ///
    /// # Errors
    /// When the scale is not a covariance, or $`ν`$ is not above $`d - 1`$ (the density would have no integral) or not finite.
    pub fn new(mut scale: DMatrix<f64>, degrees_of_freedom: f64) -> Result<Self, GaussianError> {
        check_covariance("scale", &scale)?;
        symmetrize(&mut scale);
        let d = scale.nrows() as f64;
        if !(degrees_of_freedom > d - 1.0 && degrees_of_freedom.is_finite()) {
            let range = "finite and above the dimension less 1";
            return Err(GaussianError::Parameter {
                what: "degrees of freedom",
                value: degrees_of_freedom,
                range,
            });
        }
        let half = 0.5 * degrees_of_freedom;
        let log_multivariate_gamma = 0.25 * d * (d - 1.0) * std::f64::consts::PI.ln()
            + (0..scale.nrows()).map(|i| ln_gamma(half - 0.5 * i as f64)).sum::<f64>();
        let log_normalizer = half
            * (cholesky("scale", &scale)?.ln_determinant() - d * std::f64::consts::LN_2)
            - log_multivariate_gamma;
        Ok(Self { scale, degrees_of_freedom, log_normalizer })
    }

    /// By the covariance at which the density is highest.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn from_mode(mode: &DMatrix<f64>, degrees_of_freedom: f64) -> Result<Self, GaussianError> {
        Self::new(mode * (degrees_of_freedom + mode.nrows() as f64 + 1.0), degrees_of_freedom)
    }

    /// The scale matrix $`Ψ`$.
    pub fn scale(&self) -> &DMatrix<f64> {
        &self.scale
    }

    /// The degrees of freedom $`ν`$.
    pub fn degrees_of_freedom(&self) -> f64 {
        self.degrees_of_freedom
    }

    /// Where the density is highest: $`Ψ / (ν + d + 1)`$.
    pub fn mode(&self) -> DMatrix<f64> {
        &self.scale / self.pseudo_groups()
    }

    /// $`\log p(Σ)`$ in nats.
    ///
    /// # Errors
    /// When `covariance` has another dimension or is not a covariance.
    pub fn log_density(&self, covariance: &DMatrix<f64>) -> Result<LogWeight, GaussianError> {
        check_dimension("covariance", self.scale.nrows(), covariance.nrows())?;
        check_covariance("given", covariance)?;
        let factor = cholesky("given", covariance)?;
        let trace = factor.solve(&self.scale).trace();
        Ok(self.log_normalizer - 0.5 * (self.pseudo_groups() * factor.ln_determinant() + trace))
    }

    /// How many groups the prior is worth where a covariance is estimated.
    pub(super) fn pseudo_groups(&self) -> f64 {
        self.degrees_of_freedom + self.scale.nrows() as f64 + 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn improper_priors_are_refused() {
        let identity = DMatrix::identity(3, 3);
        for bad in [2.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(InverseWishart::new(identity.clone(), bad).is_err(), "{bad} degrees of freedom");
        }
        assert!(InverseWishart::new(-identity.clone(), 4.0).is_err());
        assert!(InverseWishart::new(DMatrix::from_element(2, 3, 1.0), 4.0).is_err());
        assert!(InverseWishart::new(DMatrix::zeros(0, 0), 4.0).is_ok(), "a point has one covariance");
        assert!(InverseWishart::new(identity, 4.0).unwrap().log_density(&DMatrix::identity(2, 2)).is_err());
    }
}
