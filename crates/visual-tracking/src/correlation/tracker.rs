use rand::Rng;

use super::channels::color_ratio::ColorRatio;
use super::channels::patch::Patch;
use super::channels::planes::Spectrum;
use super::filter::Learning;
use super::params::CorrelationTrackerParams;
use super::recognizer::{FilterResponse, Recognizer, WindowSample};
use super::response::Peak;
use super::scale_filter::ScaleFilter;
use super::window::{SIDE, WindowPlace};
use crate::error::check_size;
use crate::{BoundingBox, TargetEstimate, TrackStatus, Tracker};
use crate::{RgbImage, TrackingError};

/// Sides below which a target has no shape, in pixels.
const MIN_SIDE: f64 = 3.0;
/// Maximum size of a target relative to the image; a close object may exceed it.
const MAX_SHARE: f64 = 1.5;
/// Rate at which the typical response adapts.
const TYPICAL_RATE: f64 = 0.05;

/// Tracks an arbitrary target by its shape, its colours and its size, in colour or grey, from its first box alone.
///
/// Each image is sampled in a square window around the last position. Position: the peak of
///
/// ```math
/// (1 − w) \sum_d f_d ⋆ x_d + w \, \overline{p(c)}
/// ```
///
/// where $`x_d`$ are gradient-orientation, grey and colour channels. $`f`$ is a correlation filter that vanishes outside the target and stays near
/// the previous one [Galoogahi et al. 2017; Li et al. 2018]. $`p(c)`$ is the ratio of the colour histograms of target and surroundings [Bertinetto
/// et al. 2016]. Size: a correlation filter over scales [Danelljan et al. 2017].
///
/// Every result with a distinct peak is learned. The last filter that recognized the target with certainty is kept: after an occluder was learned,
/// the kept filter finds the target where it reappears. A result is not learned if the kept filter does not recognize it and its colours
/// differ. The target is [`Lost`](TrackStatus::Lost) if such a result has no distinct peak, or if no result has one for some images. The tracker then
/// searches the whole image, upright and rotated, and requires agreement of shape and colours.
///
/// Memory use is constant and no step is random: the generator of [`Tracker::track`] is not used.
/// ```
/// use rand::SeedableRng;
/// use rand_chacha::ChaCha8Rng;
/// use wayfix_visual_tracking::{
///     BoundingBox, CorrelationTracker, CorrelationTrackerParams, RgbImage, TrackStatus, Tracker,
/// };
/// // a checkered square on a plain ground, 3 pixels further to the right in the second picture
/// let picture = |left: usize| {
///     let value = |u: usize, v: usize| match (u.wrapping_sub(left) < 16, v.wrapping_sub(20) < 16) {
///         (true, true) => if (u - left) / 4 % 2 == v / 4 % 2 { 220 } else { 40 },
///         _ => 120,
///     };
///     RgbImage::from_raw(80, 60, (0..80 * 60).flat_map(|i| [value(i % 80, i / 80); 3]).collect()).expect("3 bytes a pixel")
/// };
/// let first = BoundingBox::from_corner(30.0, 20.0, 16.0, 16.0)?;
/// let mut tracker = CorrelationTracker::new(&picture(30), first, CorrelationTrackerParams::default())?;
/// let target = tracker.track(&picture(33), &mut ChaCha8Rng::seed_from_u64(0))?;
/// assert_eq!(target.status, TrackStatus::Tracked);
/// assert!(target.bounding_box.iou(&BoundingBox::from_corner(33.0, 20.0, 16.0, 16.0)?) > 0.8);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CorrelationTracker {
    pub(super) params: CorrelationTrackerParams,
    pub(super) picture_size: (usize, usize),
    pub(super) recognizer: Recognizer,
    pub(super) colors: ColorRatio,
    pub(super) scales: ScaleFilter,
    pub(super) pose: WindowPlace,
    /// The filter as it was learned last.
    pub(super) current: Spectrum,
    /// The window at the last learning step.
    pub(super) learned: Patch,
    /// The filter at the last certain recognition.
    pub(super) trusted: Spectrum,
    /// Pictures since then.
    pub(super) n_untrusted: usize,
    /// Typical response at the target.
    pub(super) typical_response: f64,
    /// Typical colour agreement at the target.
    pub(super) typical_color_agreement: f64,
    /// Pictures in a row without evidence.
    pub(super) n_without_evidence: usize,
    /// Pictures since the target was lost; 0 while it is not.
    pub(super) n_lost: usize,
    /// Remaining images in which more of a recovered target may become visible.
    pub(super) n_recentering: usize,
}

