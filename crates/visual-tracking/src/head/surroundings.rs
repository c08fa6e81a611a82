use std::f64::consts::SQRT_2;

use crate::TrackingError;
use crate::{BinImage, ColorHistogram, RowSpans, SlidingHistogram};

/// The counts of a head without the colours of what is around it: those that are more frequent, by share, in the ring outside the ellipse.
///
/// The ring has the area of the ellipse. A box that is too large has background at its rim; its colours would be a mode of the head, and
/// background alone would be the head. Where no colour is left, the head has those of its surroundings, and all are kept.
pub(super) fn own_colors(
    bins: &BinImage,
    head: &ColorHistogram,
    center: [i64; 2],
    semi_axes: [f64; 2],
) -> Result<Vec<f64>, TrackingError> {
    let count = |axes: [f64; 2]| -> Result<ColorHistogram, TrackingError> {
        Ok(SlidingHistogram::new(bins, RowSpans::ellipse(axes)?, center).into_histogram())
    };
    let (inside, both) = (count(semi_axes)?, count(semi_axes.map(|axis| SQRT_2 * axis))?);
    let n_around = both.total() - inside.total();
    let n_head = head.total();
    let around = both.counts().iter().zip(inside.counts()).map(|(both, inside)| both - inside);
    let own: Vec<f64> = head
        .counts()
        .iter()
        .zip(around)
        .map(|(&count, around)| if around * n_head >= count * n_around && around > 0.0 { 0.0 } else { count })
        .collect();
    Ok(if own.iter().any(|&count| count > 0.0) { own } else { head.counts().to_vec() })
}
