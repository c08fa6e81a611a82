//! Proofs that a computed covariance is positive definite, by comparing a few numbers in place of an elimination.
//!
//! In exact arithmetic a prediction leaves $`λ_{\min}(F P F^T + Q) \ge λ_{\min}(Q)`$ and a correction leaves
//! $`λ_{\min}(P^+) \ge 1 / (1/λ_{\min}(P) + ‖H^T R^{-1} H‖)`$, since information adds. Rounding moves an eigenvalue by no more than the norm of
//! the error matrix (Weyl), which for products of $`n`$-vectors is a multiple of $`nε`$ times the norms of the factors
//! [Higham 2002, section 3.5]. If the first is sufficiently larger than the second, no elimination is needed.
//!
//! The bounds hold for exactly symmetric noises and without underflow, so models mirror their noises when they are built, and models of
//! extreme scale prove nothing. Comparisons are written so that NaN and overflow prove nothing. Without a proof the elimination is done.

use nalgebra::{DMatrix, DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};

use crate::check::is_moderate;

/// A lower bound of the smallest eigenvalue; 0 when none is known.
pub(crate) type Floor<T> = T;

/// Terms of the bound for a linear motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MotionCertificate<T> {
    /// Lower bound of $`λ_{\min}(Q)`$.
    floor: Floor<T>,
    /// $`c n ε ‖F‖_F^2`$ and $`c n ε \operatorname{tr} Q`$.
    growth: T,
    constant: T,
}

/// Terms of the bound for a linear sensor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SensorCertificate<T> {
    /// Upper bound of $`‖H^T R^{-1} H‖`$; infinite when none is known.
    information: T,
    /// $`c (n+m) ε`$ and $`2 + \operatorname{tr} R / λ_{\min}(R)`$.
    unit: T,
    spread: T,
}

/// Covers the counted roundings, with room to spare for terms of second order.
///
/// Prediction, in units of $`ε (‖F‖_F^2 \operatorname{tr} P + \operatorname{tr} Q)`$: two products and a sum $`2n + 3`$, what the elimination
/// behind $`P`$ may have overlooked $`n + 1`$, what the next one asks for beyond zero $`3n + 3`$; together at most $`13n`$.
/// Correction, in units of $`ε τ`$ with $`g = hτ`$ and $`s = \operatorname{tr} R / λ_{\min}(R)`$, where $`2\sqrt g \le 1 + g`$: errors of $`C`$
/// $`n (1 + g)`$, of $`S`$ and its factors $`(2n + 3m + 2)(g + s)`$, of each pass $`2 (n + m + 1)(1 + g) + m s`$, and the elimination's
/// $`3n + 3`$; for both passes less than $`16 (n + m)(2 + s + 2g)`$.
const SAFETY: f64 = 16.0;

impl<T: RealField + Copy> MotionCertificate<T> {
    pub(crate) fn new<D: Dim>(transition: &OMatrix<T, D, D>, noise: &OMatrix<T, D, D>) -> Self
    where
        DefaultAllocator: Allocator<D, D>,
    {
        let (unit, squares) = (rounding::<T>(transition.nrows()), transition.norm_squared());
        Self {
            floor: if is_moderate(squares) { smallest_eigenvalue(noise) } else { T::zero() },
            growth: unit * squares,
            constant: unit * noise.trace(),
        }
    }

    /// The bound after a prediction from a covariance of this trace; `None` if it proves nothing.
    #[inline(always)]
    pub(crate) fn after(&self, trace: T) -> Option<Floor<T>> {
        let error = self.growth * trace + self.constant;
        (self.floor > error).then_some(self.floor - error)
    }
}

impl<T: RealField + Copy> SensorCertificate<T> {
    pub(crate) fn new<D: Dim, M: Dim>(matrix: &OMatrix<T, M, D>, noise: &OMatrix<T, M, M>) -> Self
    where
        DefaultAllocator: Allocator<M, D> + Allocator<M, M>,
    {
        let (smallest, two) = (smallest_eigenvalue(noise), T::one() + T::one());
        let (squares, unknown) = (matrix.norm_squared(), T::one() / T::zero());
        let information = squares / smallest;
        Self {
            information: if is_moderate(squares) && is_moderate(information) { information } else { unknown },
            unit: rounding::<T>(matrix.nrows() + matrix.ncols()),
            spread: two + noise.trace() / smallest,
        }
    }

