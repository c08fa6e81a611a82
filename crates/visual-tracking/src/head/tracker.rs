use rand::Rng;
use std::f64::consts::TAU;

use super::bimodal::BimodalHistogram;
use super::edge::GradientField;
use super::likelihood::{CueRatios, RatioSums};
use super::params::HeadTrackerParams;
use super::scale_source::{HeadSizeFromSearch, RelativeHeadSizeSource};
use super::search::{Candidate, Cues, Search, n_inside};
use super::surroundings::own_colors;
use crate::error::{check_size, checked};
use crate::{
    BoundingBox, ColorBinImage, ColorQuantizer, ColorSpace, RowSpans, SlidingHistogram, TargetEstimate,
    TrackStatus, Tracker,
};
use crate::{RgbImage, TrackingError};

/// Semi-axes below which an ellipse has no colours to speak of, in pixels.
const MIN_SEMI_AXIS: f64 = 3.0;
/// Points of an outline.
const N_OUTLINE: usize = 48;

/// Tracks a head as an upright ellipse, by the colours inside and the gradient across its rim. [Andrade-Cetto 2005, Sec. 3.2;
/// Birchfield 1998]
///
/// Every ellipse $`E`$ around the constant-velocity prediction is scored by the log-likelihood ratio of head and surroundings,
///
/// ```math
/// \sum_{p \in E} \ln \frac{M(c_p)}{R(c_p)} + \sum_{i \in \partial E} \ln \frac{H(|n_i · g_i|)}{S(|n_i · g_i|)},
/// ```
///
/// with the colour distributions $`M`$ of the head and $`R`$ of the ring of equal area around it, and the distributions $`H`$ and $`S`$ of the
/// gradient across its rim and across displaced rims. $`M`$ and $`R`$ are those of the upper, middle or lower third of the head that holds $`p`$: without
/// the place of its colours a histogram does not give the size. All are measured in the last picture; the highest sum wins. $`M`$ and $`H`$
/// adapt [Andrade-Cetto 2005, Eq. 29] where that sum is positive. The histogram intersection [Andrade-Cetto 2005, Eq. 28] detects a lost head. The size
/// comes from a [`RelativeHeadSizeSource`] or from the search.
///
/// With a fixed [`gradient_weight`](HeadTrackerParams::gradient_weight), intersection and mean gradient are scaled to their ranges and added, as
/// published. Skin and hair are then two modes of variable proportion.
/// ```
/// use rand::SeedableRng;
/// use rand_chacha::ChaCha8Rng;
/// use wayfix_visual_tracking::{BoundingBox, HeadTracker, HeadTrackerParams, RgbImage, Tracker};
/// let picture = |middle: f64| {
///     let color = |u: f64, v: f64| match ((u - middle) / 12.0).hypot((v - 30.0) / 15.0) {
///         r if r > 1.0 => [90, 120, 150],
///         _ if v < 24.0 => [60, 40, 30],
///         _ => [220, 160, 130],
///     };
///     let bytes = (0..100 * 60).flat_map(|i| color(f64::from(i % 100) + 0.5, f64::from(i / 100) + 0.5));
///     RgbImage::from_raw(100, 60, bytes.collect()).expect("3 bytes a pixel")
/// };
/// let head = BoundingBox::from_center([40.0, 30.0], 24.0, 30.0)?;
/// let mut tracker = HeadTracker::new(&picture(40.0), head, HeadTrackerParams::default())?;
/// let target = tracker.track(&picture(44.0), &mut ChaCha8Rng::seed_from_u64(0))?;
/// assert!((target.bounding_box.center()[0] - 44.0).abs() < 1.5);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct HeadTracker<S = HeadSizeFromSearch> {
    params: HeadTrackerParams,
    picture_size: (usize, usize),
    quantizer: ColorQuantizer,
    model: BimodalHistogram,
    /// With fixed weights `None`.
    ratios: Option<CueRatios>,
    scale_source: S,
    /// Semi-axes of the first ellipse.
    base: [f64; 2],
    state: HeadState,
}

/// Estimated state of the head.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HeadState {
    center: [i64; 2],
    velocity: [i64; 2],
    scale: f64,
    n_without_evidence: usize,
    is_lost: bool,
}

