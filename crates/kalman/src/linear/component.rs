use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField};
use wayfix_estimation_traits::StateAlloc;

use crate::{KalmanError, check, error::Checked};

/// Corrects a Gaussian by one component of its state: $`z = x_i + v`$, $`v ∼ N(0, r)`$. Returns $`\ln N(z; μ_i, Σ_{ii} + r)`$.
///
/// Components with independent noise are such updates one after the other, exactly, without a factorization. [Bierman 1977, §V.2]
///
/// With $`c = Σ e_i`$ and $`s = Σ_{ii} + r`$ the new covariance is $`Σ - c c^T / s`$. Entries across the diagonal are computed by the same two
/// products, $`(c_j c_k) / s`$, so it is exactly symmetric. Row and column $`i`$ are multiplied by $`r / s`$, without a difference, as in Joseph's
/// form. Since $`c c^T ⪯ Σ_{ii} Σ`$, the remainder is at least $`(r / s)\, Σ`$: positive definite as long as $`r / s`$ is far above rounding.
///
/// # Errors
/// Returns an error if sizes differ, there is no such component, or the measurement or its variance is not finite, or the variance not positive. The
/// Gaussian is unchanged then.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use wayfix_kalman::update_component;
/// let (mut mean, mut covariance) = (Vector2::new(1.0, 0.0), Matrix2::new(1.0, 0.5, 0.5, 1.0));
/// update_component(&mut mean, &mut covariance, 0, 3.0, 1.0)?;
/// assert_eq!(mean, Vector2::new(2.0, 0.5)); // gain Σ e₀ / (1 + 1)
/// assert_eq!(covariance, Matrix2::new(0.5, 0.25, 0.25, 0.875));
/// assert!(update_component(&mut mean, &mut covariance, 2, 3.0, 1.0).is_err());
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
pub fn update_component<T: RealField + Copy, D: Dim>(
    mean: &mut OVector<T, D>,
    covariance: &mut OMatrix<T, D, D>,
    i: usize,
    measurement: T,
    variance: T,
) -> Result<T, KalmanError>
where
    DefaultAllocator: StateAlloc<D>,
{
    let n = mean.len();
    check::shape("covariance", (n, n), covariance.shape())?;
    check_measurement(i, n, measurement, variance)?;
    let innovation_variance = covariance[(i, i)] + variance;
    let residual = measurement - mean[i];
    let (per_variance, stays) = (T::one() / innovation_variance, variance / innovation_variance);
    let (before, rest) = covariance.as_mut_slice().split_at_mut(i * n);
    let (cross, after) = rest.split_at_mut(n);
    for (mean, cross) in mean.iter_mut().zip(&*cross) {
        *mean += *cross * (residual * per_variance);
    }
    let others = (0..).zip(before.chunks_exact_mut(n)).chain((i + 1..).zip(after.chunks_exact_mut(n)));
    for (k, column) in others {
        for (value, cross_j) in column.iter_mut().zip(&*cross) {
            *value -= (*cross_j * cross[k]) * per_variance;
        }
        column[i] = cross[k] * stays;
    }
    // The other updates use its old value, so it comes last.
    cross.iter_mut().for_each(|value| *value *= stays);
    let half: T = nalgebra::convert(-0.5);
    Ok(half * (T::two_pi().ln() + innovation_variance.ln() + residual * residual * per_variance))
}

fn check_measurement<T: RealField + Copy>(i: usize, n: usize, measurement: T, variance: T) -> Checked {
    if i >= n {
        return Err(KalmanError::OutOfRange { what: "component of the state", value: i as f64 });
    }
    check::finite("measurement", &nalgebra::Vector2::new(measurement, variance))?;
    if variance <= T::zero() {
        return Err(KalmanError::OutOfRange {
            what: "variance of a measurement",
            value: wayfix_estimation_traits::to_f64(variance),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KalmanFilter, LinearMotion, LinearSensor};
    use approx::assert_abs_diff_eq;
    use nalgebra::{Matrix1, Matrix3, RowVector3, Vector1, Vector3};
    use wayfix_gaussian_core::Gaussian;

    #[test]
    fn component_update_equals_the_form_of_joseph() {
        let a = Matrix3::new(2.0, 0.3, -0.4, 0.1, 1.5, 0.2, 0.7, -0.2, 0.9);
        let prior = Gaussian::new(Vector3::new(1.0, -2.0, 3.0), a * a.transpose()).unwrap();
        for i in 0..3 {
            let (mut mean, mut covariance) = (*prior.mean(), *prior.covariance());
            update_component(&mut mean, &mut covariance, i, 0.5, 0.25).unwrap();
            let motion = LinearMotion::stationary(Matrix3::zeros()).unwrap();
            let mut filter = KalmanFilter::new(motion, prior.clone()).unwrap();
            let mut row = RowVector3::zeros();
            row[i] = 1.0;
            let sensor = LinearSensor::new(row, Matrix1::new(0.25)).unwrap();
            filter.update(&sensor, &Vector1::new(0.5)).unwrap();
            assert_abs_diff_eq!(*filter.estimate().mean(), mean, epsilon = 1e-14);
            assert_abs_diff_eq!(*filter.estimate().covariance(), covariance, epsilon = 1e-14);
        }
    }

    #[test]
    fn bad_component_leaves_the_gaussian_unchanged() {
        let (mut mean, mut covariance) = (Vector3::new(1.0, 2.0, 3.0), Matrix3::identity());
        for (i, z, r) in [(3, 0.0, 1.0), (0, f64::NAN, 1.0), (0, 0.0, f64::INFINITY), (0, 0.0, 0.0)] {
            assert!(update_component(&mut mean, &mut covariance, i, z, r).is_err());
        }
        assert_eq!((mean, covariance), (Vector3::new(1.0, 2.0, 3.0), Matrix3::identity()));
    }
}
