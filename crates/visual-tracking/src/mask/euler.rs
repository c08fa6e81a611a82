use super::PixelConnectivity;
use crate::PixelMask;

impl PixelMask {
    /// The Euler number: blobs minus holes, computed by local counting.
    ///
    /// Every run adds a piece, and every overlap of two rows joins two: $`E_4 = \sum_v r(A_v) - \sum_v r(A_v ∩ A_{v+1})`$ with $`r`$ the number of
    /// runs. Corners join as well in $`E_8 = E_4 - Q_D`$ with $`Q_D`$ squares of 2 × 2 that contain exactly one of their diagonals. This is the
    /// count by squares of [Gray 1971], arranged for three population counts per word.
    /// ```
    /// use wayfix_visual_tracking::{PixelMask, PixelConnectivity};
    /// let ring = PixelMask::from_fn(5, 5, |u, v| u.abs_diff(2).max(v.abs_diff(2)) == 1)?;
    /// let mask = ring.or(&PixelMask::from_fn(5, 5, |u, v| u == v && u == 4)?)?;
    /// assert_eq!(mask.euler_number(PixelConnectivity::Eight), 0);
    /// assert_eq!(mask.euler_number(PixelConnectivity::Four), 1);
    /// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
    /// ```
    pub fn euler_number(&self, connectivity: PixelConnectivity) -> i64 {
        let pairs = || self.rows().zip(self.rows().skip(1));
        let runs: u64 = self.rows().map(|row| n_runs(row.iter().copied())).sum();
        let joined: u64 = pairs().map(|(a, b)| n_runs(a.iter().zip(b).map(|(a, b)| a & b))).sum();
        let four = runs as i64 - joined as i64;
        match connectivity {
            PixelConnectivity::Four => four,
            PixelConnectivity::Eight => four - pairs().map(|(a, b)| n_diagonals(a, b)).sum::<u64>() as i64,
        }
    }
}

/// Number of bits whose left neighbour is off.
fn n_runs(row: impl Iterator<Item = u64>) -> u64 {
    let mut before = 0;
    let mut n = 0;
    for word in row {
        n += u64::from((word & !(word << 1 | before >> 63)).count_ones());
        before = word;
    }
    n
}

/// Squares of two rows in which one diagonal is on and the other off.
fn n_diagonals(upper: &[u64], lower: &[u64]) -> u64 {
    let right = |row: &[u64], i: usize| row[i] >> 1 | row.get(i + 1).map_or(0, |next| next << 63);
    let word = |i: usize| {
        let (a, b, c, d) = (upper[i], right(upper, i), lower[i], right(lower, i));
        // Both differ along the rows, and along the columns.
        u64::from(((a ^ b) & (c ^ d) & (a ^ c)).count_ones())
    };
    (0..upper.len()).map(word).sum()
}