impl HeadTracker {
    /// Starts from the box around the head in the first picture.
    ///
    /// # Errors
    /// Returns [`TrackingError::Parameter`] for a parameter out of its range or a head less than 6 pixels wide,
    /// [`TrackingError::OutsidePicture`] for a box beyond the picture.
    pub fn new(
        picture: &RgbImage,
        head: BoundingBox,
        params: HeadTrackerParams,
    ) -> Result<Self, TrackingError> {
        let head = head.clipped((picture.width() as usize, picture.height() as usize))?;
        params.validate()?;
        let base = [head.width() / 2.0, head.height() / 2.0];
        for semi_axis in base {
            checked("semi-axis of the head", semi_axis, semi_axis >= MIN_SEMI_AXIS, "at least 3 pixels")?;
        }
        let quantizer = ColorQuantizer::new(ColorSpace::Opponent, params.color_bins)?;
        let bins = ColorBinImage::new(&quantizer, picture)?;
        let center = head.center().map(|c| c.floor() as i64);
        let histogram = SlidingHistogram::new(&bins, RowSpans::ellipse(base)?, center).into_histogram();
        let (model, ratios) = match params.gradient_weight {
            Some(_) => {
                let own = own_colors(&bins, &histogram, center, base)?;
                (BimodalHistogram::new(&quantizer, &own, params.bimodal_colors)?, None)
            }
            None => {
                // The ratios leave out the colours of the surroundings, and a colour's share gives its weight.
                let model = BimodalHistogram::new(&quantizer, histogram.counts(), false)?;
                let field = GradientField::new(picture);
                let ratios = CueRatios::measured((&bins, &field), (center, base), None)?;
                (model, Some(ratios))
            }
        };
        let state = HeadState { center, velocity: [0; 2], scale: 1.0, n_without_evidence: 0, is_lost: false };
        let picture_size = (picture.width() as usize, picture.height() as usize);
        Ok(Self {
            params,
            picture_size,
            quantizer,
            model,
            ratios,
            scale_source: HeadSizeFromSearch,
            base,
            state,
        })
    }
}

impl<S: RelativeHeadSizeSource> HeadTracker<S> {
    /// Replaces the source of the scale.
    pub fn with_scale_source<T: RelativeHeadSizeSource>(self, scale_source: T) -> HeadTracker<T> {
        let Self { params, picture_size, quantizer, model, ratios, base, state, .. } = self;
        HeadTracker { params, picture_size, quantizer, model, ratios, scale_source, base, state }
    }

    /// The scales to compare in the next picture.
    fn scales(&mut self, picture: &RgbImage) -> Result<Vec<f64>, TrackingError> {
        let center = self.state.center.map(|c| c as f64 + 0.5);
        let smallest = (MIN_SEMI_AXIS / self.base[0].min(self.base[1])).min(1.0);
        let (width, height) = (self.picture_size.0 as f64, self.picture_size.1 as f64);
        let largest = (width / self.base[0]).min(height / self.base[1]);
        let scales = match self.scale_source.scale(picture, center) {
            Some(scale) => {
                vec![checked("scale of the head", scale, scale > 0.0 && scale.is_finite(), "positive")?]
            }
            None => [1.0 / self.params.scale_step, 1.0, self.params.scale_step]
                .map(|f| f * self.state.scale)
                .to_vec(),
        };
        Ok(scales.into_iter().map(|scale| scale.clamp(smallest, largest)).collect())
    }

    /// The best ellipse; of a lost head, in the whole picture.
    fn found(
        &self,
        bins: &ColorBinImage,
        field: &GradientField,
        scales: &[f64],
    ) -> Result<Option<Candidate>, TrackingError> {
        let HeadState { center, velocity, scale, is_lost, .. } = self.state;
        let cues = match &self.ratios {
            Some(ratios) => Cues::Ratios(ratios, RatioSums::new(ratios, bins)),
            None => Cues::Fixed(&self.model, self.params.gradient_weight.unwrap_or(0.0)),
        };
        let search = Search { bins, field, cues };
        let sizes: Vec<[f64; 2]> = scales.iter().map(|scale| self.base.map(|axis| axis * scale)).collect();
        let reach = self.params.search_radius * scale * self.base[0].max(self.base[1]);
        if !is_lost {
            let predicted = [center[0] + velocity[0], center[1] + velocity[1]];
            return search.best(predicted, reach.ceil() as i64, &sizes);
        }
        let middle = [self.picture_size.0 as i64 / 2, self.picture_size.1 as i64 / 2];
        search.best(middle, middle[0].max(middle[1]), &sizes[sizes.len() / 2..][..1])
    }

