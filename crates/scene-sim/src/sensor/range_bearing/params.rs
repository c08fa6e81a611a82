use std::f64::consts::TAU;

use super::{Clutter, CorrelatedErrorParams};
use crate::random::NoiseShape;
use crate::{SimulationError, check};

/// Parameters of a range-bearing sensor. The default has the Gaussian noise of the shared range-bearing logs and no other errors.
///
/// ```
/// use wayfix_scene_sim::sensor::RangeBearingParams;
/// let params = RangeBearingParams { outlier_share: 0.02, range_bias_m: f64::NAN, ..Default::default() };
/// assert!(params.validate().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeBearingParams {
    /// Scan period, milliseconds. Default 500.
    pub period_ms: u32,
    /// Nearest range, metres. Default 0.1.
    pub min_range_m: f64,
    /// Farthest range, metres. Default 8.
    pub max_range_m: f64,
    /// Whole opening angle, symmetric about straight ahead, radians. Default 2π.
    pub field_of_view_rad: f64,
    /// Standard deviation of the white range error. Default 0.05 m, not growing.
    pub range_noise: RangeDependentSigma,
    /// Standard deviation of the white bearing error, radians. Default 0.01.
    pub bearing_sigma_rad: f64,
    /// Shape of the white errors. Default Gaussian.
    pub noise_shape: NoiseShape,
    /// Added to every range, metres. Default 0.
    pub range_bias_m: f64,
    /// Scale factor of true ranges. Default 1.
    pub range_scale: f64,
    /// Added to every bearing, radians. Default 0.
    pub bearing_bias_rad: f64,
    /// Errors that are correlated in time. Default none.
    pub drift: CorrelatedErrorParams,
    /// Delay of the stamp, milliseconds. Default 0.
    pub stamp_delay_ms: u32,
    /// Share of detections that are gross outliers. Default 0.
    pub outlier_share: f64,
    /// Share of scans missing from the log. (A scan without detections is logged, empty.) Default 0.
    pub scan_dropout_share: f64,
    /// Share of targets in view that are not reported. Default 0.
    pub missed_target_share: f64,
    /// Reports of things that are not there. Default none.
    pub clutter: Clutter,
    /// Share of landmark detections with another landmark's identity. Default 0.
    pub mislabelled_share: f64,
    /// Whether the sensor reads identities. Default true.
    pub labelled: bool,
}

/// A standard deviation that grows with range.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct RangeDependentSigma {
    /// At range 0, metres.
    pub constant_m: f64,
    /// Growth, metres per metre.
    pub per_meter: f64,
}

impl RangeDependentSigma {
    /// The standard deviation at `range` metres.
    pub fn at(&self, range: f64) -> f64 {
        self.constant_m + self.per_meter * range
    }

    pub(in crate::sensor) fn validate(&self) -> Result<(), SimulationError> {
        check::not_negative("σ of range (m)", self.constant_m)?;
        check::not_negative("growth of σ with range", self.per_meter)
    }
}

impl Default for RangeBearingParams {
    fn default() -> Self {
        Self {
            period_ms: 500,
            min_range_m: 0.1,
            max_range_m: 8.0,
            field_of_view_rad: TAU,
            range_noise: RangeDependentSigma { constant_m: 0.05, per_meter: 0.0 },
            bearing_sigma_rad: 0.01,
            noise_shape: NoiseShape::Gaussian,
            range_bias_m: 0.0,
            range_scale: 1.0,
            bearing_bias_rad: 0.0,
            drift: CorrelatedErrorParams::default(),
            stamp_delay_ms: 0,
            outlier_share: 0.0,
            scan_dropout_share: 0.0,
            missed_target_share: 0.0,
            clutter: Clutter::default(),
            mislabelled_share: 0.0,
            labelled: true,
        }
    }
}

impl RangeBearingParams {
    /// Whether the numbers make a sensor.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::period("period of the scans (ms)", self.period_ms)?;
        check::not_negative("nearest range (m)", self.min_range_m)?;
        check::above(
            "farthest range (m)",
            self.max_range_m,
            self.min_range_m,
            "finite and above the nearest",
        )?;
        check::positive("field of view (rad)", self.field_of_view_rad)?;
        self.range_noise.validate()?;
        check::not_negative("σ of bearing (rad)", self.bearing_sigma_rad)?;
        self.noise_shape.validate()?;
        check::finite("range bias (m)", self.range_bias_m)?;
        check::positive("range scale", self.range_scale)?;
        check::finite("bearing bias (rad)", self.bearing_bias_rad)?;
        self.drift.validate()?;
        check::share("share of outliers", self.outlier_share)?;
        check::share("share of dropped scans", self.scan_dropout_share)?;
        check::share("share of missed detections", self.missed_target_share)?;
        self.clutter.validate()?;
        check::share("share of mislabelled detections", self.mislabelled_share)
    }

    /// Half the opening angle, at most π.
    pub(super) fn half_view(&self) -> f64 {
        (0.5 * self.field_of_view_rad).min(std::f64::consts::PI)
    }
}
