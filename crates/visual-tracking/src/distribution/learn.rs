use nalgebra::{Cholesky, SMatrix};

use super::{COLOR_DIM, ColorDynamics, ColorStateVector};
use crate::TrackingError;

type Square = SMatrix<f64, COLOR_DIM, COLOR_DIM>;

/// Colour dynamics learned from a training sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct LearnedColorDynamics {
    /// $`A`$ and $`B`$.
    pub dynamics: ColorDynamics,
    /// Covariance of the residuals of the dynamics, $`L Lᵀ`$.
    pub residual_covariance: SMatrix<f64, COLOR_DIM, COLOR_DIM>,
    /// Number of steps in the training sequences.
    pub n_steps: usize,
}

impl ColorDynamics {
    /// Estimates $`A`$ and $`B`$ from the states of training sequences by least squares:
    /// $`\min_F \sum_t \| \mathbf x_t - F_x \mathbf x_{t-1} - F_v \dot{\mathbf x}_{t-1} \|^2 + κ \| F - F_0 \|^2`$, and $`L Lᵀ`$ is the
    /// covariance of the residuals. [Andrade-Cetto 2005, Sec. 3.3: "A and B are estimated a priori from a training sequence"]
    ///
    /// `ridge` $`κ ≥ 0`$ pulls towards $`F_0`$, constant velocity: a quantity constant in the training sequence then stays constant. It is
    /// in units of the squared states; 0 is plain least squares and needs sequences in which all 16 numbers vary. The angles must be accumulated from
    /// image to image ([`PrincipalColors::angles_since`](super::PrincipalColors::angles_since)).
    ///
    /// Each sequence has one state for every image: a gap, such as a lost target, ends it. Three states give one step.
    ///
    /// # Errors
    /// Returns [`TrackingError::Empty`] with less than 16 steps (16 unknowns a row), [`TrackingError::NotFinite`], and
    /// [`TrackingError::Parameter`] for a negative ridge or, with ridge 0, for sequences that leave something open.
    pub fn learn(
        sequences: &[impl AsRef<[ColorStateVector]>],
        ridge: f64,
    ) -> Result<LearnedColorDynamics, TrackingError> {
        crate::error::checked("ridge", ridge, ridge.is_finite() && ridge >= 0.0, "finite, not negative")?;
        let windows = || sequences.iter().flat_map(|sequence| sequence.as_ref().windows(3));
        let n_steps = windows().count();
        if n_steps < 2 * COLOR_DIM {
            return Err(TrackingError::Empty { what: "training sequence of 16 steps" });
        }
        for (index, state) in sequences.iter().flat_map(AsRef::as_ref).enumerate() {
            if let Some(&value) = state.iter().find(|value| !value.is_finite() || value.abs() > 1e100) {
                return Err(TrackingError::NotFinite { what: "colour state", index, value });
            }
        }
        // Residuals of constant velocity: their regression on the state is F - F_0.
        let steps = || windows().map(|x| (regressor(&x[0], &x[1]), x[2] - (x[1] * 2.0 - x[0])));
        let mut gram = SMatrix::<f64, 16, 16>::identity() * ridge;
        let mut cross = SMatrix::<f64, 16, COLOR_DIM>::zeros();
        for (s, left) in steps() {
            gram += s * s.transpose();
            cross += s * left.transpose();
        }
        let unsettled =
            TrackingError::Parameter { what: "ridge", value: ridge, range: "larger for this sequence" };
        let factor = Cholesky::new(gram).filter(well_conditioned).ok_or(unsettled)?;
        let change = factor.solve(&cross).transpose();
        let mut residual_covariance = Square::zeros();
        for (s, left) in steps() {
            let residual = left - change * s;
            residual_covariance += residual * residual.transpose();
        }
        // A row has 16 unknowns, which the residuals have lost.
        residual_covariance /= (n_steps.saturating_sub(2 * COLOR_DIM)).max(1) as f64;
        let from_value = Square::identity() + change.fixed_columns::<COLOR_DIM>(0);
        let from_velocity = Square::identity() + change.fixed_columns::<COLOR_DIM>(COLOR_DIM);
        let noise = square_root(&residual_covariance);
        let dynamics = Self::from_matrices(from_value, from_velocity, noise)?;
        Ok(LearnedColorDynamics { dynamics, residual_covariance, n_steps })
    }
}

/// $`[\mathbf x; \dot{\mathbf x}]`$.
fn regressor(before: &ColorStateVector, now: &ColorStateVector) -> SMatrix<f64, 16, 1> {
    SMatrix::from_fn(
        |row, _| if row < COLOR_DIM { now[row] } else { now[row - COLOR_DIM] - before[row - COLOR_DIM] },
    )
}

