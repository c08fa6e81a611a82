use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use rand::Rng;

use super::deviate::{normal, not_zero, unit};
use crate::{SimulationError, check};

/// Distribution of a white error; always of mean 0 and variance 1, so that a stated σ is the standard deviation.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::random::NoiseShape;
/// let mut rng = ChaCha8Rng::seed_from_u64(7);
/// let mut far = |shape: NoiseShape| (0..10_000).filter(|_| shape.draw(&mut rng).abs() > 4.0).count();
/// assert!(far(NoiseShape::Laplace) > 10 * far(NoiseShape::Gaussian).max(1)); // 35 and 0.6 expected
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum NoiseShape {
    /// $`e^{-x^2/2}`$.
    #[default]
    Gaussian,
    /// $`e^{-\sqrt 2 |x|}`$: a sharp peak and exponential tails.
    Laplace,
    /// $`(1 + x^2/ν)^{-(ν+1)/2}`$, scaled to variance 1: power-law tails.
    StudentT {
        /// ν, above 2 (below, the variance is infinite).
        degrees_of_freedom: f64,
    },
}

impl NoiseShape {
    /// One error; two draws whatever the shape. Student's t by [Bailey 1994, Eq. 2].
    pub fn draw<R: Rng + ?Sized>(self, rng: &mut R) -> f64 {
        match self {
            Self::Gaussian => normal(rng),
            Self::Laplace => {
                let (size, side) = (-libm::log(not_zero(rng)) * FRAC_1_SQRT_2, unit(rng));
                if side < 0.5 { size } else { -size }
            }
            Self::StudentT { degrees_of_freedom: nu } => {
                let (radius, angle) = (not_zero(rng), unit(rng));
                let t = (nu * (libm::pow(radius, -2.0 / nu) - 1.0)).sqrt() * libm::cos(TAU * angle);
                t * ((nu - 2.0) / nu).sqrt()
            }
        }
    }

    pub(crate) fn validate(self) -> Result<(), SimulationError> {
        match self {
            Self::StudentT { degrees_of_freedom } => {
                check::above("degrees of freedom", degrees_of_freedom, 2.0, "finite and above 2")
            }
            Self::Gaussian | Self::Laplace => Ok(()),
        }
    }
}
