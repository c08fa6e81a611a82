use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
use wayfix_estimation_traits::Pose2;

use super::{light::Light, shots::Shot, start::Area};
use crate::{ColorBlob, ColorModelError, YuvImage, find_blobs, likelihood::feature_colors};

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
        camera: &PinholeCamera,
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

fn sighting(blob: &ColorBlob, at: usize, shot: &Shot, camera: &PinholeCamera) -> Sighting {
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
            ColoredShape::Post { x, y, radius, bands } => {
                marks.extend(bands.iter().filter(|band| standing[band.color.index()]).map(|band| Mark {
                    color: band.color,
                    place: Vector2::new(*x, *y),
                    area: Some(2.0 * radius * (band.to - band.from)),
                }));
            }
            ColoredShape::Polygon { color, vertices } if standing[color.index()] => {
                let middle = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
                marks.push(Mark { color: *color, place: middle.xy(), area: None });
            }
            ColoredShape::Polygon { .. } => {}
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use wayfix_color_map::PostBand;

    use super::*;

    #[test]
    fn from_every_drawn_pose_the_post_is_where_the_blob_was_and_about_as_large() {
        let bands = vec![PostBand { color: ColorId(1), from: 0.2, to: 0.4 }];
        let post = ColoredShape::Post { x: 1.0, y: 0.5, radius: 0.05, bands };
        let carpet = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
        let vertices = carpet.map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
        let carpet = ColoredShape::Polygon { color: ColorId(0), vertices };
        let map = ColorMap::new(vec!["green".into(), "pink".into()], vec![carpet, post]).unwrap();
        let area = Area::of(&map).unwrap();
        // A square metre at a distance of one is a steradian: the band of 0.02 m² is seen from 1 m.
        let camera = Vector2::new(0.1, 0.02);
        let sighting = Sighting { shot: 3, azimuth: 0.4, extent: 0.02, camera };
        let sightings = Sightings { marks: marks(&map), blobs: vec![Vec::new(), vec![sighting]] };
        assert_eq!(sightings.marks.len(), 1, "the carpet is no landmark");

        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let (mut log_distances, mut n_left) = (Vec::new(), 0);
        for (shot, pose) in (0..500).filter_map(|_| sightings.draw(&area, &mut rng)) {
            let rotation = nalgebra::Rotation2::new(pose.heading());
            let to_post = Vector2::new(1.0, 0.5) - (pose.translation + rotation * camera);
            let off = to_post.y.atan2(to_post.x) - pose.heading() - 0.4;
            assert!(off.rem_euclid(2.0 * PI).min((-off).rem_euclid(2.0 * PI)) < 1e-9 && shot == 3);
            log_distances.push(to_post.norm().ln());
            n_left += usize::from(to_post.x > 0.0);
        }
        let n = log_distances.len();
        assert!(n > 400 && (n / 5..4 * n / 5).contains(&n_left), "from all around: {n_left} of {n}");
        let mean = log_distances.iter().sum::<f64>() / n as f64;
        let variance = log_distances.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / n as f64;
        // Five standard errors; the border of the field takes away what is farthest.
        let standard_error = LOG_DISTANCE / (n as f64).sqrt();
        assert!(
            mean.abs() < 5.0 * standard_error && variance.sqrt() < 1.2 * LOG_DISTANCE,
            "{mean} {variance}"
        );
    }
}
