use nalgebra::{SMatrix, SVector};
use rand::{Rng, RngExt as _};
use rand_distr::StandardNormal;

use super::{COLOR_DIM, ColorDistributionState, ColorStateVector};
use crate::TrackingError;

type Square = SMatrix<f64, COLOR_DIM, COLOR_DIM>;

/// How colours change from one picture to the next: $`\mathbf s_t = A\, \mathbf s'_{t-1} + B\, \mathbf w_t`$ with
/// $`\mathbf s = [\mathbf x; \dot{\mathbf x}]`$ and standard normal $`\mathbf w`$. [Andrade-Cetto 2005, Sec. 3.3,
/// "Probabilistic propagation of samples"]
///
/// The velocity is the last change, so $`A`$ and $`B`$ have two equivalent block rows:
/// $`A = \begin{bmatrix} F_x & F_v \\ F_x - I & F_v \end{bmatrix}`$ and $`B = [L; L]`$.
///
/// ```
/// use rand::SeedableRng;
/// use wayfix_visual_tracking::{ColorDynamics, ColorDistributionState, ColorStateVector};
/// let dynamics = ColorDynamics::constant_velocity(1.0, &ColorStateVector::zeros())?;
/// let moving = ColorDistributionState { value: ColorStateVector::repeat(0.5), velocity: ColorStateVector::repeat(0.1) };
/// let next = dynamics.propagate(&moving, &mut rand_chacha::ChaCha8Rng::seed_from_u64(1));
/// assert!((next.value[0] - 0.6).abs() < 1e-12 && (next.velocity[0] - 0.1).abs() < 1e-12);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorDynamics {
    from_value: Square,
    from_velocity: Square,
    noise: Square,
}

impl ColorDynamics {
    /// $`F_x = I`$, $`F_v = d I`$: the velocity is kept, times a `damping` $`d`$ from 0 (a random walk) to 1. Every component of the state has noise
    /// with its own standard deviation per image.
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if a number is out of its range.
    pub fn constant_velocity(damping: f64, sigma: &ColorStateVector) -> Result<Self, TrackingError> {
        crate::error::probability("damping of the colour velocity", damping)?;
        for &sigma in sigma {
            let valid = sigma.is_finite() && sigma >= 0.0;
            crate::error::checked("noise of the colour state", sigma, valid, "finite, not negative")?;
        }
        Ok(Self {
            from_value: Square::identity(),
            from_velocity: Square::identity() * damping,
            noise: Square::from_diagonal(sigma),
        })
    }

    /// From $`F_x`$, $`F_v`$ and $`L`$.
    ///
    /// # Errors
    /// Returns [`TrackingError::NotFinite`].
    pub(crate) fn from_matrices(
        from_value: Square,
        from_velocity: Square,
        noise: Square,
    ) -> Result<Self, TrackingError> {
        for matrix in [&from_value, &from_velocity, &noise] {
            if let Some((index, &value)) = matrix.iter().enumerate().find(|(_, value)| !value.is_finite()) {
                return Err(TrackingError::NotFinite { what: "colour dynamics", index, value });
            }
        }
        Ok(Self { from_value, from_velocity, noise })
    }

    /// The deterministic part $`A`$, $`16 × 16`$.
    pub fn transition(&self) -> SMatrix<f64, 16, 16> {
        let mut transition = SMatrix::<f64, 16, 16>::zeros();
        for (row, from_value) in [(0, self.from_value), (COLOR_DIM, self.from_value - Square::identity())] {
            transition.fixed_view_mut::<COLOR_DIM, COLOR_DIM>(row, 0).copy_from(&from_value);
            transition.fixed_view_mut::<COLOR_DIM, COLOR_DIM>(row, COLOR_DIM).copy_from(&self.from_velocity);
        }
        transition
    }

    /// The factor of the noise $`B`$, $`16 × 8`$; $`B Bᵀ`$ is the covariance of the process noise.
    pub fn noise(&self) -> SMatrix<f64, 16, COLOR_DIM> {
        SMatrix::from_fn(|row, column| self.noise[(row % COLOR_DIM, column)])
    }

    /// The state after one picture without noise.
    pub fn expected(&self, state: &ColorDistributionState) -> ColorDistributionState {
        self.moved(state, ColorStateVector::zeros())
    }

    /// A state after one picture, drawn at random.
    pub fn propagate<R: Rng + ?Sized>(
        &self,
        state: &ColorDistributionState,
        rng: &mut R,
    ) -> ColorDistributionState {
        let w: ColorStateVector = SVector::from_fn(|_, _| rng.sample(StandardNormal));
        self.moved(state, self.noise * w)
    }

    fn moved(&self, state: &ColorDistributionState, noise: ColorStateVector) -> ColorDistributionState {
        let value = self.from_value * state.value + self.from_velocity * state.velocity + noise;
        ColorDistributionState { value, velocity: value - state.value }
    }
}
