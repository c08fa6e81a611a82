use std::f64::consts::FRAC_PI_2;

use super::RangeBearingNoise;
use crate::LineExtractionError;

/// Parameters of the wall extraction; the defaults suit a SICK LMS (σ about 1 cm, beams 0.25° to 1° apart) indoors.
///
/// ```
/// use wayfix_line_extract::{LineExtractionParams, SplitMethod};
///
/// let params = LineExtractionParams { min_length_m: 1.0, split_method: SplitMethod::SplitAndMerge, ..LineExtractionParams::default() };
/// assert!(params.check().is_ok());
/// assert!(LineExtractionParams { split_distance_m: -0.1, ..params }.check().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LineExtractionParams {
    /// Noise of single beams. Default: 1 cm and 0.002 rad.
    pub beam_noise: RangeBearingNoise,
    /// The flattest angle, radians, between a beam and a surface that is still taken as one surface. Default: 10°.
    pub breakpoint_angle_rad: f64,
    /// Number of consecutive missing beams that do not end a surface. Default: 2.
    pub max_missing_beams: usize,
    /// Method of splitting a surface. Default: iterative end point fit.
    pub split_method: SplitMethod,
    /// A piece with a point farther off than this, metres, is split. Default: 0.05, five times the noise.
    pub split_distance_m: f64,
    /// Points at the ends of a piece farther from its line than this number of their standard deviations are dropped. Default: 3.
    pub end_point_gate_sigmas: f64,
    /// Pieces are one wall up to this squared Mahalanobis distance of their lines. Default: 13.8, which 99.9 % of equal lines pass (chi-squared, 2).
    pub merge_gate: f64,
    /// Standard deviation of the bulge of a straight wall, metres. Neighbouring pieces with a common curvature beyond that and the noise
    /// (99.9 % of chi-squared, 1) are chords of an arc and no walls. Default: 0.01, the tolerance of DIN 18202 for a finished wall over 4 m.
    pub bulge_sigma_m: f64,
    /// Maximum gap along the wall between merged pieces, m. Default: 0.3.
    pub merge_gap_m: f64,
    /// Minimum number of points of a wall. Default: 5.
    pub min_points: usize,
    /// Minimum length of a wall, m. Default: 0.3.
    pub min_length_m: f64,
}

/// Method of splitting a surface into straight pieces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum SplitMethod {
    /// By the distance to the line through the end points, as [Andrade-Cetto 2005, Table 1].
    #[default]
    EndPointFit,
    /// By the distance to the line fitted to all points [Pavlidis & Horowitz 1974].
    SplitAndMerge,
}

impl Default for LineExtractionParams {
    fn default() -> Self {
        Self {
            beam_noise: RangeBearingNoise::default(),
            breakpoint_angle_rad: 10_f64.to_radians(),
            max_missing_beams: 2,
            split_method: SplitMethod::default(),
            split_distance_m: 0.05,
            end_point_gate_sigmas: 3.0,
            merge_gate: 13.8,
            bulge_sigma_m: 0.01,
            merge_gap_m: 0.3,
            min_points: 5,
            min_length_m: 0.3,
        }
    }
}

impl LineExtractionParams {
    /// Checks the range of every value; called by [`LineExtractor::new`](crate::LineExtractor::new).
    ///
    /// # Errors
    /// Returns [`LineExtractionError::Param`] with the first value that is out of range.
    pub fn check(&self) -> Result<(), LineExtractionError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let not_negative = |value: f64| value >= 0.0 && value.is_finite();
        let (noise, angle) = (&self.beam_noise, self.breakpoint_angle_rad);
        let checks = [
            ("noise.sigma_range_m", noise.sigma_range_m, positive(noise.sigma_range_m), "positive"),
            (
                "noise.sigma_bearing_rad",
                noise.sigma_bearing_rad,
                not_negative(noise.sigma_bearing_rad),
                "not negative",
            ),
            ("breakpoint_angle_rad", angle, angle > 0.0 && angle < FRAC_PI_2, "in (0, π/2)"),
            ("split_distance_m", self.split_distance_m, positive(self.split_distance_m), "positive"),
            (
                "end_point_gate_sigmas",
                self.end_point_gate_sigmas,
                positive(self.end_point_gate_sigmas),
                "positive",
            ),
            ("merge_gate", self.merge_gate, not_negative(self.merge_gate), "not negative"),
            ("bulge_sigma_m", self.bulge_sigma_m, not_negative(self.bulge_sigma_m), "not negative"),
            ("merge_gap_m", self.merge_gap_m, not_negative(self.merge_gap_m), "not negative"),
            ("min_points", self.min_points as f64, self.min_points >= 3, "at least 3"),
            ("min_length_m", self.min_length_m, not_negative(self.min_length_m), "not negative"),
        ];
        match checks.into_iter().find(|(_, _, good, _)| !good) {
            Some((what, value, _, must)) => Err(LineExtractionError::Param { what, value, must }),
            None => Ok(()),
        }
    }
}
