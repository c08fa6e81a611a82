use nalgebra::Vector2;
use rand::Rng;
use wayfix_estimation_traits::Pose2;

use super::ambient_light::AmbientLight;
use super::camera::OmniCameraParams;
use super::color::Rgb8;
use super::depths::{Depths, PanelHit};
use super::image_pipeline::ImagePipeline;
use super::light::MixedLight;
use super::panel::{Material, Panel};
use super::rooms::building::Building;
use super::rooms::crowd::{HALF_WIDTH_M, HEIGHTS_M};
use crate::scenery::RgbPicture;
use crate::{SimulationError, plane};

/// Looks around in a building.
#[derive(Clone, Debug)]
pub(super) struct ViewRenderer {
    params: OmniCameraParams,
    depths: Depths,
    light: MixedLight,
    image_pipeline: ImagePipeline,
    /// Light on each ring of each column, the highest ring first.
    radiance: Vec<[f32; 3]>,
}

/// Position and clothes of a person.
pub(super) type Standing = (Vector2<f64>, [Rgb8; 3]);

impl ViewRenderer {
    pub(super) fn new(params: OmniCameraParams) -> Result<Self, SimulationError> {
        params.validate()?;
        Ok(Self {
            depths: Depths::new(&params),
            light: MixedLight::default(),
            image_pipeline: ImagePipeline::new(&params),
            radiance: vec![[0.0; 3]; params.n_columns * params.n_rings],
            params,
        })
    }

    /// The view from `pose`.
    pub(super) fn render_view<R: Rng + ?Sized>(
        &mut self,
        building: &Building,
        ambient_light: &AmbientLight,
        people: &[Standing],
        pose: &Pose2<f64>,
        rng: &mut R,
    ) -> RgbPicture {
        building.light.mix(ambient_light, &mut self.light);
        self.depths.clear();
        for (panel, number) in building.panels.iter().zip(0..) {
            self.depths.put(number, panel, pose);
        }
        let n_panels = building.panels.len();
        for (k, (place, _)) in people.iter().enumerate() {
            let panel = upright(*place, &pose.translation, k);
            self.depths.put((n_panels + k) as u32, &panel, pose);
        }
        let shading = Shading { building, ambient_light, people, pose: *pose, eye_m: self.params.height_m };
        self.radiance.fill([0.0; 3]);
        for azimuth in 0..self.depths.n_azimuths() {
            shading.expose(azimuth, &self.depths, &self.light, &self.params, &mut self.radiance);
        }
        let rgb = self.image_pipeline.process(&self.radiance, rng);
        RgbPicture { width: self.params.n_columns, height: self.params.n_rings, rgb }
    }
}

/// A person, facing the viewer.
fn upright(place: Vector2<f64>, eye: &Vector2<f64>, number: usize) -> Panel {
    let sight = (place - eye).normalize();
    let aside = Vector2::new(-sight.y, sight.x) * HALF_WIDTH_M;
    let top_m = HEIGHTS_M[2];
    Panel {
        left: place + aside,
        right: place - aside,
        bottom_m: 0.0,
        top_m,
        material: Material::Person(number),
    }
}

/// Data needed to compute the light at a place.
struct Shading<'a> {
    building: &'a Building,
    ambient_light: &'a AmbientLight,
    people: &'a [Standing],
    pose: Pose2<f64>,
    eye_m: f64,
}

impl Shading<'_> {
    /// Adds the light of all rays of one azimuth to their pixels.
    fn expose(
        &self,
        azimuth: usize,
        depths: &Depths,
        light: &MixedLight,
        params: &OmniCameraParams,
        radiance: &mut [[f32; 3]],
    ) {
        let [across, down] = params.rays_per_pixel;
        let ahead = plane::direction(self.pose.heading());
        let ray = depths.ray(azimuth);
        let ray = ahead * ray.x + Vector2::new(-ahead.y, ahead.x) * ray.y;
        let share = 1.0 / (across * down) as f32;
        let mut last = (PanelHit::NOTHING, [0.0; 3]);
        for (elevation, (met, slope)) in depths.column(azimuth).iter().zip(&depths.slopes).enumerate() {
            let arriving = if met.panel == PanelHit::NOTHING {
                self.flat(&ray, *slope, light)
            } else {
                if last.0 != met.panel {
                    last = (met.panel, light.at(self.pose.translation + ray * met.distance));
                }
                self.upright(met, *slope, depths.steps[1], last.1)
            };
            let ring = params.n_rings - 1 - elevation / down;
            // From left to right, the front in the middle.
            let column = (3 * params.n_columns / 2 - 1 - azimuth / across) % params.n_columns;
            let pixel = &mut radiance[ring * params.n_columns + column];
            for k in 0..3 {
                pixel[k] += share * arriving[k];
            }
        }
    }

    /// From the floor or the ceiling.
    fn flat(&self, ray: &Vector2<f64>, slope: f64, light: &MixedLight) -> [f32; 3] {
        let (rise, color) = if slope < 0.0 {
            (-self.eye_m, self.building.floor)
        } else {
            (self.building.ceiling_m - self.eye_m, self.building.ceiling)
        };
        let arriving = light.at(self.pose.translation + ray * (rise / slope));
        lit(color.map(f32::from), arriving)
    }

    fn upright(&self, met: &PanelHit, slope: f64, down: f64, arriving: [f32; 3]) -> [f32; 3] {
        let height = self.eye_m + met.distance * slope;
        let panels = &self.building.panels;
        let Some(panel) = panels.get(met.panel as usize) else {
            let (_, clothes) = &self.people[met.panel as usize - panels.len()];
            let part = HEIGHTS_M.iter().take(2).filter(|top| height >= **top).count();
            return lit(clothes[part].map(f32::from), arriving);
        };
        let up = height - panel.bottom_m;
        let size = [met.spread, met.distance * down];
        let look = |texture: usize| self.building.textures[texture].sample(met.along, up, size);
        match panel.material {
            Material::Lit(texture) => lit(look(texture), arriving),
            Material::Window { outside, curtain, number } => {
                let length = (panel.right - panel.left).norm();
                if met.along < length * (1.0 - self.ambient_light.curtains[number]) {
                    lit(look(curtain), arriving)
                } else {
                    lit(look(outside), [2.0 * self.ambient_light.daylight as f32; 3])
                }
            }
            Material::Person(_) => [0.0; 3],
        }
    }
}

/// Of a surface in [0, 255] under light.
fn lit(color: [f32; 3], light: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|k| color[k] * light[k] * (1.0 / 255.0))
}
