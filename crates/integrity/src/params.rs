use crate::error::{IntegrityError, check};

/// Parameters of [`ShiryaevRobertsTest`](crate::ShiryaevRobertsTest) and [`RelocalizationTest`](crate::RelocalizationTest).
///
/// ```
/// use wayfix_integrity::RelocalizationParams;
/// let params = RelocalizationParams { false_alarms_per_km: 0.01, kidnappings_per_km: 1.0, ..Default::default() };
/// assert_eq!(params.threshold(), 1e5); // m
/// assert!((params.probability(params.threshold()) - 100.0 / 101.0).abs() < 1e-12); // at an alarm
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct RelocalizationParams {
    /// Largest mean number of false alarms per km of driving; 0 switches relocalization off, but for an unknown start. Default 0.01: a robot that drives 10 km a day has one in ten days.
    pub false_alarms_per_km: f64,
    /// Prior mean number of kidnappings of the robot, per km of driving; above `false_alarms_per_km`. A search of a standing robot counts as 1 m. Default 1.
    pub kidnappings_per_km: f64,
    /// Distance for which a replaced hypothesis remains an alternative, m. Default 20.
    pub alternative_kept_distance: f64,
}

impl Default for RelocalizationParams {
    fn default() -> Self {
        Self { false_alarms_per_km: 0.01, kidnappings_per_km: 1.0, alternative_kept_distance: 20.0 }
    }
}

const METERS_PER_KM: f64 = 1000.0;

impl RelocalizationParams {
    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns an error that names the first number outside its range.
    pub fn validate(&self) -> Result<(), IntegrityError> {
        let Self { false_alarms_per_km, kidnappings_per_km, alternative_kept_distance } = *self;
        let positive = |value: f64| value > 0.0 && value.is_finite();
        check(
            "false_alarms_per_km",
            false_alarms_per_km,
            false_alarms_per_km == 0.0 || positive(false_alarms_per_km),
            "finite and not negative",
        )?;
        let is_above = positive(kidnappings_per_km) && kidnappings_per_km > false_alarms_per_km;
        check("kidnappings_per_km", kidnappings_per_km, is_above, "finite and above false_alarms_per_km")?;
        check(
            "alternative_kept_distance (m)",
            alternative_kept_distance,
            alternative_kept_distance >= 0.0,
            "0 or more",
        )
    }

    /// No relocalization: no search replaces the present hypothesis. An unknown start is still decided.
    pub fn off() -> Self {
        Self { false_alarms_per_km: 0.0, ..Self::default() }
    }

    /// Whether relocalization is off.
    pub fn is_off(&self) -> bool {
        self.false_alarms_per_km == 0.0
    }

    /// The statistic at which a change is decided: the mean distance between false alarms, m.
    pub fn threshold(&self) -> f64 {
        METERS_PER_KM / self.false_alarms_per_km
    }

    /// The probability of a change at a value of the statistic.
    pub fn probability(&self, statistic: f64) -> f64 {
        let odds = self.prior() * statistic;
        if odds.is_infinite() { 1.0 } else { odds / (1.0 + odds) }
    }

    /// Prior probability of being moved, per m.
    pub fn prior(&self) -> f64 {
        self.kidnappings_per_km / METERS_PER_KM
    }
}
