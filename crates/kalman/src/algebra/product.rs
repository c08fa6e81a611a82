//! Covariance algebra that every form shares.

use nalgebra::{
    DMatrixView, DMatrixViewMut, DefaultAllocator, Dim, Dyn, OMatrix, RealField, allocator::Allocator,
};
use wayfix_estimation_traits::UpdateAlloc;
use wayfix_gaussian_core::symmetrize;

/// $`F P F^T + Q`$. Like the others here it is exactly symmetric, and the caller checks that it is positive definite: matrices in a
/// `Result` are copied, and small filters spend a third of their time copying.
#[inline(always)]
pub(crate) fn propagated_covariance<T, D>(
    jacobian: &OMatrix<T, D, D>,
    covariance: &OMatrix<T, D, D>,
    noise: &OMatrix<T, D, D>,
) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let left = times(jacobian, covariance);
    symmetric_sum(noise, T::one(), &left, jacobian)
}

/// $`(I - KH) P (I - KH)^T + K R K^T`$: the form of Joseph, right for any gain and kind to rounding.
///
/// In two passes that never form $`I - KH`$: $`M = P - K C^T`$ with $`C = P H^T`$, then $`M + (K R - M H^T) K^T`$, which takes out of every observed
/// direction what rounding left in it.
#[inline(always)]
pub(crate) fn joseph<T, D, M>(
    prior: &OMatrix<T, D, D>,
    gain: &OMatrix<T, D, M>,
    cross_covariance: &OMatrix<T, D, M>,
    jacobian: &OMatrix<T, M, D>,
    noise: &OMatrix<T, M, M>,
) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    M: Dim,
    DefaultAllocator: UpdateAlloc<D, M>,
{
    let first = prior - times_transpose(gain, cross_covariance);
    let rest = times(gain, noise) - times_transpose(&first, jacobian);
    symmetric_sum(&first, T::one(), &rest, gain)
}

/// $`P - K C^T`$: the textbook difference, half the work of [`joseph`] and less forgiving.
#[inline(always)]
pub(crate) fn plain_difference<T, D, M>(
    prior: &OMatrix<T, D, D>,
    gain: &OMatrix<T, D, M>,
    cross_covariance: &OMatrix<T, D, M>,
) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    M: Dim,
    DefaultAllocator: UpdateAlloc<D, M>,
{
    symmetric_sum(prior, -T::one(), gain, cross_covariance)
}

/// `base + sign · A Bᵀ`, where the product is symmetric up to rounding and the result is exactly: the lower triangle is computed, the
/// upper one copied.
#[inline(always)]
fn symmetric_sum<T, D, K>(
    base: &OMatrix<T, D, D>,
    sign: T,
    a: &OMatrix<T, D, K>,
    b: &OMatrix<T, D, K>,
) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    K: Dim,
    DefaultAllocator: Allocator<D, D> + Allocator<D, K> + Allocator<K, D>,
{
    let (n, inner) = a.shape();
    if n >= PACKED {
        let mut sum = times_transpose(a, b) * sign + base;
        symmetrize(&mut sum);
        return sum;
    }
    let mut sum = base.clone();
    let (entries, a, b) = (sum.as_mut_slice(), a.as_slice(), b.as_slice());
    for column in 0..n {
        for k in 0..inner {
            let factor = sign * b[column + k * n];
            for row in column..n {
                entries[row + column * n] += a[row + k * n] * factor;
            }
        }
    }
    for column in 1..n {
        for row in 0..column {
            entries[row + column * n] = entries[column + row * n];
        }
    }
    sum
}

/// From this many rows on, the packed kernels of matrixmultiply beat nalgebra's loops, measured on x86-64.
const PACKED: usize = 12;

/// $`A B`$.
#[inline(always)]
pub(crate) fn times<T, R, C, K>(a: &OMatrix<T, R, K>, b: &OMatrix<T, K, C>) -> OMatrix<T, R, C>
where
    T: RealField + Copy,
    R: Dim,
    C: Dim,
    K: Dim,
    DefaultAllocator: Allocator<R, K> + Allocator<K, C> + Allocator<R, C>,
{
    let ((rows, inner), columns) = (a.shape_generic(), b.shape_generic().1);
    if inner.value() < PACKED {
        return a * b;
    }
    let mut product = OMatrix::zeros_generic(rows, columns);
    let a = DMatrixView::from_slice(a.as_slice(), rows.value(), inner.value());
    let b = DMatrixView::from_slice(b.as_slice(), inner.value(), columns.value());
    DMatrixViewMut::from_slice(product.as_mut_slice(), rows.value(), columns.value()).gemm(
        T::one(),
        &a,
        &b,
        T::zero(),
    );
    product
}

