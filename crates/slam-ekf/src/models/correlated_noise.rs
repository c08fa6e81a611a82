use nalgebra::{Matrix2, Vector2};

use super::RangeBearing;

/// What the sightings of one look err each by itself, and what they all err together.
///
/// $`z_i = h_i ⊞ (v_i + c)`$: a turning robot, a late stamp or a tilted camera shifts all of a look alike, so that two neighbours can be told
/// apart long before either of them is placed. Correction inflates its noise for errors that hang together in time; association must not, or neighbours melt into one.
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
    /// Standard deviation of what a range errs by itself at distance zero, m.
    pub independent_range_sigma: f64,
    /// What it grows by, per metre.
    pub independent_range_sigma_per_meter: f64,
    /// Standard deviation of what a bearing errs by itself, rad.
    pub independent_bearing_sigma: f64,
    /// Standard deviation of what all ranges of a look err together, per metre: an error of their scale.
    pub common_range_sigma_per_meter: f64,
    /// Standard deviation of what all bearings of a look err together, rad.
    pub common_bearing_sigma: f64,
}

impl Default for CorrelatedNoise {
    /// 5 cm and 0.01 rad, and nothing in common.
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
    /// Covariance of one measurement: its own errors and the common ones.
    pub(super) fn noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        let range_sigma =
            self.independent_range_sigma + self.independent_range_sigma_per_meter * measurement.range;
        let own = Vector2::new(range_sigma.powi(2), self.independent_bearing_sigma.powi(2));
        Matrix2::from_diagonal(&own) + self.common_noise(measurement, measurement)
    }

    /// Covariance of what two measurements of one look err together.
    pub(super) fn common_noise(&self, a: &RangeBearing, b: &RangeBearing) -> Matrix2<f64> {
        let range_variance = self.common_range_sigma_per_meter.powi(2) * a.range * b.range;
        Matrix2::from_diagonal(&Vector2::new(range_variance, self.common_bearing_sigma.powi(2)))
    }
}