    /// Takes a candidate in and returns its histogram intersection.
    fn accept(
        &mut self,
        bins: &ColorBinImage,
        field: &GradientField,
        candidate: Candidate,
    ) -> Result<f64, TrackingError> {
        let HeadState { center, is_lost, .. } = self.state;
        let spans = RowSpans::ellipse(candidate.semi_axes)?;
        let n_pixels = n_inside(bins, &spans, candidate.center);
        let histogram = SlidingHistogram::new(bins, spans, candidate.center).into_histogram();
        let color = self.model.intersection(&histogram, n_pixels);
        if is_lost && color < self.params.adapt_above_intersection {
            return Ok(color);
        }
        if color < self.params.no_evidence_below_intersection {
            self.state.n_without_evidence += 1;
            self.state.is_lost = self.state.n_without_evidence > self.params.lost_after_n_frames;
            self.state.velocity = [0; 2];
            return Ok(color);
        }
        let moved = [candidate.center[0] - center[0], candidate.center[1] - center[1]];
        self.state = HeadState {
            center: candidate.center,
            velocity: if is_lost { [0; 2] } else { moved },
            scale: candidate.semi_axes[0] / self.base[0],
            n_without_evidence: 0,
            is_lost: false,
        };
        let is_head = match self.ratios {
            Some(_) => candidate.log_ratio() > 0.0,
            None => color >= self.params.adapt_above_intersection,
        };
        let rate = if is_head { self.params.color_adaptation_rate } else { 0.0 };
        self.model.adapt(histogram.counts(), rate);
        if let Some(before) = &self.ratios {
            let place = (candidate.center, candidate.semi_axes);
            self.ratios = Some(CueRatios::measured((bins, field), place, Some((before, rate)))?);
        }
        Ok(color)
    }

    fn target(&self, quality: f64) -> Result<TargetEstimate, TrackingError> {
        let center = self.state.center.map(|c| c as f64 + 0.5);
        let [a, b] = self.base.map(|axis| axis * self.state.scale);
        let point = |i: usize| {
            let angle = TAU * i as f64 / N_OUTLINE as f64;
            [center[0] + a * libm::cos(angle), center[1] + b * libm::sin(angle)]
        };
        Ok(TargetEstimate {
            bounding_box: BoundingBox::from_center(center, 2.0 * a, 2.0 * b)?,
            outline: (0..N_OUTLINE).map(point).collect(),
            status: if self.state.is_lost { TrackStatus::Lost } else { TrackStatus::Tracked },
            quality,
        })
    }
}

impl<S: RelativeHeadSizeSource> Tracker for HeadTracker<S> {
    fn track<R: Rng + ?Sized>(
        &mut self,
        picture: &RgbImage,
        _rng: &mut R,
    ) -> Result<TargetEstimate, TrackingError> {
        check_size("width of a picture", self.picture_size.0, picture.width() as usize)?;
        check_size("height of a picture", self.picture_size.1, picture.height() as usize)?;
        let scales = self.scales(picture)?;
        let bins = ColorBinImage::new(&self.quantizer, picture)?;
        let field = GradientField::new(picture);
        let Some(candidate) = self.found(&bins, &field, &scales)? else { return self.target(0.0) };
        let color = self.accept(&bins, &field, candidate)?;
        self.target(color.clamp(0.0, 1.0))
    }

    fn camera_turned(&mut self, shift: [f64; 2]) {
        let (width, height) = self.picture_size;
        // Beyond one picture's size there is nothing to find.
        for (axis, most) in [width as f64, height as f64].into_iter().enumerate() {
            let moved = self.state.center[axis] as f64 + shift[axis].round();
            if moved.is_finite() {
                self.state.center[axis] = moved.clamp(-most, 2.0 * most) as i64;
            }
        }
    }
}