/// $`A B^T`$, without forming the transpose of a large $`B`$.
#[inline(always)]
pub(crate) fn times_transpose<T, R, C, K>(a: &OMatrix<T, R, K>, b: &OMatrix<T, C, K>) -> OMatrix<T, R, C>
where
    T: RealField + Copy,
    R: Dim,
    C: Dim,
    K: Dim,
    DefaultAllocator: Allocator<R, K> + Allocator<C, K> + Allocator<K, C> + Allocator<R, C>,
{
    let ((rows, inner), columns) = (a.shape_generic(), b.shape_generic().0);
    if inner.value() < PACKED || columns.value() == 0 {
        return a * b.transpose();
    }
    let mut product = OMatrix::zeros_generic(rows, columns);
    let a = DMatrixView::from_slice(a.as_slice(), rows.value(), inner.value());
    let (row_stride, column_stride) = (Dyn(columns.value()), Dyn(1));
    let b = DMatrixView::<T, Dyn, Dyn>::from_slice_with_strides_generic(
        b.as_slice(),
        Dyn(inner.value()),
        Dyn(columns.value()),
        row_stride,
        column_stride,
    );
    DMatrixViewMut::from_slice(product.as_mut_slice(), rows.value(), columns.value()).gemm(
        T::one(),
        &a,
        &b,
        T::zero(),
    );
    product
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use nalgebra::{DMatrix, Matrix2, Matrix2x4, Matrix4, SMatrix, convert};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::{algebra::ldl::Ldl, check};

    /// The form of Joseph as textbooks write it: the oracle of the two passes.
    fn textbook<T: RealField + Copy>(
        prior: &Matrix4<T>,
        gain: &SMatrix<T, 4, 2>,
        jacobian: &Matrix2x4<T>,
        noise: &Matrix2<T>,
    ) -> Matrix4<T> {
        let remainder = Matrix4::identity() - gain * jacobian;
        let sum = remainder * prior * remainder.transpose() + gain * noise * gain.transpose();
        (sum + sum.transpose()) * convert::<f64, T>(0.5)
    }

    #[test]
    fn two_passes_are_the_textbook_product_for_any_gain() {
        let mut rng = ChaCha8Rng::seed_from_u64(12);
        for case in 0..2000 {
            let mut uniform = || rng.random_range(-1.0..1.0);
            let root = Matrix4::<f64>::from_fn(|_, _| uniform());
            let mut prior = root * root.transpose();
            prior.fill_upper_triangle_with_lower_triangle();
            let noise = Matrix2::new(1.0 + uniform(), 0.0, 0.0, 1.0 + uniform());
            let jacobian = Matrix2x4::from_fn(|_, _| uniform());
            let gain = SMatrix::<f64, 4, 2>::from_fn(|_, _| uniform());
            let cross = prior * jacobian.transpose();
            let found = joseph(&prior, &gain, &cross, &jacobian, &noise);
            let expected = textbook(&prior, &gain, &jacobian, &noise);
            // Sums of some 20 products, each below (1 + ‖K‖‖H‖)² ‖P‖ + ‖K‖² ‖R‖.
            let size = (1.0 + gain.norm() * jacobian.norm()).powi(2) * prior.norm()
                + gain.norm_squared() * noise.norm();
            assert!(abs_diff_eq!(found, expected, epsilon = 20.0 * f64::EPSILON * size), "case {case}");
            assert_eq!(found, found.transpose());
        }
    }

    #[test]
    fn packed_products_are_the_plain_ones() {
        let mut rng = ChaCha8Rng::seed_from_u64(13);
        for _ in 0..200 {
            let [rows, inner, columns] = std::array::from_fn(|_| rng.random_range(1..2 * PACKED));
            let mut uniform =
                |rows, columns| DMatrix::from_fn(rows, columns, |_, _| rng.random_range(-1.0..1.0));
            let (a, b) = (uniform(rows, inner), uniform(inner, columns));
            let expected = &a * &b;
            // Sums of at most 24 products of numbers below 1.
            assert!(
                (times(&a, &b) - &expected).amax() < 24.0 * 24.0 * f64::EPSILON,
                "{rows} {inner} {columns}"
            );
            let transposed = times_transpose(&a, &b.transpose());
            assert!((transposed - expected).amax() < 24.0 * 24.0 * f64::EPSILON, "{rows} {inner} {columns}");
        }
    }

    /// How many of 2000 predictions and of 2000 corrections of a diffuse prior by a nearly perfect sensor (`tests/integration/breakdown.rs`) are refused.
    fn refused<T: RealField + Copy>(
        form: impl Fn(&Matrix4<T>, &SMatrix<T, 4, 2>, &SMatrix<T, 4, 2>, &Matrix2x4<T>, &Matrix2<T>) -> Matrix4<T>,
    ) -> [usize; 2] {
        let mut transition = Matrix4::<T>::identity();
        transition[(0, 2)] = convert(0.1);
        transition[(1, 3)] = convert(0.1);
        let (jacobian, noise) = (Matrix2x4::identity(), Matrix2::identity() * convert::<f64, T>(1e-10));
        let mut covariance = Matrix4::identity() * convert::<f64, T>(1e8);
        let mut refused = [0, 0];
        for _ in 0..2000 {
            let predicted = propagated_covariance(&transition, &covariance, &Matrix4::zeros());
            match check::positive_definite("predicted", &predicted) {
                Ok(()) => covariance = predicted,
                Err(_) => refused[0] += 1,
            }
            let cross = covariance * jacobian.transpose();
            let ldl = Ldl::new(&(jacobian * cross + noise)).expect("a positive definite prior");
            let mut gain = cross;
            ldl.divide(&mut gain);
            let posterior = form(&covariance, &gain, &cross, &jacobian, &noise);
            match check::positive_definite("posterior", &posterior) {
                Ok(()) => covariance = posterior,
                Err(_) => refused[1] += 1,
            }
        }
        refused
    }

    #[test]
    fn two_passes_break_down_no_sooner_than_the_textbook_product() {
        fn compare<T: RealField + Copy>() {
            let two_passes = refused::<T>(|p, k, c, h, r| joseph(p, k, c, h, r));
            let product = refused::<T>(|p, k, _, h, r| textbook(p, k, h, r));
            let plain = refused::<T>(|p, k, c, _, _| plain_difference(p, k, c));
            assert!(
                two_passes[0] <= product[0] && two_passes[1] <= product[1],
                "{two_passes:?}, {product:?}"
            );
            assert!(plain[1] > 0, "too easy a problem");
        }
        compare::<f64>();
        compare::<f32>();
    }
}
