use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
use wayfix_estimation_traits::Pose2;

use super::Area;
use crate::{
    ColorBlob, ColorModelError, FeatureLikelihoodParams, find_blobs, likelihood::feature_colors,
    localizer::buffer::BufferedFrame,
};

/// Landmarks detected in classified frames, and the poses from which they look like that: sensor resetting. [Lenser & Veloso 2000]
///
/// A landmark is a surface of a colour that only standing objects have. The direction of a blob leaves two unknowns of a pose; the size of a post's
/// blob leaves one.
pub(crate) struct Detections {
    landmarks: Vec<Landmark>,
    /// By colour.
    blobs: Vec<Vec<Detection>>,
}

/// A standing surface of one colour.
struct Landmark {
    color: ColorId,
    position: Vector2<f64>,
    /// Area that it shows to every side, m²; `None` if that depends on the side.
    area: Option<f64>,
}

/// A blob.
struct Detection {
    /// Index of its frame.
    frame: usize,
    /// Direction in the body frame, rad.
    azimuth: f64,
    /// Solid angle, sr.
    extent: f64,
    /// Position of the camera in the body frame.
    camera: Vector2<f64>,
}

impl Detections {
    pub(crate) fn new(map: &ColorMap) -> Self {
        Self { landmarks: landmarks(map), blobs: map.colors().iter().map(|_| Vec::new()).collect() }
    }

    /// Adds the blobs of a classified frame.
    pub(crate) fn add(
        &mut self,
        labels: &[u8],
        at: usize,
        frame: &BufferedFrame,
        camera: &PinholeCamera,
    ) -> Result<(), ColorModelError> {
        let FeatureLikelihoodParams { min_pixels, .. } = FeatureLikelihoodParams::default();
        for blob in find_blobs(labels, camera.width() as usize)? {
            let is_landmark = self.landmarks.iter().any(|landmark| landmark.color == blob.color);
            if is_landmark && blob.n_pixels >= min_pixels {
                self.blobs[blob.color.index()].push(detection(&blob, at, frame, camera));
            }
        }
        Ok(())
    }

    /// A pose from which one of the landmarks is seen where a blob is, and the index of that blob's frame. `None` if its colour was not detected.
    pub(crate) fn draw<R: Rng + ?Sized>(&self, area: &Area, rng: &mut R) -> Option<(usize, Pose2<f64>)> {
        let landmark = self.landmarks.get(rng.random_range(0..self.landmarks.len().max(1)))?;
        let blobs = &self.blobs[landmark.color.index()];
        let detection = blobs.get(rng.random_range(0..blobs.len().max(1)))?;
        let camera = match landmark.area {
            Some(area) => {
                let log_distance_sigma = FeatureLikelihoodParams::default().log_area_sigma / 2.0;
                let distance = (area / detection.extent).sqrt()
                    * (log_distance_sigma * rng.sample::<f64, _>(StandardNormal)).exp();
                let (sin, cos) = (TAU * rng.random::<f64>()).sin_cos();
                landmark.position - Vector2::new(cos, sin) * distance
            }
            None => area.sample(rng).translation,
        };
        let to_landmark = landmark.position - camera;
        let heading = to_landmark.y.atan2(to_landmark.x) - detection.azimuth;
        let body = camera - nalgebra::Rotation2::new(heading) * detection.camera;
        let pose = Pose2::new(body.x, body.y, heading);
        area.contains(&pose).then_some((detection.frame, pose))
    }
}

fn detection(blob: &ColorBlob, at: usize, frame: &BufferedFrame, camera: &PinholeCamera) -> Detection {
    let ray: Vector3<f64> = frame.mount.rotation * camera.ray(blob.centroid.0, blob.centroid.1);
    Detection {
        frame: at,
        azimuth: ray.y.atan2(ray.x),
        extent: blob.n_pixels as f64 / (camera.fx() * camera.fy()),
        camera: frame.mount.translation.xy(),
    }
}

/// Bands of posts, and upright polygons of colours that no horizontal surface has.
fn landmarks(map: &ColorMap) -> Vec<Landmark> {
    let is_standing = feature_colors(map);
    let mut landmarks = Vec::new();
    for shape in map.shapes() {
        match shape {
            ColoredShape::Post { x, y, radius, bands } => {
                let standing = bands.iter().filter(|band| is_standing[band.color.index()]);
                landmarks.extend(standing.map(|band| Landmark {
                    color: band.color,
                    position: Vector2::new(*x, *y),
                    area: Some(2.0 * radius * (band.to - band.from)),
                }));
            }
            ColoredShape::Polygon { color, vertices } if is_standing[color.index()] => {
                let middle = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
                landmarks.push(Landmark { color: *color, position: middle.xy(), area: None });
            }
            ColoredShape::Polygon { .. } => {}
        }
    }
    landmarks
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use wayfix_color_map::PostBand;

    use super::*;

    #[test]
    fn drawn_pose_shows_the_post_in_the_direction_of_the_blob() {
        let bands = vec![PostBand { color: ColorId(1), from: 0.2, to: 0.4 }];
        let post = ColoredShape::Post { x: 1.0, y: 0.5, radius: 0.05, bands };
        let carpet = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
        let vertices = carpet.map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
        let carpet = ColoredShape::Polygon { color: ColorId(0), vertices };
        let map = ColorMap::new(vec!["green".into(), "pink".into()], vec![carpet, post]).unwrap();
        let area = Area::of(&map).unwrap();
        // A square metre at a distance of one is a steradian: the band of 0.02 m² is seen from 1 m.
        let camera = Vector2::new(0.1, 0.02);
        let detection = Detection { frame: 3, azimuth: 0.4, extent: 0.02, camera };
        let detections = Detections { landmarks: landmarks(&map), blobs: vec![Vec::new(), vec![detection]] };
        assert_eq!(detections.landmarks.len(), 1, "the carpet is no landmark");

        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let (mut log_distances, mut n_left) = (Vec::new(), 0);
        for (frame, pose) in (0..500).filter_map(|_| detections.draw(&area, &mut rng)) {
            let rotation = nalgebra::Rotation2::new(pose.heading());
            let to_post = Vector2::new(1.0, 0.5) - (pose.translation + rotation * camera);
            let off = to_post.y.atan2(to_post.x) - pose.heading() - 0.4;
            assert!(off.rem_euclid(2.0 * PI).min((-off).rem_euclid(2.0 * PI)) < 1e-9 && frame == 3);
            log_distances.push(to_post.norm().ln());
            n_left += usize::from(to_post.x > 0.0);
        }
        let n = log_distances.len();
        assert!(n > 400 && (n / 5..4 * n / 5).contains(&n_left), "from all around: {n_left} of {n}");
        let mean = log_distances.iter().sum::<f64>() / n as f64;
        let variance = log_distances.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / n as f64;
        // Five standard errors; the border of the field removes the largest distances.
        let log_distance_sigma = FeatureLikelihoodParams::default().log_area_sigma / 2.0;
        let standard_error = log_distance_sigma / (n as f64).sqrt();
        assert!(
            mean.abs() < 5.0 * standard_error && variance.sqrt() < 1.2 * log_distance_sigma,
            "{mean} {variance}"
        );
    }
}
