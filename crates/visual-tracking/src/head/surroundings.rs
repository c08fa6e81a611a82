use std::f64::consts::SQRT_2;

use crate::TrackingError;
use crate::{ColorBinImage, ColorHistogram, RowSpans, SlidingHistogram};

/// The counts of a head without the colours that are more frequent, by share, in the ring outside the ellipse.
///
/// The ring and the ellipse have equal areas. A box that is too large contains background at its rim; the background's colours would become a
/// mode of the head. If no colour is left, all are kept.
pub(super) fn own_colors(
    bins: &ColorBinImage,
    head: &ColorHistogram,
    center: [i64; 2],
    semi_axes: [f64; 2],
) -> Result<Vec<f64>, TrackingError> {
    let (_, around) = ring(bins, center, semi_axes)?;
    let n_around = around.iter().sum::<f64>();
    let n_head = head.total();
    let own: Vec<f64> = head
        .counts()
        .iter()
        .zip(around)
        .map(|(&count, around)| if around * n_head >= count * n_around && around > 0.0 { 0.0 } else { count })
        .collect();
    Ok(if own.iter().any(|&count| count > 0.0) { own } else { head.counts().to_vec() })
}

/// The colours in an ellipse, and the counts of those in the ring of equal area outside it.
pub(super) fn ring(
    bins: &ColorBinImage,
    center: [i64; 2],
    semi_axes: [f64; 2],
) -> Result<(ColorHistogram, Vec<f64>), TrackingError> {
    let count = |axes: [f64; 2]| -> Result<ColorHistogram, TrackingError> {
        Ok(SlidingHistogram::new(bins, RowSpans::ellipse(axes)?, center).into_histogram())
    };
    let (inside, both) = (count(semi_axes)?, count(semi_axes.map(|axis| SQRT_2 * axis))?);
    let around = both.counts().iter().zip(inside.counts()).map(|(both, inside)| both - inside).collect();
    Ok((inside, around))
}
