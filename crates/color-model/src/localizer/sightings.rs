use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_color_map::{Camera, ColorId, ColorMap, Shape};
use wayfix_estimation_traits::Pose2;

use super::{light::Light, shots::Shot, start::Area};
use crate::{Blob, ColorModelError, YuvImage, find_blobs, likelihood::feature_colors};

/// What frames show of things that stand on the field, and from where those could be seen like that: poses that are worth a look, "sensor
/// resetting" [Lenser & Veloso 2000].
///
/// A blob of a colour that only standing things have is taken for any of them; its direction leaves two unknowns of a pose, and if the
/// thing is a post, its size leaves one and a little.
pub(crate) struct Sightings {
    marks: Vec<Mark>,
    /// By colour.
    blobs: Vec<Vec<Sighting>>,
}

/// A standing thing of one colour.
struct Mark {
    color: ColorId,
    place: Vector2<f64>,
    /// What it shows to every side, square metres; `None` when that depends on the side.
    area: Option<f64>,
}

/// A blob.
struct Sighting {
    /// Index of its frame.
    shot: usize,
    /// Direction in the robot's frame, radians.
    azimuth: f64,
    /// Solid angle, steradians.
    extent: f64,
    /// Where the camera is in the robot's frame.
    camera: Vector2<f64>,
}

/// Fewest pixels of a blob.
const MIN_PIXELS: usize = 6;
/// Standard deviation of the logarithm of a distance that a blob's size tells: half-hidden blobs look farther away.
const LOG_DISTANCE: f64 = 0.2;

impl Sightings {
    /// What `images`, with the index of their shot, show under `light`.
    pub(crate) fn of<'a>(
        images: impl Iterator<Item = (usize, &'a YuvImage)>,
        shots: &[Shot],
        camera: &Camera,
        map: &ColorMap,
        light: &Light,
        nats: impl Fn([u8; 3]) -> f64,
    ) -> Result<Self, ColorModelError> {
        let marks = marks(map);
        let mut blobs: Vec<Vec<Sighting>> = map.colors().iter().map(|_| Vec::new()).collect();
        for (shot, image) in images {
            for member in 0..light.bank.n_members() {
                let label = |pixel: &[u8; 3]| light.label(member, *pixel, -nats(*pixel));
                let labels: Vec<u8> = image.pixels().iter().map(label).collect();
                for blob in find_blobs(&labels, image.width() as usize)? {
                    let is_mark = marks.iter().any(|mark| mark.color == blob.color);
                    if is_mark && blob.n_pixels >= MIN_PIXELS {
                        blobs[blob.color.index()].push(sighting(&blob, shot, &shots[shot], camera));
                    }
                }
            }
        }
        Ok(Self { marks, blobs })
    }

    /// A pose from which one of the things is seen where a blob is, and the index of that blob's frame. `None` when none of it was seen.
    pub(crate) fn draw<R: Rng + ?Sized>(&self, area: &Area, rng: &mut R) -> Option<(usize, Pose2<f64>)> {
        let mark = self.marks.get(rng.random_range(0..self.marks.len().max(1)))?;
        let blobs = &self.blobs[mark.color.index()];
        let sighting = blobs.get(rng.random_range(0..blobs.len().max(1)))?;
        let camera = match mark.area {
            Some(area) => {
                let distance = (area / sighting.extent).sqrt()
                    * (LOG_DISTANCE * rng.sample::<f64, _>(StandardNormal)).exp();
                let (sin, cos) = (TAU * rng.random::<f64>()).sin_cos();
                mark.place - Vector2::new(cos, sin) * distance
            }
            None => area.sample(rng).translation,
        };
        let to_mark = mark.place - camera;
        let heading = to_mark.y.atan2(to_mark.x) - sighting.azimuth;
        let (sin, cos) = heading.sin_cos();
        let (x, y) = (sighting.camera.x, sighting.camera.y);
        let body = camera - Vector2::new(cos * x - sin * y, sin * x + cos * y);
        let pose = Pose2::new(body.x, body.y, heading);
        area.contains(&pose).then_some((sighting.shot, pose))
    }
}

fn sighting(blob: &Blob, at: usize, shot: &Shot, camera: &Camera) -> Sighting {
    let ray: Vector3<f64> = shot.mount.rotation * camera.ray(blob.centroid.0, blob.centroid.1);
    Sighting {
        shot: at,
        azimuth: ray.y.atan2(ray.x),
        extent: blob.n_pixels as f64 / (camera.fx() * camera.fy()),
        camera: shot.mount.translation.xy(),
    }
}

/// Bands of posts, and upright polygons of colours that nothing flat has.
fn marks(map: &ColorMap) -> Vec<Mark> {
    let standing = feature_colors(map);
    let mut marks = Vec::new();
    for shape in map.shapes() {
        match shape {
            Shape::Post { x, y, radius, bands } => {
                marks.extend(bands.iter().filter(|band| standing[band.color.index()]).map(|band| Mark {
                    color: band.color,
                    place: Vector2::new(*x, *y),
                    area: Some(2.0 * radius * (band.to - band.from)),
                }));
            }
            Shape::Polygon { color, vertices } if standing[color.index()] => {
                let middle = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
                marks.push(Mark { color: *color, place: middle.xy(), area: None });
            }
            Shape::Polygon { .. } => {}
        }
    }
    marks
}
