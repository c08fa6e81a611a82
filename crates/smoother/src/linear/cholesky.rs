use faer::{
    Conj, MatMut, Par, Side,
    dyn_stack::{MemBuffer, MemStack},
    sparse::{
        SparseColMatRef, SymbolicSparseColMat,
        linalg::cholesky::{
            CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
            factorize_symbolic_cholesky,
        },
    },
};

use super::pattern::Pattern;
use crate::SmootherError;

/// $`H = L L^T`$: what depends on the pattern is computed once, the numbers as often as wanted.
pub(crate) struct Cholesky {
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

/// A pivot that is not positive: the matrix is singular to rounding, or not a number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NotPositive;

impl Cholesky {
    pub(crate) fn new(pattern: &Pattern) -> Result<Self, SmootherError> {
        let n_rows = pattern.n_rows();
        let out_of_memory = || SmootherError::OutOfMemory { n_rows };
        let pattern = pattern.symbolic();
        let symbolic = factorize_symbolic_cholesky(
            pattern.as_ref(),
            Side::Upper,
            SymmetricOrdering::Identity,
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| out_of_memory())?;
        let memory =
            MemBuffer::try_new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()))
                .map_err(|_| out_of_memory())?;
        let mut factor = Vec::new();
        factor.try_reserve_exact(symbolic.len_val()).map_err(|_| out_of_memory())?;
        factor.resize(symbolic.len_val(), 0.0);
        Ok(Self { pattern, symbolic, factor, memory })
    }

    /// Factorizes the matrix with these entries of the upper triangle.
    pub(crate) fn factorize(&mut self, entries: &[f64]) -> Result<(), NotPositive> {
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                SparseColMatRef::new(self.pattern.as_ref(), entries),
                Side::Upper,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                Default::default(),
            )
            .map(|_| ())
            .map_err(|_| NotPositive)
    }

    /// Replaces the columns of `right_sides` by the solutions.
    pub(crate) fn solve_in_place(&self, right_sides: &mut [f64]) -> Result<(), SmootherError> {
        let n_rows = self.symbolic.nrows();
        if n_rows == 0 {
            return Ok(());
        }
        let n_columns = right_sides.len() / n_rows;
        let mut memory = MemBuffer::try_new(self.symbolic.solve_in_place_scratch::<f64>(n_columns, Par::Seq))
            .map_err(|_| SmootherError::OutOfMemory { n_rows })?;
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right_sides, n_rows, n_columns),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Ok(())
    }

    /// $`L_{kk}^2`$: the information on coordinate $`k`$ that those before it leave.
    pub(crate) fn pivots(&self) -> Vec<f64> {
        self.columns()
            .into_iter()
            .map(|(diagonal, _)| self.factor[diagonal] * self.factor[diagonal])
            .collect()
    }

    /// Additions and multiplications of a factorization: the sum of the squared numbers of entries in the columns of $`L`$. [Davis 2006, section 4.5]
    pub(crate) fn flop(&self) -> f64 {
        self.columns().into_iter().map(|(_, n_entries)| (n_entries * n_entries) as f64).sum()
    }

    /// For each column the place of its diagonal entry, and its number of entries.
    fn columns(&self) -> Vec<(usize, usize)> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(simplicial) => {
                simplicial.col_ptr().windows(2).map(|ends| (ends[0], ends[1] - ends[0])).collect()
            }
            SymbolicCholeskyRaw::Supernodal(supernodal) => {
                let values = supernodal.col_ptr_for_val();
                let n_rows_below = supernodal.col_ptr_for_row_idx();
                let nodes = supernodal.supernode_begin().iter().zip(supernodal.supernode_end()).enumerate();
                nodes
                    .flat_map(|(node, (begin, end))| {
                        let width = end - begin;
                        let height = width + n_rows_below[node + 1] - n_rows_below[node];
                        (0..width).map(move |k| (values[node] + k * (height + 1), height - k))
                    })
                    .collect()
            }
        }
    }
}
