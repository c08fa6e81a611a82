//! Covariance algebra that every form shares.

use nalgebra::{
    DMatrixView, DMatrixViewMut, DefaultAllocator, Dim, Dyn, OMatrix, RealField, allocator::Allocator,
};
use wayfix_estimation_traits::UpdateAlloc;
use wayfix_gaussian_core::symmetrize;

/// $`F P F^T + Q`$. Like the others here it is exactly symmetric, and the caller checks that it is positive definite: matrices in a
/// `Result` are copied, and small filters spend a third of their time copying.
#[inline]
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
    symmetric(times_transpose(&times(jacobian, covariance), jacobian) + noise)
}

/// $`(I - KH) P (I - KH)^T + K R K^T`$: the form of Joseph, right for any gain and kind to rounding.
#[inline]
pub(crate) fn joseph<T, D, M>(
    prior: &OMatrix<T, D, D>,
    gain: &OMatrix<T, D, M>,
    jacobian: &OMatrix<T, M, D>,
    noise: &OMatrix<T, M, M>,
) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    M: Dim,
    DefaultAllocator: UpdateAlloc<D, M>,
{
    let (n, _) = prior.shape_generic();
    let remainder = OMatrix::identity_generic(n, n) - times(gain, jacobian);
    symmetric(
        times_transpose(&times(&remainder, prior), &remainder) + times_transpose(&times(gain, noise), gain),
    )
}

/// $`P - K C^T`$: the textbook difference, half the work of [`joseph`] and less forgiving.
#[inline]
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
    symmetric(prior - times_transpose(gain, cross_covariance))
}

/// $`(P + P^T)/2`$; by whole matrices where they are small, since entry by entry stalls the vector units.
fn symmetric<T, D>(mut matrix: OMatrix<T, D, D>) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    if matrix.nrows() < PACKED {
        let half = nalgebra::convert::<f64, T>(0.5);
        return (&matrix + matrix.transpose()) * half;
    }
    symmetrize(&mut matrix);
    matrix
}

/// From this many rows on, the packed kernels of matrixmultiply beat nalgebra's loops, measured on x86-64.
const PACKED: usize = 12;

/// $`A B`$.
#[inline]
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
#[inline]
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

/// $`C ← C S^{-1}`$ by columns, with $`S = L D L^T`$: no square roots, whose latency a small update would wait for.
///
/// The caller has established that $`S`$ is positive definite; its lower triangle is read.
#[inline]
pub(crate) fn divide_by_covariance<T, D, M>(matrix: &mut OMatrix<T, D, M>, covariance: &OMatrix<T, M, M>)
where
    T: RealField + Copy,
    D: Dim,
    M: Dim,
    DefaultAllocator: Allocator<D, M> + Allocator<M, M>,
{
    let (n, m) = matrix.shape();
    if n == 0 || m == 0 {
        return;
    }
    let unit_lower_over_pivots = inverted_pivots(covariance);
    let factor = &unit_lower_over_pivots;
    let entries = matrix.as_mut_slice();
    // W Lᵀ = C: column j of W from those before it.
    for j in 1..m {
        let (before, rest) = entries.split_at_mut(j * n);
        for (k, column) in before.chunks_exact(n).enumerate() {
            subtract(&mut rest[..n], column, factor[(j, k)]);
        }
    }
    for (j, column) in entries.chunks_exact_mut(n).enumerate() {
        column.iter_mut().for_each(|entry| *entry *= factor[(j, j)]);
    }
    // K L = W D⁻¹: column j of K from those after it.
    for j in (0..m).rev() {
        let (before, after) = entries.split_at_mut((j + 1) * n);
        for (k, column) in after.chunks_exact(n).enumerate() {
            subtract(&mut before[j * n..], column, factor[(j + 1 + k, j)]);
        }
    }
}

/// $`L`$ of $`S = L D L^T`$, with $`D^{-1}`$ in place of its unit diagonal.
#[inline]
fn inverted_pivots<T, M>(covariance: &OMatrix<T, M, M>) -> OMatrix<T, M, M>
where
    T: RealField + Copy,
    M: Dim,
    DefaultAllocator: Allocator<M, M>,
{
    let mut factor = covariance.clone();
    let m = factor.nrows();
    let mut columns = factor.as_mut_slice();
    for pivot in 0..m {
        let (column, rest) = columns.split_at_mut(m);
        let inverse = column[pivot].recip();
        for (right, target) in rest.chunks_exact_mut(m).enumerate() {
            let first = pivot + 1 + right;
            let multiple = column[first] * inverse;
            subtract(&mut target[first..], &column[first..], multiple);
        }
        column[pivot] = inverse;
        column[pivot + 1..].iter_mut().for_each(|entry| *entry *= inverse);
        columns = rest;
    }
    factor
}

#[inline]
fn subtract<T: RealField + Copy>(target: &mut [T], column: &[T], factor: T) {
    for (entry, other) in target.iter_mut().zip(column) {
        *entry -= *other * factor;
    }
}
