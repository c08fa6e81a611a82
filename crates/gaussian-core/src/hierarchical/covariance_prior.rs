use nalgebra::DMatrix;
use statrs::function::gamma::ln_gamma;
use wayfix_estimation_traits::LogWeight;

use crate::{GaussianError, check_covariance, cholesky, gaussian::check_dimension, symmetrize};

/// The inverse-Wishart distribution $`W^{-1}(Ψ, ν)`$ of a covariance, its conjugate prior. [Gelman et al. 2003, appendix A]
///
/// $`p(Σ) ∝ |Σ|^{-(ν + d + 1)/2}\, e^{-\frac12 \mathrm{tr}(Ψ Σ^{-1})}`$
///
/// In the estimation of a covariance it counts as $`ν + d + 1`$ prior groups whose mean scatter is the mode, $`Ψ / (ν + d + 1)`$.
/// A density with an integral is worth at least $`2d`$ of them, which outvotes small collections; fewer are allowed: the estimate is proper
/// all the same, only the constant in the density is then taken as 1.
///
/// ```
/// use nalgebra::DMatrix;
/// use wayfix_gaussian_core::InverseWishart;
/// let weak = InverseWishart::from_mode(&DMatrix::from_diagonal_element(2, 2, 0.5), 3.0)?;
/// assert_eq!((weak.scale()[(0, 0)], weak.degrees_of_freedom()), (1.5, 0.0));
/// let at_mode = weak.log_density(&weak.mode())?;
/// assert!(at_mode > weak.log_density(&(weak.mode() * 1.1))?);
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
    /// Returns an error if the scale is not a covariance, or $`ν`$ is not above $`-(d + 1)`$ (there would be no mode) or not finite.
    pub fn new(mut scale: DMatrix<f64>, degrees_of_freedom: f64) -> Result<Self, GaussianError> {
        check_covariance("scale", &scale)?;
        symmetrize(&mut scale);
        if !(degrees_of_freedom > -(scale.nrows() as f64) - 1.0 && degrees_of_freedom.is_finite()) {
            let range = "finite and above the negative of the dimension plus 1";
            let what = "degrees of freedom";
            return Err(GaussianError::Parameter { what, value: degrees_of_freedom, range });
        }
        let log_normalizer = log_normalizer(&scale, degrees_of_freedom)?;
        Ok(Self { scale, degrees_of_freedom, log_normalizer })
    }

    /// From the mode of the covariance and its equivalent number of groups, $`ν + d + 1`$.
    ///
    /// # Errors
    /// As for [`new`](Self::new): `pseudo_groups` has to be positive and finite.
    pub fn from_mode(mode: &DMatrix<f64>, pseudo_groups: f64) -> Result<Self, GaussianError> {
        if !(pseudo_groups > 0.0 && pseudo_groups.is_finite()) {
            let (what, range) = ("pseudo-groups", "positive and finite");
            return Err(GaussianError::Parameter { what, value: pseudo_groups, range });
        }
        Self::new(mode * pseudo_groups, pseudo_groups - mode.nrows() as f64 - 1.0)
    }

    /// The scale matrix $`Ψ`$.
    pub fn scale(&self) -> &DMatrix<f64> {
        &self.scale
    }

    /// The degrees of freedom $`ν`$.
    pub fn degrees_of_freedom(&self) -> f64 {
        self.degrees_of_freedom
    }

    /// The mode: $`Ψ / (ν + d + 1)`$.
    pub fn mode(&self) -> DMatrix<f64> {
        &self.scale / self.pseudo_groups()
    }

    /// $`\log p(Σ)`$ in nats.
    ///
    /// # Errors
    /// Returns an error if `covariance` has another dimension or is not a covariance.
    pub fn log_density(&self, covariance: &DMatrix<f64>) -> Result<LogWeight, GaussianError> {
        check_dimension("covariance", self.scale.nrows(), covariance.nrows())?;
        check_covariance("given", covariance)?;
        let factor = cholesky("given", covariance)?;
        let trace = factor.solve(&self.scale).trace();
        Ok(self.log_normalizer - 0.5 * (self.pseudo_groups() * factor.ln_determinant() + trace))
    }

    /// The equivalent number of groups of the prior in the estimation of a covariance.
    pub fn pseudo_groups(&self) -> f64 {
        self.degrees_of_freedom + self.scale.nrows() as f64 + 1.0
    }
}

/// Of a proper density; 0 for an improper one.
fn log_normalizer(scale: &DMatrix<f64>, degrees_of_freedom: f64) -> Result<LogWeight, GaussianError> {
    let d = scale.nrows() as f64;
    if degrees_of_freedom <= d - 1.0 {
        return Ok(0.0);
    }
    let half = 0.5 * degrees_of_freedom;
    let log_multivariate_gamma = 0.25 * d * (d - 1.0) * std::f64::consts::PI.ln()
        + (0..scale.nrows()).map(|i| ln_gamma(half - 0.5 * i as f64)).sum::<f64>();
    Ok(half * (cholesky("scale", scale)?.ln_determinant() - d * std::f64::consts::LN_2)
        - log_multivariate_gamma)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn priors_without_a_mode_are_refused() {
        let identity = DMatrix::identity(3, 3);
        for bad in [-4.0, -7.0, f64::NAN, f64::INFINITY] {
            assert!(InverseWishart::new(identity.clone(), bad).is_err(), "{bad} degrees of freedom");
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(InverseWishart::from_mode(&identity, bad).is_err(), "{bad} pseudo-groups");
        }
        assert!(InverseWishart::new(-identity.clone(), 4.0).is_err());
        assert!(InverseWishart::new(DMatrix::from_element(2, 3, 1.0), 4.0).is_err());
        assert!(InverseWishart::new(identity, 4.0).unwrap().log_density(&DMatrix::identity(2, 2)).is_err());
    }
}
