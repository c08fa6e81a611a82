use nalgebra::{DMatrix, DVector, RealField, SVector};

use crate::{Gaussian, GaussianError, cholesky, gaussian::check_dimension, symmetrize};

impl<T: RealField + Copy, const N: usize> Gaussian<SVector<T, N>> {
    /// The same distribution with its dimension known at run time only, as parts of it are.
    pub fn to_dynamic(&self) -> Gaussian<DVector<T>> {
        let covariance = DMatrix::from_column_slice(N, N, self.covariance().as_slice());
        Gaussian::from_parts_unchecked(DVector::from_column_slice(self.mean().as_slice()), covariance)
    }
}

/// Parts of vector states, by index sets; [`to_dynamic`](Gaussian::to_dynamic) brings vectors of fixed size here.
impl<T: RealField + Copy> Gaussian<DVector<T>> {
    /// The distribution of some coordinates, whatever the others are: rows and columns picked, in the order of `keep`.
    ///
    /// ```
    /// use nalgebra::{Matrix2, Vector2};
    /// use wayfix_gaussian_core::Gaussian;
    /// let joint = Gaussian::new(Vector2::new(1.0, 2.0), Matrix2::new(4.0, 1.0, 1.0, 9.0))?;
    /// assert_eq!(joint.to_dynamic().marginal(&[1])?.covariance()[(0, 0)], 9.0);
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if `keep` is empty, or names a coordinate twice or one that does not exist.
    pub fn marginal(&self, keep: &[usize]) -> Result<Self, GaussianError> {
        complement(keep, self.mean().len())?;
        if keep.is_empty() {
            return Err(GaussianError::Empty { what: "coordinates to keep" });
        }
        Ok(Gaussian::from_parts_unchecked(self.mean_of(keep), self.block(keep, keep)))
    }

    /// The distribution of the other coordinates, in ascending order, once those in `given` are known to be `values`.
    ///
    /// $`μ_a + Σ_{ab} Σ_{bb}^{-1} (v - μ_b)`$, $`Σ_{aa} - Σ_{ab} Σ_{bb}^{-1} Σ_{ba}`$ [Bishop 2006, Eqs. 2.81-2.82]
    ///
    /// ```
    /// use nalgebra::{Matrix2, Vector2, DVector};
    /// use wayfix_gaussian_core::Gaussian;
    /// let joint = Gaussian::new(Vector2::new(0.0, 0.0), Matrix2::new(2.0, 1.0, 1.0, 1.0))?;
    /// let conditional = joint.to_dynamic().conditional(&[1], &DVector::from_vec(vec![3.0]))?;
    /// assert_eq!((conditional.mean()[0], conditional.covariance()[(0, 0)]), (3.0, 1.0));
    /// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
    /// ```
    ///
    /// # Errors
    /// As for [`marginal`](Self::marginal); when nothing is left, or `values` is not finite or not as long as `given`.
    pub fn conditional(&self, given: &[usize], values: &DVector<T>) -> Result<Self, GaussianError> {
        let rest = complement(given, self.mean().len())?;
        if rest.is_empty() {
            return Err(GaussianError::Empty { what: "coordinates left" });
        }
        check_dimension("values", given.len(), values.len())?;
        if !values.iter().all(|value| value.is_finite()) {
            return Err(GaussianError::NotFinite { what: "values" });
        }
        let factor = cholesky("given", &self.block(given, given))?;
        let cross = self.block(given, &rest);
        let gain = factor.solve(&cross).transpose();
        let mean = self.mean_of(&rest) + &gain * (values - self.mean_of(given));
        let mut covariance = self.block(&rest, &rest) - gain * cross;
        symmetrize(&mut covariance);
        Ok(Gaussian::from_parts_unchecked(mean, covariance))
    }

    fn mean_of(&self, indices: &[usize]) -> DVector<T> {
        DVector::from_iterator(indices.len(), indices.iter().map(|&i| self.mean()[i]))
    }

    fn block(&self, rows: &[usize], columns: &[usize]) -> DMatrix<T> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| self.covariance()[(rows[i], columns[j])])
    }
}

/// The indices below `dimension` that are not in `indices`, which are in range and differ.
pub(crate) fn complement(indices: &[usize], dimension: usize) -> Result<Vec<usize>, GaussianError> {
    let mut taken = vec![false; dimension];
    for &index in indices {
        match taken.get_mut(index) {
            Some(seen) if !*seen => *seen = true,
            _ => return Err(GaussianError::Index { index, dimension }),
        }
    }
    Ok((0..dimension).filter(|&i| !taken[i]).collect())
}