/// Whether the ratio of the pivots is below 1e12, so that at least four digits of the solution are accurate.
fn well_conditioned(factor: &Cholesky<f64, nalgebra::Const<16>>) -> bool {
    let pivots = factor.l_dirty().diagonal();
    pivots.min() > pivots.max() * 1e-6
}

/// The symmetric root, which exists for a covariance of any rank.
fn square_root(covariance: &Square) -> Square {
    let eigen = covariance.symmetric_eigen();
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    eigen.eigenvectors * Square::from_diagonal(&roots) * eigen.eigenvectors.transpose()
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::ColorDistributionState;

    /// A stable, coupled truth.
    fn truth() -> ColorDynamics {
        let from_value =
            Square::from_fn(|i, j| if i == j { 0.8 } else { 0.02 * (i as f64 - j as f64) / 8.0 });
        let noise = Square::from_fn(|i, j| {
            if i == j {
                0.02
            } else if i == j + 1 {
                0.005
            } else {
                0.0
            }
        });
        ColorDynamics::from_matrices(from_value, Square::identity() * 0.3, noise).unwrap()
    }

    fn series(n: usize, seed: u64) -> Vec<ColorStateVector> {
        let (truth, mut rng) = (truth(), ChaCha8Rng::seed_from_u64(seed));
        let mut state =
            ColorDistributionState { value: ColorStateVector::zeros(), velocity: ColorStateVector::zeros() };
        let mut next = || {
            state = truth.propagate(&state, &mut rng);
            state.value
        };
        (0..n).map(|_| next()).collect()
    }

    /// The standard error of a least-squares coefficient is sqrt(q / (n v)), with v the variance of its regressor given all others. Given
    /// the state before, a state varies by the noise of one step, so v is about q and the error 1/sqrt(n); that the regressors are state and
    /// difference instead of two states, and that the noise is correlated, costs a factor of two at most here.
    #[test]
    fn known_dynamics_are_recovered_within_the_sampling_error() {
        let n = 20_000;
        let learned = ColorDynamics::learn(&[series(n, 3)], 0.0).unwrap();
        let standard_error = 1.0 / (n as f64).sqrt();
        let difference = learned.dynamics.transition() - truth().transition();
        // The largest of 256 numbers almost always lies within five standard errors.
        assert!(difference.amax() < 10.0 * standard_error, "{}", difference.amax());
        let noise = truth().noise();
        let covariance = noise * noise.transpose();
        let got = learned.dynamics.noise() * learned.dynamics.noise().transpose();
        assert!((got - covariance).amax() < 0.05 * covariance.amax());
    }

    #[test]
    fn a_gap_between_sequences_is_no_step() {
        let whole = series(4_000, 4);
        let learned = ColorDynamics::learn(&[&whole[..2_000], &whole[2_100..]], 0.0).unwrap();
        assert_eq!(learned.n_steps, 1_998 + 1_898);
        // The states before and after the gap differ by some ten times the noise of a step; read as one sequence, they inflate it.
        let noise = truth().noise().fixed_rows::<COLOR_DIM>(0).into_owned();
        let ratio = learned.residual_covariance.trace() / (noise * noise.transpose()).trace();
        // The standard error of the trace is below that of one variance, sqrt(2/n) = 0.023.
        assert_abs_diff_eq!(ratio, 1.0, epsilon = 5.0 * 0.023);
        let fifteen: Vec<&[ColorStateVector]> = whole.chunks(3).take(15).collect();
        assert!(matches!(ColorDynamics::learn(&fifteen, 1.0), Err(TrackingError::Empty { .. })));
    }

    #[test]
    fn a_sequence_that_stands_still_needs_a_ridge_and_then_stays() {
        let still = vec![ColorStateVector::repeat(0.5); 50];
        assert!(ColorDynamics::learn(&[&still], 0.0).is_err());
        let learned = ColorDynamics::learn(&[&still], 1e-3).unwrap();
        let state = ColorDistributionState {
            value: ColorStateVector::repeat(0.5),
            velocity: ColorStateVector::zeros(),
        };
        assert_abs_diff_eq!(learned.dynamics.expected(&state).value, state.value, epsilon = 1e-9);
        assert!(ColorDynamics::learn(&[&still[..17]], 1.0).is_err());
        assert!(ColorDynamics::learn(&[&still], f64::NAN).is_err());
    }
}
