use nalgebra::{DMatrix, DVector};

use crate::{
    SmootherError, Variable, VariableId,
    graph::{Graph, structure::Structure},
    unconstrained,
};

/// Covariances of chosen variables: columns of $`H^{-1}`$ by the sparse factor, without the whole inverse.
///
/// They are those of the linearized problem, in the tangent spaces at the present values; robust kernels count with their weights.
pub struct Marginals<'a> {
    structure: &'a Structure,
}

pub(crate) fn at_present(graph: &mut Graph) -> Result<Marginals<'_>, SmootherError> {
    let mut structure = match graph.structure.take() {
        Some(structure) => structure,
        None => Structure::new(graph)?,
    };
    let result =
        structure.linearize(graph, &graph.values, 1.0).and_then(|_| unconstrained::check(&mut structure));
    let structure = graph.structure.insert(structure);
    result.map(|()| Marginals { structure })
}

/// Mean and covariance of variables in the tangent spaces at the present values; nothing is kept for later.
pub(crate) fn gaussian(
    graph: &Graph,
    variables: &[usize],
) -> Result<(DVector<f64>, DMatrix<f64>), SmootherError> {
    let mut structure = Structure::new(graph)?;
    structure.linearize(graph, &graph.values, 1.0)?;
    unconstrained::check(&mut structure)?;
    let step = structure.solve()?;
    let marginals = Marginals { structure: &structure };
    let mean = marginals.coordinates(variables)?.into_iter().map(|row| row.map_or(0.0, |row| step[row]));
    Ok((DVector::from_vec(mean.collect()), marginals.joint(variables)?))
}

impl Marginals<'_> {
    /// Covariance of a variable; zero for a fixed one.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`], [`SmootherError::OutOfMemory`]
    pub fn covariance<X: Variable>(&self, id: VariableId<X>) -> Result<DMatrix<f64>, SmootherError> {
        self.joint(&[id.index])
    }

    /// Cross-covariance of two variables: rows of the first, columns of the second.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`], [`SmootherError::OutOfMemory`]
    pub fn cross_covariance<A: Variable, B: Variable>(
        &self,
        a: VariableId<A>,
        b: VariableId<B>,
    ) -> Result<DMatrix<f64>, SmootherError> {
        self.blocks(&[a.index], &[b.index])
    }

    /// Joint covariance of variables, given by their numbers ([`VariableId::index`]), in this order.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`], [`SmootherError::OutOfMemory`]
    pub fn joint(&self, variables: &[usize]) -> Result<DMatrix<f64>, SmootherError> {
        let joint = self.blocks(variables, variables)?;
        Ok(joint.symmetric_part())
    }

    /// $`\ln \det H`$ over all coordinates that are not fixed: with the cost it tells how likely the noise parameters are (Laplace).
    pub fn log_determinant(&self) -> f64 {
        self.structure.cholesky.pivots().iter().map(|pivot| pivot.ln()).sum()
    }

    fn blocks(&self, rows: &[usize], columns: &[usize]) -> Result<DMatrix<f64>, SmootherError> {
        let (rows, columns) = (self.coordinates(rows)?, self.coordinates(columns)?);
        let n = self.structure.equations.gradient().len();
        let mut inverse = DMatrix::zeros(n, columns.len());
        for (k, coordinate) in columns.iter().enumerate() {
            if let Some(coordinate) = coordinate {
                inverse[(*coordinate, k)] = 1.0;
            }
        }
        self.structure.cholesky.solve_in_place(inverse.as_mut_slice())?;
        Ok(DMatrix::from_fn(rows.len(), columns.len(), |i, k| rows[i].map_or(0.0, |row| inverse[(row, k)])))
    }

    /// Rows of the system for each tangent coordinate; `None` for those of fixed variables.
    fn coordinates(&self, variables: &[usize]) -> Result<Vec<Option<usize>>, SmootherError> {
        let mut coordinates = Vec::new();
        for variable in variables {
            let offset = *self.structure.offsets.get(*variable).ok_or(SmootherError::UnknownId)?;
            coordinates.extend((0..self.structure.dim(*variable)).map(|k| offset.map(|offset| offset + k)));
        }
        Ok(coordinates)
    }
}
