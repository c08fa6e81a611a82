use crate::PixelMask;

/// The eight neighbours clockwise from the right, as columns and rows are counted.
const AROUND: [(isize, isize); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

impl PixelMask {
    /// The outer contour of the first blob in row order, clockwise from its first pixel: pixels `[u, v]`, each adjacent to the next and the last
    /// to the first, by side or corner. Empty without pixels.
    ///
    /// Where the blob is one pixel thin the contour runs in both directions and lists pixels twice. [Moore's neighbour tracing]
    /// ```
    /// use wayfix_visual_tracking::PixelMask;
    /// let mask = PixelMask::from_fn(9, 9, |u, v| (2..5).contains(&u) && (3..6).contains(&v))?;
    /// let ring = [[2, 3], [3, 3], [4, 3], [4, 4], [4, 5], [3, 5], [2, 5], [2, 4]];
    /// assert_eq!(mask.outer_contour(), ring);
    /// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
    /// ```
    pub fn outer_contour(&self) -> Vec<[usize; 2]> {
        let Some(start) = self.first_pixel() else { return Vec::new() };
        let mut contour = vec![start];
        // No pixel left of or above the first one is on.
        let Some(first) = self.next_around(start, 0) else { return contour };
        let (mut pixel, mut direction) = (start, first);
        loop {
            pixel = neighbour(pixel, direction);
            // The last neighbour that was off is beside the step just made; the search continues after it.
            direction = self.next_around(pixel, direction + 7 - direction % 2).unwrap_or(direction);
            if pixel == start && direction == first {
                return contour;
            }
            contour.push(pixel);
        }
    }

    fn first_pixel(&self) -> Option<[usize; 2]> {
        let i = self.words().iter().position(|&word| word != 0)?;
        let n = self.words_per_row();
        Some([64 * (i % n) + self.words()[i].trailing_zeros() as usize, i / n])
    }

    /// The direction of the first neighbour that is on, clockwise from direction `from`.
    fn next_around(&self, pixel: [usize; 2], from: usize) -> Option<usize> {
        (from..from + 8).map(|direction| direction % 8).find(|&direction| {
            let [u, v] = neighbour(pixel, direction);
            self.get(u, v)
        })
    }
}

/// A neighbour; beyond the left and upper edges the largest number, where no mask reaches.
fn neighbour([u, v]: [usize; 2], direction: usize) -> [usize; 2] {
    let (du, dv) = AROUND[direction];
    [u.wrapping_add_signed(du), v.wrapping_add_signed(dv)]
}
