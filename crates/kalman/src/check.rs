//! Checks of every step before it changes a state.

use nalgebra::{ComplexField, DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, Tangent, to_f64};
use wayfix_gaussian_core::{GaussianError, check_covariance};

use crate::error::Checked;

/// Sizes fit.
pub(crate) fn dimension(what: &'static str, expected: usize, got: usize) -> Checked {
    if expected == got { Ok(()) } else { Err(GaussianError::Dimension { what, expected, got }.into()) }
}

/// A matrix has `shape`.
pub(crate) fn shape(what: &'static str, expected: (usize, usize), got: (usize, usize)) -> Checked {
    dimension(what, expected.0, got.0)?;
    dimension(what, expected.1, got.1)
}

/// Every entry is a finite number.
#[inline(always)]
pub(crate) fn finite<T: RealField + Copy, R: Dim, C: Dim>(
    what: &'static str,
    matrix: &OMatrix<T, R, C>,
) -> Checked
where
    DefaultAllocator: Allocator<R, C>,
{
    // A slice: nalgebra's iterator walks strides, which costs more than the test.
    if matrix.as_slice().iter().all(ComplexField::is_finite) {
        Ok(())
    } else {
        Err(GaussianError::NotFinite { what }.into())
    }
}

/// Between $`ε^4`$ and $`ε^{-4}`$: products and sums of squares of this size have lost nothing to underflow or overflow on their way.
#[inline(always)]
pub(crate) fn is_moderate<T: RealField + Copy>(product: T) -> bool {
    let smallest = T::default_epsilon().powi(4);
    product >= smallest && product <= smallest.recip()
}

/// $`y ⊟ x`$, of the right size and finite.
pub(crate) fn difference<X: Manifold>(what: &'static str, from: &X, to: &X) -> Checked<Tangent<X>>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    dimension(what, from.dim().value(), to.dim().value())?;
    let tangent = from.local(to);
    finite(what, &tangent)?;
    Ok(tangent)
}

/// $`x ⊞ δ`$ when both it and δ are finite.
pub(crate) fn moved<X: Manifold>(what: &'static str, from: &X, delta: &Tangent<X>) -> Checked<X>
where
    DefaultAllocator: Allocator<X::Dim>,
{
    finite(what, delta)?;
    let to = from.retract(delta);
    difference(what, from, &to)?;
    Ok(to)
}

/// Positive definite beyond rounding: every pivot of the elimination exceeds $`2 n ε`$ of its own diagonal entry.
///
/// If a pivot is rounding, the strict test of a Cholesky factorization passes or fails by chance. With this margin every other order of
/// elimination agrees. Only the lower triangle is read. NaN and infinities fail.
#[inline]
pub(crate) fn positive_definite<T, D>(what: &'static str, matrix: &OMatrix<T, D, D>) -> Checked
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let n = matrix.nrows();
    let margin = T::default_epsilon() * nalgebra::convert(2.0 * n as f64);
    let mut schur = matrix.clone();
    let mut columns = schur.as_mut_slice();
    for pivot in 0..n {
        // Columns of what is left to eliminate; the first is the pivot's.
        let (column, rest) = columns.split_at_mut(n);
        let value = column[pivot];
        let floor = margin * matrix[(pivot, pivot)];
        // Written so that NaN fails; an infinite pivot is not above its infinite floor.
        if !(value > floor && value > T::zero()) {
            return Err(refused_pivot(what, matrix, pivot, value));
        }
        let scale = value.recip();
        for (right, target) in rest.chunks_exact_mut(n).enumerate() {
            let first = pivot + 1 + right;
            let factor = column[first] * scale;
            for (entry, eliminated) in target[first..].iter_mut().zip(&column[first..]) {
                *entry -= factor * *eliminated;
            }
        }
        columns = rest;
    }
    Ok(())
}

/// A sensor's covariance: size, finite, symmetric, positive definite.
pub(crate) fn sensor_noise<T, D>(noise: &OMatrix<T, D, D>, dim: usize) -> Checked
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    const WHAT: &str = "sensor noise";
    shape(WHAT, (dim, dim), noise.shape())?;
    Ok(check_covariance(WHAT, noise)?)
}

/// A motion's covariance: size, finite, symmetric, positive semidefinite. Gives the factor $`L`$ with $`L L^T = Q`$.
pub(crate) fn motion_noise<T, D>(noise: &OMatrix<T, D, D>, dim: usize) -> Checked<OMatrix<T, D, D>>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    const WHAT: &str = "motion noise";
    shape(WHAT, (dim, dim), noise.shape())?;
    match check_covariance(WHAT, noise) {
        // Definiteness is checked last, so everything else is in order.
        Ok(()) | Err(GaussianError::NotPositiveDefinite { .. }) => semidefinite_factor(WHAT, noise),
        Err(other) => Err(other.into()),
    }
}

