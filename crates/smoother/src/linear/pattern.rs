use std::ops::Range;

use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMat, linalg::amd},
};

use super::block_address::{BlockAddress, Place};
use crate::SmootherError;

/// The blocks of a symmetric matrix that can differ from zero, in an order of elimination that keeps the factor sparse.
pub(crate) struct Pattern {
    /// First row of each block.
    offsets: Vec<usize>,
    dims: Vec<usize>,
    /// For each block the blocks before it in the order of elimination that it meets, by first row.
    above: Vec<Vec<usize>>,
    column_starts: Vec<usize>,
    rows: Vec<usize>,
}

impl Pattern {
    /// `pairs` are the blocks beside the diagonal, in any order, repeated or not.
    ///
    /// The order is the approximate minimum degree of the blocks. [Amestoy, Davis & Duff 1996]
    pub(crate) fn new(dims: &[usize], pairs: &[(usize, usize)]) -> Result<Self, SmootherError> {
        let mut pairs: Vec<_> = pairs.iter().map(|&(a, b)| (a.min(b), a.max(b))).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let order = minimum_degree(dims.len(), &pairs)?;
        Ok(Self::with_order(dims, &pairs, &order))
    }

    /// The same blocks with other dimensions.
    pub(crate) fn resized(&self, dim: usize) -> Self {
        let mut order: Vec<usize> = (0..self.dims.len()).collect();
        order.sort_by_key(|block| self.offsets[*block]);
        let pairs: Vec<_> =
            (0..self.dims.len()).flat_map(|b| self.above[b].iter().map(move |a| (*a, b))).collect();
        Self::with_order(&vec![dim; self.dims.len()], &pairs, &order)
    }

    fn with_order(dims: &[usize], pairs: &[(usize, usize)], order: &[usize]) -> Self {
        let mut offsets = vec![0; dims.len()];
        let mut n_rows = 0;
        for block in order {
            offsets[*block] = n_rows;
            n_rows += dims[*block];
        }
        let mut above = vec![Vec::new(); dims.len()];
        for (a, b) in pairs {
            let (upper, lower) = if offsets[*a] < offsets[*b] { (*a, *b) } else { (*b, *a) };
            above[lower].push(upper);
        }
        for blocks in &mut above {
            blocks.sort_unstable_by_key(|block| offsets[*block]);
        }
        let (mut column_starts, mut rows) = (vec![0], Vec::new());
        for block in order {
            for k in 0..dims[*block] {
                for upper in &above[*block] {
                    rows.extend(offsets[*upper]..offsets[*upper] + dims[*upper]);
                }
                rows.extend(offsets[*block]..=offsets[*block] + k);
                column_starts.push(rows.len());
            }
        }
        Self { offsets, dims: dims.to_vec(), above, column_starts, rows }
    }

    /// Where the block of `a` and `b` lies; `None` when it is not among the pairs.
    pub(crate) fn address(&self, a: usize, b: usize) -> Option<BlockAddress> {
        let place = match self.offsets[a].cmp(&self.offsets[b]) {
            std::cmp::Ordering::Equal => Place::Diagonal,
            std::cmp::Ordering::Less => Place::Above,
            std::cmp::Ordering::Greater => Place::Below,
        };
        let (upper, lower) = if place == Place::Below { (b, a) } else { (a, b) };
        let first = self.column_starts[self.offsets[lower]];
        let first_column = &self.rows[first..self.column_starts[self.offsets[lower] + 1]];
        let start = first + first_column.binary_search(&self.offsets[upper]).ok()?;
        Some(BlockAddress { place, start, height: first_column.len() - 1 })
    }

    pub(crate) fn n_rows(&self) -> usize {
        self.column_starts.len() - 1
    }
    pub(crate) fn n_entries(&self) -> usize {
        self.rows.len()
    }
    pub(crate) fn rows(&self) -> &[usize] {
        &self.rows
    }
    pub(crate) fn column(&self, column: usize) -> Range<usize> {
        self.column_starts[column]..self.column_starts[column + 1]
    }
    /// The diagonal is the last entry of its column.
    pub(crate) fn diagonal_entry(&self, column: usize) -> usize {
        self.column_starts[column + 1] - 1
    }
    pub(crate) fn offset(&self, block: usize) -> usize {
        self.offsets[block]
    }
    pub(crate) fn dim(&self, block: usize) -> usize {
        self.dims[block]
    }
    /// The upper triangle for faer.
    pub(crate) fn symbolic(&self) -> SymbolicSparseColMat<usize> {
        let n = self.n_rows();
        SymbolicSparseColMat::new_checked(n, n, self.column_starts.clone(), None, self.rows.clone())
    }
}

fn minimum_degree(n: usize, pairs: &[(usize, usize)]) -> Result<Vec<usize>, SmootherError> {
    let mut starts = vec![0; n + 1];
    for (a, _) in pairs {
        starts[a + 1] += 1;
    }
    for i in 0..n {
        starts[i + 1] += starts[i];
    }
    let rows = pairs.iter().map(|(_, b)| *b).collect();
    let blocks = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
    let (mut order, mut inverse) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(n, pairs.len()))
        .map_err(|_| SmootherError::OutOfMemory { n_rows: n })?;
    amd::order(
        &mut order,
        &mut inverse,
        blocks.as_ref(),
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .map_err(|_| SmootherError::OutOfMemory { n_rows: n })?;
    Ok(order)
}