impl CorrelationTracker {
    /// Starts from the box around the target in the first image; the box is clipped to the image.
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if a parameter is out of range or the target is smaller than 3 pixels, [`TrackingError::OutsidePicture`]
    /// if the box is outside the image, or [`TrackingError::Empty`] if the image is uniform.
    pub fn new(
        picture: &RgbImage,
        target: BoundingBox,
        params: CorrelationTrackerParams,
    ) -> Result<Self, TrackingError> {
        params.validate()?;
        let picture_size = (picture.width() as usize, picture.height() as usize);
        let target = target.clipped(picture_size)?;
        let size = [target.width(), target.height()];
        for (what, side) in [("width of the target", size[0]), ("height of the target", size[1])] {
            if side < MIN_SIDE {
                return Err(TrackingError::Parameter { what, value: side, range: "at least 3 pixels" });
            }
        }
        let recognizer = Recognizer::new(picture, size, &params);
        let pose = WindowPlace { center: target.center(), scale: 1.0 };
        let sample = recognizer.sample_at(picture, pose);
        let learning = Learning { inertia: 0.0, penalty: params.spatial_spectral_agreement_weight as f32 };
        let current = recognizer.filter.learned(None, &sample.spectrum, learning);
        let typical_response = recognizer.evidence(&current, &sample).value;
        if typical_response <= 0.0 {
            return Err(TrackingError::Empty { what: "structure in the first picture" });
        }
        let mut colors = ColorRatio::new();
        colors.learn(&sample.patch, recognizer.window.target_pixels(), 1.0);
        let typical_color_agreement = colors.agreement(&sample.patch, recognizer.window.target_pixels());
        let mut scales = ScaleFilter::new(params.n_scale_hypotheses, params.scale_step, size);
        scales.learn(picture, pose.center, size, 1.0);
        Ok(Self {
            params,
            picture_size,
            recognizer,
            colors,
            scales,
            pose,
            trusted: current.clone(),
            current,
            learned: sample.patch,
            n_untrusted: 0,
            typical_response,
            typical_color_agreement,
            n_without_evidence: 0,
            n_lost: 0,
            n_recentering: 0,
        })
    }

    /// One picture of a target in sight; the quality.
    fn follow(&mut self, picture: &RgbImage) -> f64 {
        let around = self.recognizer.sample_at(picture, self.pose);
        // An unchanged patch has not moved and adds no information. The fraction of a cell by which even its peak is off would accumulate.
        if around.patch == self.learned {
            self.n_without_evidence = 0;
            return self.recognizer.evidence(&self.current, &around).value / self.typical_response;
        }
        let mut pose = self.moved(picture, self.pose, &around);
        let mut sample = self.recognizer.sample_at(picture, pose);
        let mut trust = self.recognizer.evidence(&self.trusted, &sample);
        if !self.recognized(trust)
            && let Some((there, seen, evidence)) = self.recognized_elsewhere(picture, &around)
        {
            (pose, sample, trust) = (there, seen, evidence);
            self.current = self.trusted.clone();
        }
        let evidence = self.recognizer.evidence(&self.current, &sample);
        let is_unlike = !self.recognized(trust) && !self.has_target_colors(&sample);
        // a dissimilar result needs a higher response
        let least =
            if is_unlike { self.params.recognize_above_psr } else { self.params.no_evidence_below_psr };
        if evidence.peak_to_sidelobe < least {
            self.n_without_evidence += 1;
            self.n_lost = usize::from(is_unlike || self.n_without_evidence > self.params.lost_after_n_frames);
        } else {
            self.n_without_evidence = 0;
            self.pose = pose;
            self.learn(picture, &sample, evidence, trust);
            self.recenter(picture);
        }
        evidence.value / self.typical_response
    }

    /// The pose to which the target has moved from `pose`, by shape and colour together.
    fn moved(&self, picture: &RgbImage, pose: WindowPlace, around: &WindowSample) -> WindowPlace {
        let window = &self.recognizer.window;
        let mut response = self.recognizer.response(&self.current, around);
        let score = window.box_means(&self.colors.of(&around.patch));
        let prior = window.shift_prior(self.params.motion_sigma);
        let weight = self.params.color_histogram_weight as f32;
        for ((value, score), prior) in response.iter_mut().zip(&score).zip(&prior) {
            *value = ((1.0 - weight) * *value + weight * score) * prior;
        }
        self.shifted(picture, pose, &response)
    }

