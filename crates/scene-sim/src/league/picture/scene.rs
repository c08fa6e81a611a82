use nalgebra::Vector3;

use super::surface::{Material, SceneSurface};
use crate::league::{Backdrop, LightField, LinearRgb};

/// Everything there is to see at one moment, and the light it is seen in.
pub struct LeagueScene<'a> {
    /// The surfaces; of those in one plane the later is on top. At most 65 535 are rendered.
    pub surfaces: Vec<SceneSurface>,
    /// Diffuse reflectance of each map colour; colours beyond its end are black.
    pub paints: &'a [LinearRgb],
    /// The light.
    pub light: &'a dyn LightField,
    /// The background.
    pub backdrop: &'a dyn Backdrop,
}

impl LeagueScene<'_> {
    /// Radiance of a surface point towards the eye.
    pub(super) fn radiance(
        &self,
        surface: &SceneSurface,
        point: &Vector3<f64>,
        eye: &Vector3<f64>,
    ) -> LinearRgb {
        let reflectance = match surface.material {
            Material::Map(color) => self.paints.get(usize::from(color.0)).copied().unwrap_or_default(),
            Material::Unmapped(reflectance) => reflectance,
        };
        let normal = surface.form.normal(point, eye);
        reflectance.component_mul(&self.light.irradiance(point, &normal))
    }

    /// Radiance of the background.
    pub(super) fn beyond(&self, eye: &Vector3<f64>, direction: &Vector3<f64>) -> LinearRgb {
        let seen = self.backdrop.surface_hit(eye, direction);
        seen.reflectance.component_mul(&self.light.irradiance(&seen.point, &seen.normal))
    }
}