/// Lower triangular $`L`$ with $`L L^T`$ the matrix; columns of a vanishing pivot are zero. Refuses indefinite matrices.
fn semidefinite_factor<T, D>(what: &'static str, matrix: &OMatrix<T, D, D>) -> Checked<OMatrix<T, D, D>>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    let n = matrix.nrows();
    let margin = T::default_epsilon() * nalgebra::convert(8.0 * n as f64);
    let mut l = matrix.lower_triangle();
    for pivot in 0..n {
        let (value, diagonal) = (l[(pivot, pivot)], matrix[(pivot, pivot)]);
        let rounding = margin * diagonal.abs();
        if value < -rounding {
            return Err(refused_pivot(what, matrix, pivot, value));
        }
        if value <= rounding {
            // A vanishing pivot of a semidefinite matrix has a vanishing column: |s_ij|² ≤ s_ii s_jj.
            for row in pivot + 1..n {
                let limit = rounding * matrix[(row, row)].abs();
                if l[(row, pivot)] * l[(row, pivot)] > limit {
                    return Err(refused_pivot(what, matrix, row, -l[(row, pivot)].abs()));
                }
            }
            l.column_mut(pivot).fill(T::zero());
            continue;
        }
        let root = value.sqrt();
        for row in pivot..n {
            l[(row, pivot)] /= root;
        }
        for right in pivot + 1..n {
            let factor = l[(right, pivot)];
            for row in right..n {
                let product = factor * l[(row, pivot)];
                l[(row, right)] -= product;
            }
        }
    }
    Ok(l)
}

/// The error of a covariance that cannot be factored.
#[cold]
pub(crate) fn refused<T, D>(what: &'static str, matrix: &OMatrix<T, D, D>) -> crate::KalmanError
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    match check_covariance(what, matrix) {
        Err(error) => error.into(),
        // Only the rounding of another factorization let it pass.
        Ok(()) => refused_pivot(what, matrix, 0, matrix[(0, 0)]),
    }
}

#[cold]
fn refused_pivot<T, D>(
    what: &'static str,
    matrix: &OMatrix<T, D, D>,
    pivot: usize,
    value: T,
) -> crate::KalmanError
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    if matrix.iter().all(ComplexField::is_finite) {
        GaussianError::NotPositiveDefinite { what, pivot, value: to_f64(value) }.into()
    } else {
        GaussianError::NotFinite { what }.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use nalgebra::{Matrix2, Matrix3, Vector3};

    #[test]
    fn rank_one_noise_factor_reproduces_the_matrix() {
        for scale in [1e-12, 1.0, 1e12] {
            let direction = Vector3::new(0.005, 0.1, 1.0) * scale;
            let noise: Matrix3<f64> = direction * direction.transpose();
            let factor = motion_noise(&noise, 3).unwrap();
            assert_abs_diff_eq!(factor * factor.transpose(), noise, epsilon = 1e-14 * noise.norm());
        }
        assert_eq!(motion_noise(&Matrix2::<f32>::zeros(), 2).unwrap(), Matrix2::zeros());
    }

    #[test]
    fn indefinite_lopsided_and_non_finite_noises_are_refused() {
        let nan = f64::NAN;
        for bad in [
            Matrix2::new(1.0, 2.0, 2.0, 1.0),
            Matrix2::new(0.0, 1e-3, 1e-3, 1.0),
            Matrix2::new(-1e-9, 0.0, 0.0, 1.0),
            Matrix2::new(1.0, 0.5, 0.4, 1.0),
            Matrix2::new(1.0, nan, nan, 1.0),
            Matrix2::new(f64::INFINITY, 0.0, 0.0, 1.0),
        ] {
            assert!(motion_noise(&bad, 2).is_err(), "{bad}");
            assert!(sensor_noise(&bad, 2).is_err(), "{bad}");
        }
        assert!(sensor_noise(&Matrix2::<f64>::zeros(), 2).is_err());
    }

    #[test]
    fn infinite_off_diagonal_is_not_positive_definite() {
        let mut matrix = Matrix3::identity();
        matrix[(2, 0)] = f64::INFINITY;
        assert_eq!(positive_definite("p", &matrix), Err(GaussianError::NotFinite { what: "p" }.into()));
    }
}
