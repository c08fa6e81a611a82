/// The joint innovation of several pairings; rows are added and removed at the end.
///
/// Keeps the Cholesky factor of the joint innovation covariance and $`y = L^{-1} ν`$, so that a pairing more costs a forward substitution and
/// the joint NIS is $`‖y‖^2`$.
#[derive(Clone, Debug, Default)]
pub(super) struct JointInnovation {
    /// Rows of the lower triangle, one after the other.
    factor: Vec<f64>,
    whitened: Vec<f64>,
}

impl JointInnovation {
    pub(super) fn dimension(&self) -> usize {
        self.whitened.len()
    }

    pub(super) fn nis(&self) -> f64 {
        self.whitened.iter().map(|y| y * y).sum()
    }

    /// Adds one scalar row: its covariances with all rows so far and, last, its own variance. Returns `None` and changes nothing if the joint
    /// covariance would not be positive definite.
    pub(super) fn push(&mut self, covariances: impl Iterator<Item = f64>, residual: f64) -> Option<()> {
        let (start, n) = (self.factor.len(), self.dimension());
        self.factor.extend(covariances);
        let (rows, own) = self.factor.split_at_mut(start);
        let mut row_start = 0;
        for column in 0..n {
            let row = &rows[row_start..=row_start + column];
            let dot: f64 = row[..column].iter().zip(&own[..column]).map(|(a, b)| a * b).sum();
            own[column] = (own[column] - dot) / row[column];
            row_start += column + 1;
        }
        let pivot = own[n] - own[..n].iter().map(|x| x * x).sum::<f64>();
        if !(pivot > 0.0 && pivot.is_finite()) {
            self.factor.truncate(start);
            return None;
        }
        own[n] = pivot.sqrt();
        let dot: f64 = own[..n].iter().zip(&self.whitened).map(|(l, y)| l * y).sum();
        let whitened = (residual - dot) / own[n];
        self.whitened.push(whitened);
        Some(())
    }

    /// Removes the last rows until `dimension` are left.
    pub(super) fn truncate(&mut self, dimension: usize) {
        self.factor.truncate(dimension * (dimension + 1) / 2);
        self.whitened.truncate(dimension);
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::{DMatrix, DVector, linalg::Cholesky};

    use super::*;

    #[test]
    fn grows_and_shrinks_as_the_dense_factor_does() {
        let root = DMatrix::from_fn(6, 6, |row, column| ((row * 7 + column * 3) as f64).sin());
        let covariance = &root * root.transpose() + DMatrix::identity(6, 6) * 0.1;
        let residual = DVector::from_fn(6, |row, _| (row as f64).cos());
        let dense = |n: usize| {
            let head = residual.rows(0, n).into_owned();
            head.dot(&Cholesky::new(covariance.view((0, 0), (n, n)).into_owned()).unwrap().solve(&head))
        };
        let mut joint = JointInnovation::default();
        let push = |joint: &mut JointInnovation, row: usize| {
            joint.push((0..=row).map(|column| covariance[(row, column)]), residual[row]).unwrap();
        };
        for row in 0..6 {
            push(&mut joint, row);
            assert_abs_diff_eq!(joint.nis(), dense(row + 1), epsilon = 1e-9 * dense(6));
        }
        joint.truncate(2);
        assert_abs_diff_eq!(joint.nis(), dense(2), epsilon = 1e-9 * dense(6));
        push(&mut joint, 2);
        assert_abs_diff_eq!(joint.nis(), dense(3), epsilon = 1e-9 * dense(6));
        assert!(joint.push([0.0, 0.0, 0.0, -1.0].into_iter(), 0.0).is_none());
        assert_eq!(joint.dimension(), 3);
    }
}
