use std::ops::Range;

use super::{ColorBinImage, ColorHistogram, RowSpans};

/// The histogram of a shape that moves over an image: each move counts only the pixels in which the two positions differ.
/// [Birchfield 1998; Andrade-Cetto 2005, Sec. 3.2]
///
/// Parts of the shape outside the image contribute no pixels.
/// ```
/// use wayfix_visual_tracking::{ColorBinImage, ColorQuantizer, ColorSpace, RgbImage, RowSpans, SlidingHistogram};
/// let bytes = (0..3 * 40 * 30).map(|i| (i * i / 7) as u8).collect();
/// let picture = RgbImage::from_raw(40, 30, bytes).expect("3 bytes a pixel");
/// let quantizer = ColorQuantizer::new(ColorSpace::Opponent, [16, 16, 4])?;
/// let image = ColorBinImage::new(&quantizer, &picture)?;
/// let ellipse = RowSpans::ellipse([6.0, 9.0])?;
/// let mut sliding = SlidingHistogram::new(&image, ellipse.clone(), [20, 15]);
/// sliding.move_to([21, 14]);
/// assert_eq!(sliding.histogram(), SlidingHistogram::new(&image, ellipse, [21, 14]).histogram());
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SlidingHistogram<'a> {
    image: &'a ColorBinImage,
    spans: RowSpans,
    center: [i64; 2],
    histogram: ColorHistogram,
}

impl<'a> SlidingHistogram<'a> {
    /// Counts the pixels of a shape centred in column and row `center`.
    pub fn new(image: &'a ColorBinImage, spans: RowSpans, center: [i64; 2]) -> Self {
        let rows = spans.rows_within(center, image.height());
        let covered = rows.map(|v| &image.row(v)[spans.columns_within(center, v, image.width())]);
        let histogram = ColorHistogram::counted(image.n_bins(), covered);
        Self { image, spans, center, histogram }
    }

    /// Moves the centre.
    pub fn move_to(&mut self, center: [i64; 2]) {
        let before = std::mem::replace(&mut self.center, center);
        exchange(self.image, &mut self.histogram, (&self.spans, before), (&self.spans, center));
    }

    /// Changes the shape, for example its size.
    pub fn reshape(&mut self, spans: RowSpans) {
        let before = std::mem::replace(&mut self.spans, spans);
        exchange(self.image, &mut self.histogram, (&before, self.center), (&self.spans, self.center));
    }

    /// Position of the centre.
    pub fn center(&self) -> [i64; 2] {
        self.center
    }

    /// The shape.
    pub fn spans(&self) -> &RowSpans {
        &self.spans
    }

    /// The counts of the pixels under the shape.
    pub fn histogram(&self) -> &ColorHistogram {
        &self.histogram
    }

    /// The counts, to keep.
    pub fn into_histogram(self) -> ColorHistogram {
        self.histogram
    }
}

type Placed<'a> = (&'a RowSpans, [i64; 2]);

/// Removes the pixels that are only under the old shape, then adds those only under the new one.
fn exchange(image: &ColorBinImage, histogram: &mut ColorHistogram, old: Placed<'_>, new: Placed<'_>) {
    let rows = |(spans, center): Placed<'_>| spans.rows_within(center, image.height());
    let columns = |(spans, center): Placed<'_>, v| spans.columns_within(center, v, image.width());
    // Rows between two shapes far apart are in neither.
    for v in rows(old).start.min(rows(new).start)..rows(old).end.max(rows(new).end) {
        let (row, old, new) = (image.row(v), columns(old, v), columns(new, v));
        difference(&old, &new).into_iter().for_each(|part| histogram.remove(&row[part]));
        difference(&new, &old).into_iter().for_each(|part| histogram.add(&row[part]));
    }
}

/// The parts of `a` left of and right of `b`.
fn difference(a: &Range<usize>, b: &Range<usize>) -> [Range<usize>; 2] {
    let part = |start: usize, end: usize| start..end.max(start);
    [part(a.start, a.end.min(b.start)), part(a.start.max(b.end), a.end)]
}
