use nalgebra::{DMatrix, DVector};

/// $`δ^T H δ + 2 g^T δ + c`$ over the tangent coordinates of some variables.
pub(crate) struct DenseQuadratic {
    /// First coordinate of each variable; `None` for those that are not among them.
    offsets: Vec<Option<usize>>,
    pub(crate) hessian: DMatrix<f64>,
    pub(crate) gradient: DVector<f64>,
    pub(crate) constant: f64,
}

impl DenseQuadratic {
    /// Zero over these variables, in this order.
    pub(crate) fn zeros(variables: &[usize], dims: &[usize]) -> Self {
        let mut offsets = vec![None; dims.len()];
        let mut n = 0;
        for variable in variables {
            offsets[*variable] = Some(n);
            n += dims[*variable];
        }
        Self { offsets, hessian: DMatrix::zeros(n, n), gradient: DVector::zeros(n), constant: 0.0 }
    }

    /// Adds $`(r + \sum J_k δ_k)^T Ω (r + \sum J_k δ_k)`$, with a cost at $`δ = 0`$ that a kernel may have made smaller.
    pub(crate) fn add(
        &mut self,
        variables: &[usize],
        jacobians: &[DMatrix<f64>],
        information: &DMatrix<f64>,
        value: &DVector<f64>,
        cost: f64,
    ) {
        self.constant += cost;
        let slope = information * value;
        for (a, by_a) in variables.iter().zip(jacobians) {
            self.add_slope(*a, by_a.transpose() * &slope);
            let left = by_a.transpose() * information;
            for (b, by_b) in variables.iter().zip(jacobians) {
                self.add_block(*a, *b, &left * by_b);
            }
        }
    }

    pub(crate) fn add_slope(&mut self, variable: usize, slope: DVector<f64>) {
        if let Some(row) = self.offsets[variable] {
            let mut part = self.gradient.rows_mut(row, slope.len());
            part += slope;
        }
    }

    /// Adds to the block with the rows of one variable and the columns of another.
    pub(crate) fn add_block(&mut self, a: usize, b: usize, entries: DMatrix<f64>) {
        if let (Some(row), Some(column)) = (self.offsets[a], self.offsets[b]) {
            let mut block = self.hessian.view_mut((row, column), entries.shape());
            block += entries;
        }
    }

    /// Whether it clearly determines every coordinate: no pivot has lost half of its digits.
    pub(super) fn is_definite(&self) -> bool {
        let Some(cholesky) = self.hessian.clone().cholesky() else { return false };
        let pivots = cholesky.l_dirty().diagonal().map(|root| root * root);
        let lost = f64::EPSILON.sqrt();
        pivots.iter().zip(&self.hessian.diagonal()).all(|(pivot, entry)| *pivot > lost * entry)
    }

    /// Without the first `n` coordinates, at their minimum: the Schur complement. `None` when they have no minimum.
    pub(crate) fn without_first(self, n: usize) -> Option<Self> {
        if n == 0 {
            return Some(self);
        }
        let rest = self.gradient.len() - n;
        let cholesky = self.hessian.view((0, 0), (n, n)).into_owned().cholesky()?;
        let coupling = self.hessian.view((0, n), (n, rest)).into_owned();
        let first = self.gradient.rows(0, n).into_owned();
        let solved = cholesky.solve(&coupling);
        let hessian = self.hessian.view((n, n), (rest, rest)) - coupling.transpose() * &solved;
        let hessian = hessian.symmetric_part();
        let gradient = self.gradient.rows(n, rest) - solved.transpose() * &first;
        let constant = self.constant - first.dot(&cholesky.solve(&first));
        Some(Self { offsets: Vec::new(), hessian, gradient, constant })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;

    /// A range determines one direction of a landmark. What rounding leaves of the other one is no information.
    #[test]
    fn one_range_does_not_determine_a_landmark() {
        for k in 0..10_000 {
            let (sin, cos) = (0.1 + 1.7 * f64::from(k)).sin_cos();
            let direction = Vector2::new(cos, sin);
            let mut range = DenseQuadratic::zeros(&[0], &[2]);
            range.add_block(
                0,
                0,
                DMatrix::from_column_slice(2, 2, (direction * direction.transpose() * 7.0).as_slice()),
            );
            assert!(!range.is_definite(), "{k}: {}", range.hessian);
            let across = Vector2::new(-sin, cos);
            range.add_block(
                0,
                0,
                DMatrix::from_column_slice(2, 2, (across * across.transpose() * 7.0).as_slice()),
            );
            assert!(range.is_definite(), "{k}: {}", range.hessian);
        }
    }
}
