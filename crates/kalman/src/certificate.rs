//! Proofs that a computed covariance is positive definite, by comparing a few numbers in place of an elimination.
//!
//! In exact arithmetic a prediction leaves $`λ_{\min}(F P F^T + Q) \ge λ_{\min}(Q)`$ and a correction leaves
//! $`λ_{\min}(P^+) \ge 1 / (1/λ_{\min}(P) + ‖H^T R^{-1} H‖)`$, since information adds. Rounding moves an eigenvalue by no more than the norm of
//! the error matrix (Weyl), which for products of $`n`$-vectors is a multiple of $`nε`$ times the norms of the factors
//! [Higham 2002, section 3.5]. Where the first is larger than the second with room to spare, nothing has to be eliminated.
//!
//! Comparisons are written so that NaN and overflow prove nothing. What is not proved is eliminated, as ever.

use nalgebra::{DMatrix, DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};

/// A lower bound of the smallest eigenvalue; 0 when none is known.
pub(crate) type Floor<T> = T;

/// What a linear motion does to the bound.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MotionCertificate<T> {
    /// Lower bound of $`λ_{\min}(Q)`$.
    floor: Floor<T>,
    /// $`c n ε ‖F‖_F^2`$ and $`c n ε \operatorname{tr} Q`$.
    growth: T,
    constant: T,
}

/// What a linear sensor does to the bound.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SensorCertificate<T> {
    /// Upper bound of $`‖H^T R^{-1} H‖`$; infinite when none is known.
    information: T,
    /// $`c (n+m) ε`$ and $`2 + \operatorname{tr} R / λ_{\min}(R)`$.
    unit: T,
    spread: T,
}

/// Covers the constants of the error bounds (at most $`γ_{2n+6}`$ a product, twice for symmetrizing, and what the elimination asks for
/// beyond zero) with room to spare.
const SAFETY: f64 = 16.0;

impl<T: RealField + Copy> MotionCertificate<T> {
    pub(crate) fn new<D: Dim>(transition: &OMatrix<T, D, D>, noise: &OMatrix<T, D, D>) -> Self
    where
        DefaultAllocator: Allocator<D, D>,
    {
        let unit = rounding::<T>(transition.nrows());
        Self {
            floor: smallest_eigenvalue(noise),
            growth: unit * transition.norm_squared(),
            constant: unit * noise.trace(),
        }
    }

    /// The bound after a prediction from a covariance of this trace; `None` when it proves nothing.
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
        Self {
            information: matrix.norm_squared() / smallest,
            unit: rounding::<T>(matrix.nrows() + matrix.ncols()),
            spread: two + noise.trace() / smallest,
        }
    }

    /// The bound after a correction of a covariance of this trace; `None` when it proves nothing.
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

/// A little below the smallest eigenvalue; 0 when that is not positive.
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
    if safe > T::zero() { safe } else { T::zero() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        check,
        ldl::Ldl,
        product::{joseph, plain_difference, propagated_covariance},
    };
    use nalgebra::{Matrix2, Matrix2x4, Matrix4};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A random matrix over many scales.
    fn scale(rng: &mut ChaCha8Rng) -> f64 {
        10_f64.powf(rng.random_range(-9.0..9.0))
    }

    fn positive<const N: usize>(rng: &mut ChaCha8Rng) -> nalgebra::SMatrix<f64, N, N> {
        let root = nalgebra::SMatrix::<f64, N, N>::from_fn(|_, _| rng.random_range(-1.0..1.0));
        (root * root.transpose() + nalgebra::SMatrix::identity() * 1e-3) * scale(rng)
    }

    #[test]
    fn what_is_certified_passes_the_elimination_and_the_ordinary_is_certified() {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let (mut n_predicted, mut n_corrected) = (0, 0);
        for case in 0..20_000 {
            let transition = Matrix4::from_fn(|_, _| rng.random_range(-1.0..1.0)) * scale(&mut rng);
            let (prior, noise) = (positive::<4>(&mut rng), positive::<4>(&mut rng));
            let motion = MotionCertificate::new(&transition, &noise);
            let predicted = propagated_covariance(&transition, &prior, &noise);
            let Some(floor) = motion.after(prior.trace()) else { continue };
            n_predicted += 1;
            assert!(check::positive_definite("predicted", &predicted).is_ok(), "case {case}");
            let smallest = predicted.symmetric_eigenvalues().min();
            assert!(
                floor <= smallest * (1.0 + 1e-9) + 1e-13 * predicted.trace(),
                "case {case}: {floor:e} > {smallest:e}"
            );

            let matrix = Matrix2x4::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let sensor_noise = positive::<2>(&mut rng);
            let sensor = SensorCertificate::new(&matrix, &sensor_noise);
            let cross = predicted * matrix.transpose();
            let Some(ldl) = Ldl::new(&(matrix * cross + sensor_noise)) else { continue };
            if sensor.after(floor, predicted.trace()).is_some() {
                n_corrected += 1;
                let mut gain = cross;
                ldl.divide(&mut gain);
                let plain = plain_difference(&predicted, &gain, &cross);
                let careful = joseph(&predicted, &gain, &cross, &matrix, &sensor_noise);
                assert!(check::positive_definite("plain", &plain).is_ok(), "case {case}");
                assert!(check::positive_definite("joseph", &careful).is_ok(), "case {case}");
            }
        }
        assert!(
            n_predicted > 3000 && n_corrected > 1000,
            "{n_predicted}, {n_corrected}: proves too little to be of use"
        );
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
