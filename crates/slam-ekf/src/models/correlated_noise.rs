use nalgebra::{Matrix2, Vector2};

use super::RangeBearing;

/// Independent and shared noise of the detections in one scan.
///
/// $`z_i = h_i ⊞ (v_i + c)`$: a turning robot, a late stamp or a tilted camera shifts all detections of a scan equally, so neighbours can be
/// distinguished before their positions are certain. The correction inflates its noise for time-correlated errors; association must not, or it
/// merges neighbours.
///
/// ```
/// use wayfix_slam_ekf::{LandmarkModel, CorrelatedNoise, RangeBearing, RangeBearingSensor};
/// let correlated_noise = Some(CorrelatedNoise { independent_bearing_sigma: 0.006, common_bearing_sigma: 0.008, ..CorrelatedNoise::default() });
/// let sensor = RangeBearingSensor { bearing_sigma: 0.035, correlated_noise, ..RangeBearingSensor::default() };
/// let seen = RangeBearing::new(3.0, 0.1);
/// assert!((sensor.association_noise(&seen).m22.sqrt() - 0.01).abs() < 1e-12); // 3-4-5
/// assert!((sensor.common_noise(&seen, &seen).m22.sqrt() - 0.008).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CorrelatedNoise {
    /// Standard deviation of the independent range error at distance zero, m.
    pub independent_range_sigma: f64,
    /// Its increase per m.
    pub independent_range_sigma_per_meter: f64,
    /// Standard deviation of the independent bearing error, rad.
    pub independent_bearing_sigma: f64,
    /// Standard deviation of the shared range error of a scan, per m: a scale error.
    pub common_range_sigma_per_meter: f64,
    /// Standard deviation of the shared bearing error of a scan, rad.
    pub common_bearing_sigma: f64,
}

impl Default for CorrelatedNoise {
    /// 5 cm and 0.01 rad, no shared error.
    fn default() -> Self {
        Self {
            independent_range_sigma: 0.05,
            independent_range_sigma_per_meter: 0.0,
            independent_bearing_sigma: 0.01,
            common_range_sigma_per_meter: 0.0,
            common_bearing_sigma: 0.0,
        }
    }
}

impl CorrelatedNoise {
    /// Covariance of one measurement: independent and shared errors.
    pub(super) fn noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        let range_sigma =
            self.independent_range_sigma + self.independent_range_sigma_per_meter * measurement.range;
        let own = Vector2::new(range_sigma.powi(2), self.independent_bearing_sigma.powi(2));
        Matrix2::from_diagonal(&own) + self.common_noise(measurement, measurement)
    }

    /// Cross-covariance of two measurements in one scan.
    pub(super) fn common_noise(&self, a: &RangeBearing, b: &RangeBearing) -> Matrix2<f64> {
        let range_variance = self.common_range_sigma_per_meter.powi(2) * a.range * b.range;
        Matrix2::from_diagonal(&Vector2::new(range_variance, self.common_bearing_sigma.powi(2)))
    }
}
