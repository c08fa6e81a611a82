use super::LightingTracker;
use crate::{ColorDensity, ColorMeans, ColorModelError, LightingFilter};

/// One Gaussian for whatever the light does.
impl LightingTracker for LightingFilter {
    fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        LightingFilter::predict(self, seconds)
    }
    fn update(&mut self, means: &ColorMeans) -> Result<(), ColorModelError> {
        LightingFilter::update(self, means).map(|_| ())
    }
    fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError> {
        Ok(LightingFilter::colors(self).collect())
    }
}
