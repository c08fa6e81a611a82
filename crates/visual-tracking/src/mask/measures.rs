use super::runs::runs;
use crate::{PixelMask, PixelRect, TrackingError};

impl PixelMask {
    /// Number of pixels that are on.
    pub fn area(&self) -> usize {
        self.words().iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Whether no pixel is on.
    pub fn is_empty(&self) -> bool {
        self.words().iter().all(|&word| word == 0)
    }

    /// The mean of the middles of the pixels that are on, `[u, v]` in pixels; none without pixels.
    ///
    /// ```
    /// use wayfix_visual_tracking::PixelMask;
    /// let mask = PixelMask::from_fn(9, 9, |u, v| u == 3 && v < 2)?;
    /// assert_eq!(mask.centroid(), Some([3.5, 1.0]));
    /// assert_eq!(mask.bounding_rect().map(|rect| rect.size()), Some((1, 2)));
    /// assert_eq!(mask.iou(&PixelMask::from_fn(9, 9, |u, v| u == 3 && v < 4)?)?, 0.5);
    /// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
    /// ```
    pub fn centroid(&self) -> Option<[f64; 2]> {
        let (mut n, mut twice_u, mut twice_v) = (0_u64, 0_u64, 0_u64);
        for (v, run) in self.runs() {
            let len = run.len() as u64;
            n += len;
            twice_u += (run.start + run.end) as u64 * len;
            twice_v += (2 * v + 1) as u64 * len;
        }
        (n > 0).then(|| [twice_u, twice_v].map(|twice| twice as f64 / (2 * n) as f64))
    }

    /// The bounding rectangle of the pixels that are on; `None` without pixels.
    pub fn bounding_rect(&self) -> Option<PixelRect> {
        let is_on = |row: &&[u64]| row.iter().any(|&word| word != 0);
        let top = self.rows().position(|row| is_on(&row))?;
        let height = self.height() - self.rows().rev().position(|row| is_on(&row))? - top;
        let mut columns = vec![0; self.words_per_row()];
        for row in self.rows() {
            columns.iter_mut().zip(row).for_each(|(all, word)| *all |= word);
        }
        let (left, end) = (runs(&columns).next()?.start, runs(&columns).last()?.end);
        Some(PixelRect { left, top, width: end - left, height })
    }

    /// Number of pixels that are on in both masks.
    /// # Errors
    /// Returns [`TrackingError::Dimension`] if the sizes differ.
    pub fn overlap(&self, other: &Self) -> Result<usize, TrackingError> {
        other.check_size(self.size())?;
        Ok(self.words().iter().zip(other.words()).map(|(a, b)| (a & b).count_ones() as usize).sum())
    }

    /// Intersection over union: 1 for equal masks, 0 for masks apart and for two empty ones.
    ///
    /// # Errors
    /// Returns the errors of [`overlap`](Self::overlap).
    pub fn iou(&self, other: &Self) -> Result<f64, TrackingError> {
        let shared = self.overlap(other)?;
        let union = self.area() + other.area() - shared;
        Ok(if union == 0 { 0.0 } else { shared as f64 / union as f64 })
    }
}
