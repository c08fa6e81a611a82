use std::ops::Range;

use crate::TrackingError;
use crate::error::checked;

/// A shape without gaps along its rows: for every row about its centre the columns it covers.
///
/// ```
/// use wayfix_visual_tracking::RowSpans;
/// let ellipse = RowSpans::ellipse([20.0, 30.0])?;
/// let exact = std::f64::consts::PI * 20.0 * 30.0;
/// assert!((ellipse.area() as f64 / exact - 1.0).abs() < 0.01);
/// assert_eq!(ellipse.columns(-30), Some(0..1));
/// assert_eq!(RowSpans::rectangle(5, 3)?.columns(1), Some(-2..3));
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowSpans {
    top: i64,
    spans: Vec<Range<i64>>,
}

/// The largest half-width or half-height in pixels.
const MAX_EXTENT: f64 = 16384.0;

impl RowSpans {
    /// The pixels whose centres lie in the ellipse with semi-axes `[a, b]`, $`(u / a)^2 + (v / b)^2 ≤ 1`$ from the middle of the centre pixel.
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if a semi-axis is not positive or above 16384 pixels.
    pub fn ellipse([a, b]: [f64; 2]) -> Result<Self, TrackingError> {
        for semi_axis in [a, b] {
            let valid = semi_axis > 0.0 && semi_axis <= MAX_EXTENT;
            checked("semi-axis of an ellipse", semi_axis, valid, "above 0 and at most 16384")?;
        }
        let top = -(b.floor() as i64);
        let half = |v: i64| (a * (1.0 - (v as f64 / b).powi(2)).max(0.0).sqrt()).floor() as i64;
        Ok(Self { top, spans: (top..=-top).map(half).map(|half| -half..half + 1).collect() })
    }

    /// So many columns and rows; of an even number, one more is left of or above the centre.
    ///
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if a side is zero or above 32768 pixels.
    pub fn rectangle(width: usize, height: usize) -> Result<Self, TrackingError> {
        for side in [width, height] {
            let valid = side > 0 && side as f64 <= 2.0 * MAX_EXTENT;
            checked("side of a rectangle", side as f64, valid, "above 0 and at most 32768")?;
        }
        let left = -(width as i64 / 2);
        Ok(Self { top: -(height as i64 / 2), spans: vec![left..left + width as i64; height] })
    }

    /// The rows it has, counted from the centre.
    pub fn rows(&self) -> Range<i64> {
        self.top..self.top + self.spans.len() as i64
    }

    /// The columns it covers in a row, both counted from the centre.
    pub fn columns(&self, row: i64) -> Option<Range<i64>> {
        self.spans.get(usize::try_from(row.checked_sub(self.top)?).ok()?).cloned()
    }

    /// Number of pixels.
    pub fn area(&self) -> usize {
        self.spans.iter().map(|span| (span.end - span.start) as usize).sum()
    }

    /// The rows of a picture of that height that the shape about `center` covers.
    pub(super) fn rows_within(&self, center: [i64; 2], height: usize) -> Range<usize> {
        shifted(&self.rows(), center[1], height)
    }

    /// The columns of row `v` of a picture of that width that the shape about `center` covers.
    pub(super) fn columns_within(&self, center: [i64; 2], v: usize, width: usize) -> Range<usize> {
        let columns = self.columns((v as i64).saturating_sub(center[1])).unwrap_or(0..0);
        shifted(&columns, center[0], width)
    }
}

/// A range moved and cut to `0 .. limit`.
fn shifted(range: &Range<i64>, by: i64, limit: usize) -> Range<usize> {
    let cut = |x: i64| (x.saturating_add(by).max(0) as usize).min(limit);
    cut(range.start)..cut(range.end)
}
