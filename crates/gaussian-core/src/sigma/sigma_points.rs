use nalgebra::{DefaultAllocator, Dim};
use wayfix_estimation_traits::{Manifold, StateAlloc, to_f64};

use crate::{Gaussian, GaussianError, cholesky};

/// Spread and weights of the sigma points. [Wan & van der Merwe 2000]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnscentedParams {
    /// Spread: the points lie $`α \sqrt{n + κ}`$ sigmas out. Positive.
    pub alpha: f64,
    /// Weight of the centre in the covariance; 2 is best for Gaussians.
    pub beta: f64,
    /// Added to the dimension; above $`-n`$.
    pub kappa: f64,
}

/// `alpha` 1, `beta` 2, `kappa` 0: no weight is negative, so covariances come out positive definite, also in single precision.
impl Default for UnscentedParams {
    fn default() -> Self {
        Self { alpha: 1.0, beta: 2.0, kappa: 0.0 }
    }
}

/// $`2n + 1`$ points with weights that have the mean and covariance of a Gaussian.
///
/// $`χ_0 = μ`$, $`χ_{±i} = μ ⊞ (±\sqrt{n + λ}\, L e_i)`$, $`λ = α^2 (n + κ) - n`$
#[derive(Clone, Debug, PartialEq)]
pub struct SigmaPoints<X> {
    /// The centre first, then pairs.
    pub points: Vec<X>,
    /// Weights for means; they sum to one.
    pub mean_weights: Vec<f64>,
    /// Weights for covariances.
    pub covariance_weights: Vec<f64>,
}

impl<X: Manifold> SigmaPoints<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The sigma points of `gaussian`.
    ///
    /// ```
    /// use nalgebra::Vector2;
    /// use wayfix_gaussian_core::{Gaussian, SigmaPoints, UnscentedParams};
    /// let gaussian = Gaussian::from_sigmas(Vector2::new(1.0, 2.0), &Vector2::new(0.5, 1.0))?;
    /// let sigma = SigmaPoints::new(&gaussian, &UnscentedParams::default())?;
    /// assert_eq!(sigma.points.len(), 5);
    /// assert!((sigma.points[1] - Vector2::new(1.0 + 0.5 * 2.0_f64.sqrt(), 2.0)).norm() < 1e-15);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// When a parameter is out of range, the covariance (unchecked) is not positive definite, or a point goes more than half round a circle.
    pub fn new(gaussian: &Gaussian<X>, params: &UnscentedParams) -> Result<Self, GaussianError> {
        let n = gaussian.dim().value();
        let spread = params.spread_squared(n)?;
        let scaled = cholesky("sigma point", gaussian.covariance())?.l()
            * nalgebra::convert::<f64, X::Scalar>(spread.sqrt());
        let mut points = Vec::with_capacity(2 * n + 1);
        points.push(gaussian.mean().clone());
        for column in scaled.column_iter() {
            let offset = column.into_owned();
            for offset in [offset.clone(), -offset] {
                let point = gaussian.mean().retract(&offset);
                // A point that is nearer the other way round the circle would stand for something else.
                if to_f64(gaussian.mean().local(&point).dot(&offset)) < 0.0 {
                    let length = to_f64(offset.norm());
                    return Err(GaussianError::SigmaPointWraps { length });
                }
                points.push(point);
            }
        }
        let outer = 0.5 / spread;
        let centre = (spread - n as f64) / spread;
        let mut mean_weights = vec![outer; 2 * n + 1];
        mean_weights[0] = centre;
        let mut covariance_weights = mean_weights.clone();
        covariance_weights[0] = centre + 1.0 - params.alpha * params.alpha + params.beta;
        Ok(Self { points, mean_weights, covariance_weights })
    }
}

impl UnscentedParams {
    /// $`n + λ`$
    fn spread_squared(&self, n: usize) -> Result<f64, GaussianError> {
        let reject = |what, value, range| Err(GaussianError::Parameter { what, value, range });
        if !(self.alpha > 0.0 && self.alpha.is_finite()) {
            return reject("alpha", self.alpha, "positive and finite");
        }
        if !self.beta.is_finite() {
            return reject("beta", self.beta, "finite");
        }
        let order = n as f64 + self.kappa;
        if !(order > 0.0 && order.is_finite()) {
            return reject("kappa", self.kappa, "finite and above minus the dimension");
        }
        Ok(self.alpha * self.alpha * order)
    }
}
