use nalgebra::{Matrix2, Vector2};

/// What the receiver makes of a distance: $`e^{λ} d + β`$.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Calibration {
    /// $`β`$, m.
    pub bias: f64,
    /// $`λ`$, the logarithm of the scale.
    pub log_scale: f64,
}

impl Calibration {
    /// The range that is measured at a distance, without noise.
    pub(crate) fn range_of(&self, distance: f64) -> f64 {
        self.log_scale.exp() * distance + self.bias
    }
    /// The distance at which a range is measured.
    pub(crate) fn distance_of(&self, range: f64) -> f64 {
        (range - self.bias) / self.log_scale.exp()
    }
}

impl From<Vector2<f64>> for Calibration {
    fn from(vector: Vector2<f64>) -> Self {
        Self { bias: vector.x, log_scale: vector.y }
    }
}

/// What is known of bias and scale beforehand: 0 and 1, with these standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationPrior {
    /// Of the bias, m. Default 10: wide against every bias that a radio of this kind has.
    pub bias_sigma: f64,
    /// Of the logarithm of the scale. Default 0.1: radio ranging errs by a few percent.
    pub log_scale_sigma: f64,
}

impl Default for CalibrationPrior {
    fn default() -> Self {
        Self { bias_sigma: 10.0, log_scale_sigma: 0.1 }
    }
}

impl CalibrationPrior {
    pub(super) fn information(&self) -> Matrix2<f64> {
        Matrix2::from_diagonal(&Vector2::new(self.bias_sigma.powi(-2), self.log_scale_sigma.powi(-2)))
    }
}
