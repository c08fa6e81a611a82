use rand::Rng;

use super::{BackProjection, MeanShiftParams};
use crate::error::check_size;
use crate::{
    BinImage, BoundingBox, ColorHistogram, ColorQuantizer, CondensationError, Picture, RowSpans,
    SlidingHistogram, Target, TrackStatus, Tracker,
};

/// Follows a box by its colours alone: back-projection, mean shift, and a window as large as what it holds. [Bradski 1998]
///
/// The cheapest tracker, and a measure for better ones: it knows one fixed model of colour, so that a change of light is a loss, and no shape, so
/// that a background of the target's colours is taken for the target.
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_condensation::{BoundingBox, MeanShift, MeanShiftParams, Picture, TrackStatus, Tracker};
/// let ball = |u: f64, v: f64| {
///     let inside = |i: usize| ((i % 80) as f64 - u).hypot((i / 80) as f64 - v) < 9.0;
///     Picture::from_rgb(80, 60, (0..80 * 60).flat_map(|i| if inside(i) { [230, 90, 20] } else { [60, 110, 70] }).collect())
/// };
/// let start = BoundingBox::from_center([20.5, 30.5], 18.0, 18.0)?;
/// let mut tracker = MeanShift::start(&ball(20.0, 30.0)?, &start, MeanShiftParams::default())?;
/// let mut rng = ChaCha8Rng::seed_from_u64(1); // a mean shift needs no luck
/// let target = tracker.track(&ball(26.0, 34.0)?, &mut rng)?;
/// assert_eq!(target.status, TrackStatus::Tracked);
/// assert!(target.bounding_box.iou(&BoundingBox::from_center([26.5, 34.5], 18.0, 18.0)?) > 0.85);
/// assert!(tracker.track(&Picture::from_rgb(2, 2, vec![0; 12])?, &mut rng).is_err());
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeanShift {
    params: MeanShiftParams,
    quantizer: ColorQuantizer,
    /// Of each bin, in 255ths.
    weights: Vec<u8>,
    picture_size: (usize, usize),
    /// How much the target's colours stood out at the start.
    contrast: f64,
    /// Sides of the window by standard deviations of what it held at the start.
    sides_per_sigma: [f64; 2],
    window: BoundingBox,
    status: TrackStatus,
}

/// Colours that stand out less are everywhere: a target of such colours is lost from the start.
const LEAST_CONTRAST: f64 = 0.05;

/// Less is too small to tell by its moments that it should grow, pixels.
const LEAST_SIDE: f64 = 2.0;

impl MeanShift {
    /// Learns the colours in the ellipse that fits into a box.
    ///
    /// # Errors
    /// [`CondensationError::Empty`] when the box holds no pixel of the picture, [`CondensationError::Parameter`] when it is beyond all sizes or
    /// a parameter is out of its range.
    pub fn start(
        picture: &Picture,
        bounding_box: &BoundingBox,
        params: MeanShiftParams,
    ) -> Result<Self, CondensationError> {
        let quantizer = params.quantizer()?;
        let image = BinImage::new(&quantizer, &picture.whole())?;
        let ellipse = RowSpans::ellipse([bounding_box.width() / 2.0, bounding_box.height() / 2.0])?;
        let center = bounding_box.center().map(|x| x.floor() as i64);
        let model = SlidingHistogram::new(&image, ellipse, center).into_histogram();
        let weights = BackProjection::ratio(&model, &ColorHistogram::of_image(&image))?;
        let mut tracker = Self {
            params,
            picture_size: (picture.width(), picture.height()),
            contrast: 0.0,
            sides_per_sigma: [0.0; 2],
            window: *bounding_box,
            status: TrackStatus::Tracked,
            weights,
            quantizer,
        };
        let projection = BackProjection::new(&image, &tracker.weights)?;
        let around = tracker.enlarged(bounding_box)?;
        let nothing = CondensationError::Empty { what: "pixels of the picture in the box" };
        let around = projection.moments(&around).ok_or(nothing)?;
        tracker.contrast = projection.contrast(bounding_box).max(LEAST_CONTRAST);
        let sides = [bounding_box.width(), bounding_box.height()];
        tracker.sides_per_sigma = [0, 1].map(|axis| sides[axis] / around.sigma[axis]);
        Ok(tracker)
    }

    /// The window as wide and high as what it holds, as far as growth allows.
    fn fitted(
        &self,
        projection: &BackProjection,
        window: &BoundingBox,
    ) -> Result<BoundingBox, CondensationError> {
        let Some(around) = projection.moments(&self.enlarged(window)?) else { return Ok(*window) };
        let side = |axis: usize, before: f64, len: usize| {
            let side = self.sides_per_sigma[axis] * around.sigma[axis];
            side.clamp(before / self.params.growth, before * self.params.growth)
                .min(len as f64)
                .max(LEAST_SIDE)
        };
        let width = side(0, window.width(), projection.width());
        BoundingBox::from_center(window.center(), width, side(1, window.height(), projection.height()))
    }

    fn enlarged(&self, window: &BoundingBox) -> Result<BoundingBox, CondensationError> {
        let factor = 1.0 + self.params.margin;
        BoundingBox::from_center(window.center(), factor * window.width(), factor * window.height())
    }
}

impl Tracker for MeanShift {
    fn track<R: Rng + ?Sized>(&mut self, picture: &Picture, _: &mut R) -> Result<Target, CondensationError> {
        check_size("width of a picture", self.picture_size.0, picture.width())?;
        check_size("height of a picture", self.picture_size.1, picture.height())?;
        let image = BinImage::new(&self.quantizer, &picture.whole())?;
        let projection = BackProjection::new(&image, &self.weights)?;
        let (width, height) = (self.window.width(), self.window.height());
        let (from, enough) = match self.status {
            TrackStatus::Tracked => (self.window, self.params.lost_below),
            TrackStatus::Lost => {
                (projection.densest(width, height).unwrap_or(self.window), self.params.found_above)
            }
        };
        let window = projection.climb(from, self.params.max_iterations, self.params.tolerance);
        let quality = (projection.contrast(&window) / self.contrast).clamp(0.0, 1.0);
        if quality >= enough {
            self.window = self.fitted(&projection, &window)?;
            self.status = TrackStatus::Tracked;
        } else {
            self.status = TrackStatus::Lost;
        }
        Ok(Target { bounding_box: self.window, outline: Vec::new(), status: self.status, quality })
    }
}
