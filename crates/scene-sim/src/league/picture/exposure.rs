use nalgebra::Vector3;
use wayfix_color_map::PinholeCamera;
use wayfix_estimation_traits::Pose3;

use super::layer::Layer;
use super::scene::LeagueScene;
use super::surface::Material;
use super::view::View;
use crate::league::LinearRgb;
use crate::space;

/// Position of each ray in its pixel (beyond its borders, for a soft lens) and its time in the exposure.
const RAYS: [((f64, f64), f64); 4] =
    [((-0.10, 0.30), 0.125), ((0.70, -0.10), 0.375), ((0.30, 1.10), 0.625), ((1.10, 0.70), 0.875)];

/// Light on the chip, and its sources.
pub(super) struct Exposure {
    layers: [Layer; RAYS.len()],
    camera: PinholeCamera,
    /// Row by row; 1 is a white wall in the everyday light of the venue.
    pub(super) light: Vec<LinearRgb>,
    /// 0, or number of the map colour plus 1 where all rays of a pixel meet that colour.
    pub(super) labels: Vec<u8>,
}

impl Exposure {
    pub(super) fn new(camera: PinholeCamera) -> Self {
        let n_pixels = camera.width() as usize * camera.height() as usize;
        Self {
            layers: std::array::from_fn(|_| Layer::new(n_pixels)),
            camera,
            light: vec![LinearRgb::zeros(); n_pixels],
            labels: vec![0; n_pixels],
        }
    }

    /// Opens the shutter while the camera moves from one pose to the other.
    pub(super) fn take(&mut self, scene: &LeagueScene<'_>, opening: &Pose3<f64>, closing: &Pose3<f64>) {
        let camera = self.camera;
        let views = RAYS.map(|(spot, when)| View::new(&space::between(opening, closing, when), camera, spot));
        for (layer, view) in self.layers.iter_mut().zip(&views) {
            layer.clear();
            for (surface, number) in scene.surfaces.iter().zip(0..Layer::NOTHING) {
                layer.draw(number, &surface.form, view);
            }
        }
        for pixel in 0..self.light.len() {
            let met = self.layers.each_ref().map(|layer| layer.surface[pixel]);
            self.light[pixel] = self.radiance(pixel, met, scene, &views);
            self.labels[pixel] = label(met, scene);
        }
    }

    /// The mean over the rays of a pixel; rays that meet the same surface share the shading of the first of them.
    fn radiance(
        &self,
        pixel: usize,
        met: [u16; RAYS.len()],
        scene: &LeagueScene<'_>,
        views: &[View; RAYS.len()],
    ) -> LinearRgb {
        let mut sum = LinearRgb::zeros();
        for (ray, number) in met.into_iter().enumerate() {
            if met[..ray].contains(&number) {
                continue;
            }
            let share = met[ray..].iter().filter(|&&other| other == number).count() as f64;
            sum += self.shade(pixel, ray, scene, &views[ray]) * share;
        }
        sum / RAYS.len() as f64
    }

    fn shade(&self, pixel: usize, ray: usize, scene: &LeagueScene<'_>, view: &View) -> LinearRgb {
        let width = self.camera.width() as usize;
        let direction = view.ray(pixel % width, pixel / width);
        let layer = &self.layers[ray];
        match scene.surfaces.get(usize::from(layer.surface[pixel])) {
            Some(surface) => {
                let point: Vector3<f64> = view.eye + direction / layer.nearness[pixel];
                scene.radiance(surface, &point, &view.eye)
            }
            None => scene.beyond(&view.eye, &direction),
        }
    }
}

fn label(met: [u16; RAYS.len()], scene: &LeagueScene<'_>) -> u8 {
    let of = |number: u16| match scene.surfaces.get(usize::from(number)).map(|surface| surface.material) {
        Some(Material::Map(color)) => color.0.saturating_add(1),
        _ => 0,
    };
    let first = of(met[0]);
    if met[1..].iter().all(|&number| of(number) == first) { first } else { 0 }
}
