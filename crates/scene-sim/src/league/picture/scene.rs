use nalgebra::Vector3;

use super::surface::{Material, Surface};
use crate::league::{Backdrop, LightField, Rgb};

/// Everything there is to see at one moment, and the light it is seen in.
pub struct Scene<'a> {
    /// What stands and lies about; of surfaces in one plane the later is on top. At most 65 535 are seen.
    pub surfaces: Vec<Surface>,
    /// Diffuse reflectance of each map colour; colours beyond its end are black.
    pub paints: &'a [Rgb],
    /// What shines.
    pub light: &'a dyn LightField,
    /// What is behind.
    pub backdrop: &'a dyn Backdrop,
}

impl Scene<'_> {
    /// What a point of a surface sends to the eye.
    pub(super) fn radiance(&self, surface: &Surface, point: &Vector3<f64>, eye: &Vector3<f64>) -> Rgb {
        let reflectance = match surface.material {
            Material::Map(color) => self.paints.get(usize::from(color.0)).copied().unwrap_or_default(),
            Material::Unmapped(reflectance) => reflectance,
        };
        let normal = surface.form.normal(point, eye);
        reflectance.component_mul(&self.light.irradiance(point, &normal))
    }

    /// What comes from behind everything.
    pub(super) fn beyond(&self, eye: &Vector3<f64>, direction: &Vector3<f64>) -> Rgb {
        let seen = self.backdrop.surface_hit(eye, direction);
        seen.reflectance.component_mul(&self.light.irradiance(&seen.point, &seen.normal))
    }
}
