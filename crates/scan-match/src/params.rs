use crate::ScanMatchError;

/// Parameters of the matching; the defaults suit indoor lasers from 1 cm and beams 0.25° to 1° apart.
///
/// ```
/// use wayfix_scan_match::{ScanMatcher, ScanMatchParams};
/// assert!(ScanMatcher::new(ScanMatchParams::default()).is_ok());
/// assert!(ScanMatcher::new(ScanMatchParams { point_sigma_m: 0.0, ..ScanMatchParams::default() }).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ScanMatchParams {
    /// Standard deviation of a point from its surface, m: the laser noise, and the error of straight lines between neighbours. Default: 0.03.
    pub point_sigma_m: f64,
    /// Angle over which the errors of neighbouring points are fully correlated, rad, as on a bulging wall, a coat or an edge. A denser scan then
    /// adds no information. Default: 0.4.
    pub point_error_correlation_angle_rad: f64,
    /// Misfit beyond which a point is rather something else, m: half its weight is lost at 0.64 of it. Default: 0.1.
    pub robust_kernel_width_m: f64,
    /// The initial kernel width, m: the expected error of the guess. Default: 0.5.
    pub initial_robust_kernel_width_m: f64,
    /// Headings from which the search starts are this far apart, rad, over three deviations of the guess to either side. Default: 0.2.
    pub initial_heading_spacing_rad: f64,
    /// Steps of one search at most. Default: 30.
    pub max_iterations: usize,
}

impl Default for ScanMatchParams {
    fn default() -> Self {
        Self {
            point_sigma_m: 0.03,
            point_error_correlation_angle_rad: 0.4,
            robust_kernel_width_m: 0.1,
            initial_robust_kernel_width_m: 0.5,
            initial_heading_spacing_rad: 0.2,
            max_iterations: 30,
        }
    }
}

impl ScanMatchParams {
    /// Whether every number has a meaning.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn check(&self) -> Result<(), ScanMatchError> {
        for (what, value) in [
            ("point_sigma_m", self.point_sigma_m),
            ("point_error_correlation_angle_rad", self.point_error_correlation_angle_rad),
            ("robust_kernel_width_m", self.robust_kernel_width_m),
            ("initial_robust_kernel_width_m", self.initial_robust_kernel_width_m),
            ("initial_heading_spacing_rad", self.initial_heading_spacing_rad),
        ] {
            if !(1e-6..=1e3).contains(&value) {
                return Err(ScanMatchError::Value { what, value, must: "from 1e-6 to 1e3" });
            }
        }
        if self.max_iterations == 0 {
            return Err(ScanMatchError::Value { what: "max_iterations", value: 0.0, must: "at least 1" });
        }
        Ok(())
    }
}
