use crate::SlamError;

/// Parameters of the filter, the same for every kind of landmark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlamParams {
    /// Probability with which the gate accepts a correct observation: a chi-squared quantile with the measurement's degrees of
    /// freedom. 0.999 (13.8 for range and bearing) loses one good observation in a thousand.
    pub gate_probability: f64,
}

impl Default for SlamParams {
    fn default() -> Self {
        Self { gate_probability: 0.999 }
    }
}

impl SlamParams {
    pub(super) fn validated(self) -> Result<Self, SlamError> {
        let value = self.gate_probability;
        if value > 0.0 && value < 1.0 {
            Ok(self)
        } else {
            Err(SlamError::Parameter { name: "gate_probability", value, range: "between 0 and 1, exclusive" })
        }
    }
}
