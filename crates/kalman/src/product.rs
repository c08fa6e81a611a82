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
        column_stride,
        row_stride,
    );
    DMatrixViewMut::from_slice(product.as_mut_slice(), rows.value(), columns.value()).gemm(
        T::one(),
        &a,
        &b,
        T::zero(),
    );
    product
}
