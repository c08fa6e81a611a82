use crate::error::{checked, probability};
use crate::{ColorSpace, ColorStateVector, SnakeParams, TrackingError};

/// Cues that a [`ColorContourTracker`](crate::ColorContourTracker) uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum TrackingCues {
    /// Colours that the contour validates: the method.
    #[default]
    ColorAndShape,
    /// Colours only: the target is the blob.
    Color,
    /// The contour only: a snake on the edges of the picture.
    Shape,
}

/// Parameters of a [`ColorContourTracker`](crate::ColorContourTracker). The defaults are for images of about 320 × 240 pixels at 10 to 60 Hz and are not
/// tuned to any one recording.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ColorContourTrackerParams {
    /// Which cues are used. Default both.
    pub cues: TrackingCues,
    /// Whether the colours adapt; otherwise they stay fixed at the start values. Default true.
    pub adapts_colors: bool,
    /// Space of the colours. Default [`ColorSpace::Opponent`].
    pub color_space: ColorSpace,
    /// Bins of its axes. Default 32 each.
    pub color_bins: [usize; 3],
    /// Hypotheses about the colours a picture. Default 100.
    pub n_samples: usize,
    /// Share of the samples that start from the colours found in the last picture and not from the samples of before; 0 is plain
    /// CONDENSATION. Default 0.5.
    pub share_from_last_measurement: f64,
    /// Share of the velocity that the colour state keeps, from 0 to 1. Default 0.5.
    pub velocity_retention: f64,
    /// Noise of the colour state per picture: centroid (3), axis deviations (3), in units of the colour space, and angles (2) in radians.
    /// Default 0.015 each, 0.006 each, 0.05 each.
    pub color_state_noise: [f64; 8],
    /// A bin is the target's if it is this many times as frequent among the predicted colours as around the target; 0 takes every bin with
    /// a colour in it, as the paper does. Default 1.
    pub min_target_to_background_ratio: f64,
    /// Weight of the previous colours in the set of colours, adapted to the change of light, so that a part of the target missed by one
    /// contour is kept. 0 drops them, as in the paper. Default 0.8.
    pub previous_colors_weight: f64,
    /// Most points in a colour set. Default 512.
    pub max_color_points: usize,
    /// $`μ_1, μ_2, μ_3`$: weights of the affine similarity, the area and the Euler number. Default 1, 1, 0.5.
    pub agreement_weights: [f64; 3],
    /// $`σ`$ of the weights. Default 0.15.
    pub agreement_sigma: f64,
    /// $`μ`$ of the predicted area: share of its last change that is extrapolated. Default 0.5.
    pub extrapolated_area_change_share: f64,
    /// Weight of the mean area of the last seconds in the predicted area, against gradual shrinking or growing of the contour; 0 as in the
    /// paper. Default 0.3.
    pub mean_area_weight: f64,
    /// An Euler number this far from 1 makes a segmentation worthless. Default 10.
    pub max_euler_number_deviation: f64,
    /// Radius of closing and opening in pixels; 0 leaves the segmentation as it is. Default 1.
    pub morphology_radius: usize,
    /// Parameters of the snake fit.
    pub snake: SnakeParams,
    /// Distance from the segmented boundary within which the final contour searches for an image edge, in pixels; 0 disables it. Default 2.
    pub edge_search_distance: usize,
    /// The change of colour over two pixels that is an edge, in grey values (root of the sum of squares over the channels). Default 20.
    pub min_edge_contrast: f64,
    /// Below this quality the target is lost. Default 0.5.
    pub lost_below_quality: f64,
    /// From this quality on, times the likeness of the colours, it is found again. Default 0.75.
    pub found_above_quality: f64,
    /// Number of colour hypotheses for a search in the whole image, in addition to those of the light intensity. Default 12.
    pub n_search_color_hypotheses: usize,
}

impl Default for ColorContourTrackerParams {
    fn default() -> Self {
        Self {
            cues: TrackingCues::default(),
            adapts_colors: true,
            color_space: ColorSpace::Opponent,
            color_bins: [32; 3],
            n_samples: 100,
            share_from_last_measurement: 0.5,
            velocity_retention: 0.5,
            color_state_noise: [0.015, 0.015, 0.015, 0.006, 0.006, 0.006, 0.05, 0.05],
            min_target_to_background_ratio: 1.0,
            previous_colors_weight: 0.8,
            max_color_points: 512,
            agreement_weights: [1.0, 1.0, 0.5],
            agreement_sigma: 0.15,
            extrapolated_area_change_share: 0.5,
            mean_area_weight: 0.3,
            max_euler_number_deviation: 10.0,
            morphology_radius: 1,
            snake: SnakeParams::default(),
            edge_search_distance: 2,
            min_edge_contrast: 20.0,
            lost_below_quality: 0.5,
            found_above_quality: 0.75,
            n_search_color_hypotheses: 12,
        }
    }
}

impl ColorContourTrackerParams {
    /// The published method: no background model, no memory of colours and areas, and samples drawn from samples only, in bins as
    /// large as the dynamics and a hundred samples can fill.
    pub fn as_published() -> Self {
        Self {
            min_target_to_background_ratio: 0.0,
            previous_colors_weight: 0.0,
            extrapolated_area_change_share: 1.0,
            mean_area_weight: 0.0,
            share_from_last_measurement: 0.0,
            color_bins: [16; 3],
            ..Self::default()
        }
    }

    /// # Errors
    /// Returns [`TrackingError::Parameter`] with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), TrackingError> {
        let count = |what, n: usize, most: usize| {
            checked(what, n as f64, (1..=most).contains(&n), "at least 1, and not excessive")
        };
        count("n_samples", self.n_samples, 1_000_000)?;
        count("max_color_points", self.max_color_points, 1_000_000)?;
        count("n_search_color_hypotheses", self.n_search_color_hypotheses, 1_000_000)?;
        for (what, value) in [
            ("share_from_last_measurement", self.share_from_last_measurement),
            ("previous_colors_weight", self.previous_colors_weight),
            ("mean_area_weight", self.mean_area_weight),
            ("lost_below_quality", self.lost_below_quality),
            ("found_above_quality", self.found_above_quality),
        ] {
            probability(what, value)?;
        }
        for (what, value) in [
            ("min_target_to_background_ratio", self.min_target_to_background_ratio),
            ("min_edge_contrast", self.min_edge_contrast),
            ("extrapolated_area_change_share", self.extrapolated_area_change_share),
        ] {
            checked(what, value, value.is_finite() && value >= 0.0, "finite, not negative")?;
        }
        for (what, value) in [
            ("agreement_sigma", self.agreement_sigma),
            ("max_euler_number_deviation", self.max_euler_number_deviation),
            ("sum of mu", self.agreement_weights.iter().sum()),
        ] {
            checked(what, value, value.is_finite() && value > 0.0, "finite, positive")?;
        }
        for value in self.agreement_weights {
            checked("mu", value, value >= 0.0, "not negative")?;
        }
        for (what, radius) in [
            ("morphology_radius", self.morphology_radius),
            ("edge_search_distance", self.edge_search_distance),
        ] {
            checked(what, radius as f64, radius <= 100, "at most 100")?;
        }
        self.snake.validate()
    }

    pub(super) fn noise(&self) -> ColorStateVector {
        ColorStateVector::from(self.color_state_noise)
    }
}