    /// The bound after a correction of a covariance of this trace; `None` if it proves nothing.
    ///
    /// With $`h = ‖H^T R^{-1} H‖`$ and $`τ = \operatorname{tr} P`$: $`K S K^T \le P`$ gives $`‖K‖^2 \le τ/λ_{\min}(R)`$, so errors of
    /// $`S`$ and $`C`$ enter with $`(1 + \sqrt{hτ})^2 τ \le 2 (1 + hτ) τ`$.
    #[inline(always)]
    pub(crate) fn after(&self, floor: Floor<T>, trace: T) -> Option<Floor<T>> {
        let left = floor / (T::one() + floor * self.information);
        let gain = self.information * trace;
        let error = self.unit * trace * (self.spread + gain + gain);
        (left > error).then_some(left - error)
    }
}

fn rounding<T: RealField + Copy>(n: usize) -> T {
    T::default_epsilon() * nalgebra::convert(SAFETY * n as f64)
}

/// A little below the smallest eigenvalue; 0 when that is not positive or extreme.
fn smallest_eigenvalue<T: RealField + Copy, D: Dim>(matrix: &OMatrix<T, D, D>) -> T
where
    DefaultAllocator: Allocator<D, D>,
{
    if matrix.is_empty() {
        return T::zero();
    }
    let (n, size) = (matrix.nrows(), matrix.norm());
    let smallest = DMatrix::from_column_slice(n, n, matrix.as_slice()).symmetric_eigenvalues().min();
    let safe = smallest - rounding::<T>(n) * size;
    if is_moderate(safe) { safe } else { T::zero() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        algebra::ldl::Ldl,
        algebra::product::{joseph, plain_difference, propagated_covariance},
        check,
    };
    use nalgebra::Matrix2;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    type Single<const R: usize, const C: usize> = nalgebra::SMatrix<f32, R, C>;

    fn positive<const N: usize>(rng: &mut ChaCha8Rng, scale: f32) -> Single<N, N> {
        let root = Single::<N, N>::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let weak = 10_f32.powf(rng.random_range(-5.0..0.0));
        let mut covariance = (root * root.transpose() + Single::identity() * weak) * scale;
        covariance.fill_upper_triangle_with_lower_triangle();
        covariance
    }

    /// Claims are made in single precision and judged in double, where eigenvalues are known to a billionth of what is claimed.
    fn is_true(claim: f32, covariance: &Single<4, 4>) -> bool {
        f64::from(claim) <= covariance.cast::<f64>().symmetric_eigenvalues().min()
    }

    #[test]
    fn what_is_certified_is_true_and_passes_the_elimination() {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let (mut n_predicted, mut n_corrected) = (0, 0);
        for case in 0..20_000 {
            let scale = |rng: &mut ChaCha8Rng| 10_f32.powf(rng.random_range(-3.0..3.0));
            let transition = Single::<4, 4>::from_fn(|_, _| rng.random_range(-1.0..1.0)) * scale(&mut rng);
            let (prior_scale, noise_scale, sensor_scale) =
                (scale(&mut rng), scale(&mut rng), scale(&mut rng));
            let (prior, noise) = (positive::<4>(&mut rng, prior_scale), positive::<4>(&mut rng, noise_scale));
            let motion = MotionCertificate::new(&transition, &noise);
            let predicted = propagated_covariance(&transition, &prior, &noise);
            let Some(floor) = motion.after(prior.trace()) else { continue };
            n_predicted += 1;
            assert!(is_true(floor, &predicted), "case {case}: predicted");
            assert!(check::positive_definite("predicted", &predicted).is_ok(), "case {case}");

            let matrix = Single::<2, 4>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let sensor_noise = positive::<2>(&mut rng, sensor_scale);
            let sensor = SensorCertificate::new(&matrix, &sensor_noise);
            let Some(floor) = sensor.after(floor, predicted.trace()) else { continue };
            n_corrected += 1;
            let cross = predicted * matrix.transpose();
            let ldl = Ldl::new(&(matrix * cross + sensor_noise)).expect("certified");
            let mut gain = cross;
            ldl.divide(&mut gain);
            let plain = plain_difference(&predicted, &gain, &cross);
            let careful = joseph(&predicted, &gain, &cross, &matrix, &sensor_noise);
            for posterior in [plain, careful] {
                assert!(is_true(floor, &posterior), "case {case}: corrected");
                assert!(check::positive_definite("posterior", &posterior).is_ok(), "case {case}");
            }
        }
        // A certificate that proves nothing would be true as well.
        assert!(n_predicted > 3000 && n_corrected > 1000, "only {n_predicted} and {n_corrected} proved");
    }

    #[test]
    fn what_is_not_a_number_proves_nothing() {
        let motion = MotionCertificate::new(&Matrix2::identity(), &Matrix2::<f64>::identity());
        assert!(motion.after(2.0).is_some());
        for trace in [f64::NAN, f64::INFINITY, 1e300] {
            assert_eq!(motion.after(trace), None);
        }
        assert_eq!(MotionCertificate::new(&Matrix2::identity(), &Matrix2::<f64>::zeros()).after(1.0), None);
    }
}