    /// The pose at the peak of a response, at the scale that fits there.
    pub(super) fn shifted(&self, picture: &RgbImage, pose: WindowPlace, response: &[f32]) -> WindowPlace {
        let window = &self.recognizer.window;
        let mut pose = window.moved(pose, Peak::of(response, SIDE).shift);
        let (width, height) = (self.picture_size.0 as f64, self.picture_size.1 as f64);
        pose.center = [pose.center[0].clamp(0.0, width), pose.center[1].clamp(0.0, height)];
        let factor = self.scales.factor(picture, pose.center, window.size(pose.scale));
        let [base_width, base_height] = window.size(1.0);
        let smallest = (MIN_SIDE / base_width.min(base_height)).min(1.0);
        let largest = (MAX_SHARE * (width / base_width).min(height / base_height)).max(1.0);
        pose.scale = (pose.scale * factor).clamp(smallest, largest);
        pose
    }

    pub(super) fn recognized(&self, evidence: FilterResponse) -> bool {
        // a lost target has changed more since it was learned, and a lower threshold carries no risk
        let share = self.params.min_recognition_response_share * if self.n_lost > 0 { 0.6 } else { 1.0 };
        evidence.peak_to_sidelobe > self.params.recognize_above_psr
            && evidence.value > share * self.typical_response
    }

    /// Whether the colours in the middle of a sample may be the target's.
    pub(super) fn has_target_colors(&self, sample: &WindowSample) -> bool {
        self.is_typical(self.agreement(sample))
    }

    fn is_typical(&self, agreement: f64) -> bool {
        agreement >= self.params.shape_check_color_agreement_share * self.typical_color_agreement
    }

    fn agreement(&self, sample: &WindowSample) -> f64 {
        self.colors.agreement(&sample.patch, self.recognizer.window.target_pixels())
    }

    fn learn(
        &mut self,
        picture: &RgbImage,
        sample: &WindowSample,
        evidence: FilterResponse,
        trust: FilterResponse,
    ) {
        let recognized = self.recognized(trust);
        self.n_untrusted = if recognized { 0 } else { self.n_untrusted + 1 };
        let agreement = self.agreement(sample);
        let may_be_another = !recognized
            && !self.is_typical(agreement)
            && self.n_untrusted <= self.params.accept_change_after_n_frames;
        if evidence.peak_to_sidelobe < self.params.learn_above_psr || may_be_another {
            return;
        }
        let window = &self.recognizer.window;
        let learning = Learning {
            inertia: self.params.previous_filter_weight as f32,
            penalty: self.params.spatial_spectral_agreement_weight as f32,
        };
        self.current = self.recognizer.filter.learned(Some(&self.current), &sample.spectrum, learning);
        if self.n_recentering == 0 {
            self.colors.learn(
                &sample.patch,
                window.target_pixels(),
                self.params.color_histogram_learning_rate as f32,
            );
        }
        let size = window.size(self.pose.scale);
        self.scales.learn(picture, self.pose.center, size, self.params.scale_filter_learning_rate as f32);
        self.learned.clone_from(&sample.patch);
        if recognized || self.n_untrusted > self.params.accept_change_after_n_frames {
            self.trusted.clone_from(&self.current);
            self.n_untrusted = 0;
            let value = if recognized { trust.value } else { evidence.value };
            self.typical_response += TYPICAL_RATE * (value - self.typical_response);
            self.typical_color_agreement += TYPICAL_RATE * (agreement - self.typical_color_agreement);
        }
    }
}

impl Tracker for CorrelationTracker {
    fn track<R: Rng + ?Sized>(
        &mut self,
        picture: &RgbImage,
        _rng: &mut R,
    ) -> Result<TargetEstimate, TrackingError> {
        check_size("width of a picture", self.picture_size.0, picture.width() as usize)?;
        check_size("height of a picture", self.picture_size.1, picture.height() as usize)?;
        let quality = if self.n_lost > 0 { self.search(picture) } else { self.follow(picture) };
        let [width, height] = self.recognizer.window.size(self.pose.scale);
        Ok(TargetEstimate {
            bounding_box: BoundingBox::from_center(self.pose.center, width, height)?,
            outline: Vec::new(),
            status: if self.n_lost > 0 { TrackStatus::Lost } else { TrackStatus::Tracked },
            quality: quality.clamp(0.0, 1.0),
        })
    }
}
