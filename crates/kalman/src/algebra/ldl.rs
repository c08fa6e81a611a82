//! $`S = L D L^T`$ of an innovation covariance: no square roots, whose latency a small update would wait for.

use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField, allocator::Allocator};

use crate::check::is_moderate;

/// The factorization, with $`D^{-1}`$ in place of the unit diagonal of $`L`$.
#[derive(Clone, Debug)]
pub(crate) struct Ldl<T: RealField + Copy, M: Dim>(OMatrix<T, M, M>)
where
    DefaultAllocator: Allocator<M, M>;

impl<T: RealField + Copy, M: Dim> Ldl<T, M>
where
    DefaultAllocator: Allocator<M, M>,
{
    /// Factors the lower triangle; `None` when a pivot is not a positive finite number.
    #[inline(always)]
    pub(crate) fn new(covariance: &OMatrix<T, M, M>) -> Option<Self> {
        if covariance.nrows() == 2 {
            return Self::of_two(covariance).or_else(|| Self::by_elimination(covariance));
        }
        Self::by_elimination(covariance)
    }

    fn by_elimination(covariance: &OMatrix<T, M, M>) -> Option<Self> {
        let mut factor = covariance.clone();
        let m = factor.nrows();
        let mut columns = factor.as_mut_slice();
        for pivot in 0..m {
            let (column, rest) = columns.split_at_mut(m);
            let (value, inverse) = (column[pivot], column[pivot].recip());
            // NaN fails both; an infinite pivot has the inverse 0.
            if !(value > T::zero() && inverse > T::zero() && inverse.is_finite()) {
                return None;
            }
            for (right, target) in rest.chunks_exact_mut(m).enumerate() {
                let first = pivot + 1 + right;
                subtract(&mut target[first..], &column[first..], column[first] * inverse);
            }
            column[pivot] = inverse;
            column[pivot + 1..].iter_mut().for_each(|entry| *entry *= inverse);
            columns = rest;
        }
        Some(Self(factor))
    }

    /// Both divisions at once: $`1/d_2 = s_{11} / \det S`$ does not wait for $`1/d_1`$. `None` when the determinant is not worth trusting.
    #[inline(always)]
    fn of_two(covariance: &OMatrix<T, M, M>) -> Option<Self> {
        let (first, off, second) = (covariance[(0, 0)], covariance[(1, 0)], covariance[(1, 1)]);
        let product = first * second;
        let determinant = product - off * off;
        let (inverse, second_inverse) = (first.recip(), first / determinant);
        let usable = is_moderate(product)
            && determinant > T::zero()
            && inverse > T::zero()
            && inverse.is_finite()
            && second_inverse > T::zero()
            && second_inverse.is_finite();
        if !usable {
            return None;
        }
        let mut factor = covariance.clone();
        factor[(0, 0)] = inverse;
        factor[(1, 0)] = off * inverse;
        factor[(1, 1)] = second_inverse;
        Some(Self(factor))
    }

    /// From the lower triangular $`G`$ with $`S = G G^T`$, whose diagonal is positive: $`L = G D^{-1/2}`$.
    pub(crate) fn from_root(root: &OMatrix<T, M, M>) -> Self {
        let mut factor = root.clone();
        for k in 0..factor.nrows() {
            let inverse = root[(k, k)].recip();
            factor.column_mut(k).scale_mut(inverse);
            factor[(k, k)] = inverse * inverse;
        }
        Self(factor)
    }

    /// $`G = L D^{1/2}`$, in the lower triangle.
    pub(crate) fn root(&self) -> OMatrix<T, M, M> {
        let mut root = self.0.clone();
        for k in 0..root.nrows() {
            let diagonal = self.0[(k, k)].sqrt().recip();
            root.column_mut(k).scale_mut(diagonal);
            root[(k, k)] = diagonal;
        }
        root
    }

    /// $`1/d_k`$.
    #[inline(always)]
    pub(crate) fn inverse_pivot(&self, k: usize) -> T {
        self.0[(k, k)]
    }

    /// $`y ← L^{-1} y`$.
    #[inline(always)]
    pub(crate) fn whiten(&self, y: &mut OVector<T, M>)
    where
        DefaultAllocator: Allocator<M>,
    {
        for k in 0..y.nrows() {
            for row in k + 1..y.nrows() {
                let product = self.0[(row, k)] * y[k];
                y[row] -= product;
            }
        }
    }

    /// $`C ← C L^{-T}`$.
    #[inline(always)]
    pub(crate) fn whiten_columns<D: Dim>(&self, c: &mut OMatrix<T, D, M>)
    where
        DefaultAllocator: Allocator<D, M>,
    {
        let (n, m) = c.shape();
        let entries = c.as_mut_slice();
        for j in 1..m {
            let (before, rest) = entries.split_at_mut(j * n);
            for k in 0..j {
                subtract(&mut rest[..n], &before[k * n..(k + 1) * n], self.0[(j, k)]);
            }
        }
    }

    /// $`C ← C S^{-1}`$: the gain, when $`C`$ is the cross-covariance.
    #[inline(always)]
    pub(crate) fn divide<D: Dim>(&self, c: &mut OMatrix<T, D, M>)
    where
        DefaultAllocator: Allocator<D, M>,
    {
        self.whiten_columns(c);
        let (n, m) = c.shape();
        let entries = c.as_mut_slice();
        for j in (0..m).rev() {
            let (before, after) = entries.split_at_mut((j + 1) * n);
            let column = &mut before[j * n..];
            column.iter_mut().for_each(|entry| *entry *= self.0[(j, j)]);
            for k in j + 1..m {
                subtract(column, &after[(k - j - 1) * n..(k - j) * n], self.0[(k, j)]);
            }
        }
    }
}

#[inline(always)]
fn subtract<T: RealField + Copy>(target: &mut [T], column: &[T], factor: T) {
    for (entry, other) in target.iter_mut().zip(column) {
        *entry -= *other * factor;
    }
}
