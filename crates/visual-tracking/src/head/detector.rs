use super::edge::{GradientField, Rim};
use super::likelihood::{CueRatios, N_LEVELS, RatioSums, levels};
use super::search::{Candidate, Cues, Search};
use crate::{
    BoundingBox, ColorBinImage, ColorHistogram, ColorQuantizer, ColorSpace, HeadTrackerParams, RgbImage,
    RowSpans, SlidingHistogram, TrackingError,
};

/// Factor between two sizes that are compared: a head between two of them overlaps the nearer one by five sixths.
const SIZE_STEP: f64 = 1.2;

/// Finds a head in a picture without a box, by colours and rim learned from pictures with one. [Andrade-Cetto 2005, Sec. 3.2]
///
/// The score of an ellipse is that of [`HeadTracker`](crate::HeadTracker), with all of the pictures outside the heads as the surroundings. Heads
/// must have colours that the examples show.
///
/// ```
/// use wayfix_visual_tracking::{BoundingBox, HeadDetector, HeadTrackerParams, RgbImage};
/// let picture = |at: f64, radius: f64| {
///     RgbImage::from_fn(120, 80, |u, v| {
///         let r = (f64::from(u) + 0.5 - at).hypot(f64::from(v) + 0.5 - 40.0);
///         image::Rgb(if r < radius { [220, 160, 130] } else { [90, 120, 150] })
///     })
/// };
/// let (example, head) = (picture(40.0, 12.0), BoundingBox::from_center([40.0, 40.0], 24.0, 24.0)?);
/// let detector = HeadDetector::learn([(&example, head)], &HeadTrackerParams::default())?;
/// let found = detector.detect(&picture(85.0, 16.0), 12.0..=60.0)?.expect("a head");
/// assert!(found.iou(&BoundingBox::from_center([85.0, 40.0], 32.0, 32.0)?) > 0.6);
/// assert_eq!(detector.detect(&picture(-99.0, 16.0), 12.0..=60.0)?, None);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct HeadDetector {
    quantizer: ColorQuantizer,
    ratios: CueRatios,
    /// Height of a head beside its width.
    aspect: f64,
}

impl HeadDetector {
    /// Least width of a head, pixels.
    pub const MIN_WIDTH: f64 = 6.0;

    /// Learns from pictures with a box around the head in each, in bins as those of a tracker.
    ///
    /// # Errors
    /// Returns [`TrackingError::Empty`] without an example, [`TrackingError::OutsidePicture`] for a box beyond its picture, or
    /// [`TrackingError::Parameter`] for invalid bins.
    pub fn learn<'a>(
        examples: impl IntoIterator<Item = (&'a RgbImage, BoundingBox)>,
        params: &HeadTrackerParams,
    ) -> Result<Self, TrackingError> {
        let quantizer = ColorQuantizer::new(ColorSpace::Opponent, params.color_bins)?;
        let [mut head, mut around] = [vec![0.0; quantizer.n_bins()], vec![0.0; quantizer.n_bins()]];
        let [mut rim, mut elsewhere] = [[0.0; N_LEVELS]; 2];
        let [mut width, mut height] = [0.0; 2];
        for (picture, bounds) in examples {
            let bounds = bounds.clipped((picture.width() as usize, picture.height() as usize))?;
            let (bins, field) = (ColorBinImage::new(&quantizer, picture)?, GradientField::new(picture));
            let semi_axes = [bounds.width() / 2.0, bounds.height() / 2.0];
            let center = bounds.center().map(|c| c.floor() as i64);
            let inside = SlidingHistogram::new(&bins, RowSpans::ellipse(semi_axes)?, center).into_histogram();
            let whole = ColorHistogram::of_image(&bins);
            for (bin, (inside, whole)) in inside.counts().iter().zip(whole.counts()).enumerate() {
                head[bin] += inside;
                around[bin] += whole - inside;
            }
            let outline = Rim::ellipse(semi_axes);
            let [on, off] =
                [&[center][..], &outline.some_points(center)].map(|at| levels(&field, &outline, at));
            (0..N_LEVELS).for_each(|k| (rim[k], elsewhere[k]) = (rim[k] + on[k], elsewhere[k] + off[k]));
            (width, height) = (width + bounds.width(), height + bounds.height());
        }
        let n_pixels = head.iter().sum::<f64>();
        if n_pixels <= 0.0 {
            return Err(TrackingError::Empty { what: "pixels of the head" });
        }
        // One part: no more than the colours of all heads is learned.
        let shares = vec![head.iter().map(|count| count / n_pixels).collect()];
        let ratios = CueRatios::of_counts((shares, &[n_pixels]), &[around], rim, elsewhere);
        Ok(Self { quantizer, ratios, aspect: height / width })
    }

    /// The box around the most likely head of a width in this range, in pixels; `None` if no ellipse is likelier a head than not.
    ///
    /// # Errors
    /// Returns [`TrackingError::Parameter`] for a range that does not begin at 6 pixels or more, or is empty.
    pub fn detect(
        &self,
        picture: &RgbImage,
        widths: std::ops::RangeInclusive<f64>,
    ) -> Result<Option<BoundingBox>, TrackingError> {
        let (least, most) = (*widths.start(), *widths.end());
        crate::error::checked("least width of a head", least, least >= Self::MIN_WIDTH, "at least 6 pixels")?;
        let valid = most >= least && most.is_finite();
        crate::error::checked("largest width of a head", most, valid, "finite, at least the least")?;
        let (bins, field) = (ColorBinImage::new(&self.quantizer, picture)?, GradientField::new(picture));
        let cues = Cues::Ratios(&self.ratios, RatioSums::new(&self.ratios, &bins));
        let search = Search { bins: &bins, field: &field, cues };
        let middle = [i64::from(picture.width()) / 2, i64::from(picture.height()) / 2];
        let mut best: Option<Candidate> = None;
        let sizes = std::iter::successors(Some(least), |width| Some(width * SIZE_STEP));
        for width in sizes.take_while(|width| *width <= most) {
            let size = [width / 2.0, self.aspect * width / 2.0];
            let found = search.best(middle, middle[0].max(middle[1]), &[size])?;
            best = [best, found].into_iter().flatten().max_by(|a, b| a.log_ratio().total_cmp(&b.log_ratio()));
        }
        let Some(Candidate { center, semi_axes: [a, b], .. }) = best.filter(|best| best.log_ratio() > 0.0)
        else {
            return Ok(None);
        };
        BoundingBox::from_center(center.map(|c| c as f64 + 0.5), 2.0 * a, 2.0 * b).map(Some)
    }
}
