use nalgebra::{DMatrix, DVector};

use super::LightingTracker;
use crate::{
    ColorDensity, ColorMeans, ColorModelError, LightingFilter, LightingFilterBank, LightingFilterParams,
};

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
    fn joint_belief(&self, _light: usize) -> Option<(&DVector<f64>, &DMatrix<f64>)> {
        Some((self.mean(), self.covariance()))
    }
    fn noise(&self) -> LightingFilterParams {
        *self.params()
    }
}

/// One Gaussian for each light; only the active one learns.
impl LightingTracker for LightingFilterBank {
    fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        LightingFilterBank::predict(self, seconds)
    }
    fn update(&mut self, means: &ColorMeans) -> Result<(), ColorModelError> {
        self.update_member(self.active(), means).map(|_| ())
    }
    fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError> {
        self.colors_in(self.active())
    }
    fn n_lights(&self) -> usize {
        self.n_members()
    }
    fn light_probability(&self, light: usize) -> f64 {
        self.switch_probability(light)
    }
    fn colors_in(&self, light: usize) -> Result<Vec<ColorDensity>, ColorModelError> {
        let filter = self.members().get(light);
        let missing = ColorModelError::OutOfRange { what: "number of a light", value: light as f64 };
        Ok(filter.ok_or(missing)?.colors().collect())
    }
    fn joint_belief(&self, light: usize) -> Option<(&DVector<f64>, &DMatrix<f64>)> {
        let filter = self.members().get(light)?;
        Some((filter.mean(), filter.covariance()))
    }
    fn update_in(&mut self, light: usize, means: &ColorMeans) -> Result<(), ColorModelError> {
        self.update_member(light, means).map(|_| ())
    }
    fn noise(&self) -> LightingFilterParams {
        *self.member(0).params()
    }
}
