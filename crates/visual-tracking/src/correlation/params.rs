use crate::TrackingError;
use crate::error::{checked, probability};

/// Parameters of a [`CorrelationTracker`](super::CorrelationTracker).
///
/// The defaults were chosen on OTB "David" and on synthetic sequences of photographs that move, rotate, grow, deform, and change in light
/// and occlusion. The mean overlap is flat there: halving or doubling one parameter changes it by 0.01 or less in most sequences. The main
/// effect is whether a target is sometimes found again after an occlusion.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CorrelationTrackerParams {
    /// Side of the search window, in sides of a square of the target's area. Default 4.
    pub search_window_scale: f64,
    /// Width of the response that is desired at the target, in sides of the target. Default 1/16.
    pub target_response_width: f64,
    /// Weight of the previous filter in learning, in units of the energy of an image. Default 2.5.
    pub previous_filter_weight: f64,
    /// Weight by which the filter's two domains are brought to agree, in the same units. Default 0.2.
    pub spatial_spectral_agreement_weight: f64,
    /// Share of the colour channels in the energy of a picture, unless the first one is grey. Default 0.2.
    pub color_channel_share: f64,
    /// Share of the grey values, the rest being gradients. Default 0.05.
    pub gray_channel_share: f64,
    /// Weight of the colour histograms relative to the filter in the search. Default 0.3.
    pub color_histogram_weight: f64,
    /// Rate at which the colour histograms follow. Default 0.04.
    pub color_histogram_learning_rate: f64,
    /// Standard deviation of the motion of a target between two images, in sides of the target. Default 2.
    pub motion_sigma: f64,
    /// Scales that are compared, an odd number. Default 17.
    pub n_scale_hypotheses: usize,
    /// Factor between two scales. Default 1.03.
    pub scale_step: f64,
    /// Rate at which the filter over scales follows. Default 0.025.
    pub scale_filter_learning_rate: f64,
    /// Peak-to-sidelobe ratio, in standard deviations of the response, below which there is no evidence of the target. Noise reaches 5 to 9.
    /// Default 10.
    pub no_evidence_below_psr: f64,
    /// Pictures in a row without evidence after which the target is lost. Default 8.
    pub lost_after_n_frames: usize,
    /// Standing out above which a picture is learned. Default 12.
    pub learn_above_psr: f64,
    /// Standing out above which a target is recognized, after an occlusion or a loss. Default 15.
    pub recognize_above_psr: f64,
    /// Minimum share of the typical response for recognition; three fifths of it suffice for a lost target. Default 0.5.
    pub min_recognition_response_share: f64,
    /// Share of the typical colour agreement below which a target must also be recognized by its shape. Default 0.5.
    pub shape_check_color_agreement_share: f64,
    /// Images after which a changed target is accepted, if its old appearance is not found in another place. Default 60.
    pub accept_change_after_n_frames: usize,
    /// Places beside the last one that are searched in each picture while the target is lost. Default 2.
    pub n_search_places: usize,
}

impl Default for CorrelationTrackerParams {
    fn default() -> Self {
        Self {
            search_window_scale: 4.0,
            target_response_width: 0.0625,
            previous_filter_weight: 2.5,
            spatial_spectral_agreement_weight: 0.2,
            color_channel_share: 0.2,
            gray_channel_share: 0.05,
            color_histogram_weight: 0.3,
            color_histogram_learning_rate: 0.04,
            motion_sigma: 2.0,
            n_scale_hypotheses: 17,
            scale_step: 1.03,
            scale_filter_learning_rate: 0.025,
            no_evidence_below_psr: 10.0,
            lost_after_n_frames: 8,
            learn_above_psr: 12.0,
            recognize_above_psr: 15.0,
            min_recognition_response_share: 0.5,
            shape_check_color_agreement_share: 0.5,
            accept_change_after_n_frames: 60,
            n_search_places: 2,
        }
    }
}

impl CorrelationTrackerParams {
    pub(super) fn validate(&self) -> Result<(), TrackingError> {
        let positive = |what, value: f64| checked(what, value, value > 0.0 && value.is_finite(), "positive");
        checked(
            "search_window_scale",
            self.search_window_scale,
            (1.5..=8.0).contains(&self.search_window_scale),
            "between 1.5 and 8",
        )?;
        positive("target_response_width", self.target_response_width)?;
        positive("spatial_spectral_agreement_weight", self.spatial_spectral_agreement_weight)?;
        positive("motion_sigma", self.motion_sigma)?;
        checked(
            "previous_filter_weight",
            self.previous_filter_weight,
            self.previous_filter_weight >= 0.0 && self.previous_filter_weight.is_finite(),
            "not negative",
        )?;
        let share = self.color_channel_share + self.gray_channel_share;
        checked("colour and grey share", share, (0.0..1.0).contains(&share), "below 1")?;
        for (what, value) in [
            ("color_channel_share", self.color_channel_share),
            ("gray_channel_share", self.gray_channel_share),
            ("color_histogram_weight", self.color_histogram_weight),
            ("color_histogram_learning_rate", self.color_histogram_learning_rate),
            ("scale_filter_learning_rate", self.scale_filter_learning_rate),
            ("min_recognition_response_share", self.min_recognition_response_share),
            ("shape_check_color_agreement_share", self.shape_check_color_agreement_share),
        ] {
            probability(what, value)?;
        }
        let odd = self.n_scale_hypotheses % 2 == 1 && self.n_scale_hypotheses <= 99;
        checked("n_scale_hypotheses", self.n_scale_hypotheses as f64, odd, "odd, at most 99")?;
        let step = (1.001..=1.5).contains(&self.scale_step);
        checked("scale_step", self.scale_step, step, "between 1.001 and 1.5")?;
        for (what, value) in [
            ("no_evidence_below_psr", self.no_evidence_below_psr),
            ("learn_above_psr", self.learn_above_psr),
            ("recognize_above_psr", self.recognize_above_psr),
        ] {
            checked(what, value, value >= 0.0, "not negative")?;
        }
        let n_search_places = self.n_search_places as f64;
        checked("number of searches", n_search_places, self.n_search_places <= 100, "at most 100")?;
        Ok(())
    }
}
