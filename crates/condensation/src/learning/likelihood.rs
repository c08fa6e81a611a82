use wayfix_estimation_traits::LogWeight;

use crate::error::checked;
use crate::{AppearanceModel, CondensationError, N_DISTURBANCES};

const N: usize = N_DISTURBANCES;

/// How fast likelihood falls with the distance between measured and expected features.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LikelihoodTail {
    /// $`e^{-d^2 / 2}`$, as in the paper: a single jump of a feature excludes the true place permanently.
    Gaussian,
    /// $`(1 + d^2 / ν)^{-(ν + k) / 2}`$ for $`k`$ components: outliers count, but not for ever.
    StudentT {
        /// Degrees of freedom $`ν`$.
        dof: f64,
    },
}

impl Default for LikelihoodTail {
    /// Four degrees of freedom, the usual compromise in robust regression. [Lange et al. 1989]
    fn default() -> Self {
        Self::StudentT { dof: 4.0 }
    }
}

impl LikelihoodTail {
    pub(super) fn check(&self) -> Result<(), CondensationError> {
        let Self::StudentT { dof } = *self else { return Ok(()) };
        checked("degrees of freedom", dof, dof.is_finite() && dof > 0.0, "finite and positive").map(|_| ())
    }

    /// The log-density at a squared distance of `k` components, but for constants, and by what the noise of this measurement is to be
    /// multiplied so that an outlier does not bend the disturbance either.
    pub(super) fn weigh(self, squared_distance: f64, k: usize) -> (LogWeight, f64) {
        match self {
            Self::Gaussian => (-0.5 * squared_distance, 1.0),
            Self::StudentT { dof } => {
                let n = dof + k as f64;
                (-0.5 * n * (squared_distance / dof).ln_1p(), ((dof + squared_distance) / n).max(1.0))
            }
        }
    }
}

/// What is known of the disturbance if the robot is in one state: a Gaussian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DisturbanceBelief {
    pub(crate) mean: [f64; N],
    pub(crate) covariance: [[f64; N]; N],
}

impl AppearanceModel {
    /// Before anything was seen.
    pub(crate) fn prior_belief(&self) -> DisturbanceBelief {
        let covariance =
            std::array::from_fn(|i| std::array::from_fn(|j| if i == j { self.prior[i] } else { 0.0 }));
        DisturbanceBelief { mean: [0.0; N], covariance }
    }

    /// Makes a disturbance a little less certain, by this share of the prior variance.
    pub(crate) fn widen(&self, belief: &mut DisturbanceBelief, share: f64) {
        for i in 0..N {
            belief.covariance[i][i] += share * self.prior[i];
        }
    }

    /// $`\log p(m \mid s)`$ with the disturbance integrated out, which is updated with the measurement.
    ///
    /// Sizes are the caller's business; `scratch` is as long as the measurement.
    pub(crate) fn absorb(
        &self,
        (condition, state): (usize, usize),
        measurement: &[f64],
        belief: &mut DisturbanceBelief,
        scratch: &mut [f64],
    ) -> LogWeight {
        let prior = *belief;
        let (squared_distance, log_determinant) =
            self.innovation((condition, state), measurement, belief, scratch);
        let (log_density, scale) = self.tail.weigh(squared_distance, measurement.len());
        if scale > 1.0 {
            *belief = prior;
            belief.update(&self.conditions[condition].states[state].sensitivities, scratch, scale);
        }
        log_density - 0.5 * log_determinant
    }

    /// Squared distance and log-determinant of the innovation; leaves its whitened residuals in `scratch` and updates the belief.
    pub(super) fn innovation(
        &self,
        (condition, state): (usize, usize),
        measurement: &[f64],
        belief: &mut DisturbanceBelief,
        scratch: &mut [f64],
    ) -> (f64, f64) {
        let model = &self.conditions[condition].states[state];
        scratch.copy_from_slice(measurement);
        model.whitener.whiten(scratch);
        scratch.iter_mut().zip(&model.features).for_each(|(z, expected)| *z -= expected);
        let (squared_distance, log_determinant) = belief.update(&model.sensitivities, scratch, 1.0);
        (squared_distance, log_determinant + model.whitener.log_determinant)
    }
}

impl DisturbanceBelief {
    /// Kalman update with measurements of equal, independent noise, one at a time; squared distance and log-determinant of the innovation.
    fn update(&mut self, rows: &[[f64; N]], residuals: &[f64], variance: f64) -> (f64, f64) {
        let (mut squared_distance, mut log_determinant) = (0.0, 0.0);
        for (a, z) in rows.iter().zip(residuals) {
            let cross: [f64; N] = std::array::from_fn(|i| dot(&self.covariance[i], a));
            let innovation_variance = variance + dot(&cross, a);
            let innovation = z - dot(&self.mean, a);
            for i in 0..N {
                self.mean[i] += cross[i] * innovation / innovation_variance;
                for j in 0..N {
                    self.covariance[i][j] -= cross[i] * cross[j] / innovation_variance;
                }
            }
            squared_distance += innovation * innovation / innovation_variance;
            log_determinant += innovation_variance.ln();
        }
        (squared_distance, log_determinant)
    }
}

fn dot(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::{DMatrix, DVector, SMatrix};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// One measurement after the other is the joint Kalman update with matrices, and the evidence that of the joint Gaussian.
    #[test]
    fn sequential_update_is_the_joint_one() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let mut uniform = || rng.random_range(-1.0..1.0);
        let k = 6;
        let a = DMatrix::from_fn(k, N, |_, _| uniform());
        let z = DVector::from_fn(k, |_, _| uniform());
        let root = SMatrix::<f64, N, N>::from_fn(|_, _| uniform());
        let prior = root * root.transpose();
        let covariance = DMatrix::from_fn(N, N, |i, j| prior[(i, j)]);
        let innovation = &a * &covariance * a.transpose() + DMatrix::identity(k, k) * 0.7;
        let gain = &covariance * a.transpose() * innovation.clone().try_inverse().expect("positive definite");
        let mean = &gain * &z;
        let posterior = &covariance - &gain * &a * &covariance;

        let mut belief = DisturbanceBelief {
            mean: [0.0; N],
            covariance: std::array::from_fn(|i| std::array::from_fn(|j| prior[(i, j)])),
        };
        let rows: Vec<[f64; N]> = (0..k).map(|i| std::array::from_fn(|j| a[(i, j)])).collect();
        let (squared_distance, log_determinant) = belief.update(&rows, z.as_slice(), 0.7);
        let expected = z.dot(&(innovation.clone().try_inverse().expect("positive definite") * &z));
        assert_abs_diff_eq!(squared_distance, expected, epsilon = 1e-9);
        assert_abs_diff_eq!(log_determinant, innovation.determinant().ln(), epsilon = 1e-9);
        for i in 0..N {
            assert_abs_diff_eq!(belief.mean[i], mean[i], epsilon = 1e-9);
            for j in 0..N {
                assert_abs_diff_eq!(belief.covariance[i][j], posterior[(i, j)], epsilon = 1e-9);
            }
        }
    }
}
