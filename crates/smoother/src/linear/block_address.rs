/// Where the block of two variables lies in the stored upper triangle.
///
/// A column of the matrix holds the rows above the diagonal block, `height` of them, and its part of the diagonal block.
#[derive(Clone, Copy)]
pub struct BlockAddress {
    pub(crate) place: Place,
    /// First entry of the block in its first column.
    pub(crate) start: usize,
    /// Number of entries above the diagonal block.
    pub(crate) height: usize,
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// A variable is fixed: there is no block.
    Nowhere,
    Diagonal,
    /// The first variable has the rows.
    Above,
    /// The second variable has the rows.
    Below,
}

impl BlockAddress {
    pub(crate) const NOWHERE: Self = Self { place: Place::Nowhere, start: 0, height: 0 };

    /// Entry of row `i` and column `k` of the block.
    #[inline]
    pub(crate) fn entry(&self, i: usize, k: usize) -> usize {
        self.start + k * self.height + k * (k + 1) / 2 + i
    }

    /// Adds $`L^T R`$ for matrices by columns; `shape` is the number of rows, of columns of L and of columns of R.
    #[inline]
    pub(crate) fn add_product(
        &self,
        left: &[f64],
        right: &[f64],
        shape: (usize, usize, usize),
        entries: &mut [f64],
    ) {
        let (rows, n_left, n_right) = shape;
        if self.place == Place::Nowhere {
            return;
        }
        for k in 0..n_right {
            let column = &right[k * rows..(k + 1) * rows];
            let n_left = if self.place == Place::Diagonal { k + 1 } else { n_left };
            for i in 0..n_left {
                let product: f64 =
                    left[i * rows..(i + 1) * rows].iter().zip(column).map(|(a, b)| a * b).sum();
                let entry = if self.place == Place::Below { self.entry(k, i) } else { self.entry(i, k) };
                entries[entry] += product;
            }
        }
    }
}
