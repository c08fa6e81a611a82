use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use wayfix_color_map::{ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera, PixelSpan};
use wayfix_estimation_traits::{LogWeight, Pose3};

use super::{CameraPoseLikelihood, FeatureLikelihoodParams};
use crate::{
    ColorBlob, ColorDensity, ColorModelError,
    classify::{blobs_of_spans, find_blobs},
};

/// The feature-based likelihood: bearing and area of the blobs of a classified image against those expected from the map.
///
/// Every blob of the image is either clutter, of density $`λ`$ over bearing and log area, or the detection of an expected blob; every expected one
/// is detected with probability $`p_D`$. Relative to an image that is all clutter,
/// ```math
/// \ln p(z | x) = \sum_{\text{expected}} \ln (1 - p_D) + \sum_{\text{pairs}} \ln \frac{p_D\, N(b - \hat b; 0, σ_b^2 I)\, N(\ln a - \ln \hat a; 0, σ_a^2)}{(1 - p_D)\, λ},
/// ```
///
/// over pairs of equal colour that raise it, the best first and each blob once [Bar-Shalom & Fortmann 1988, ch. 9]. A missing or an extra blob
/// therefore has a bounded cost. Expected blobs come from the projected map: clipped to the image, occluded, and merged with neighbours as in the
/// image.
///
/// Features are the colours of standing objects that no horizontal surface has: beacons and goals, but not carpet and lines. A map without such
/// colours makes all poses equal. The light affects the classification only.
/// ```
/// use std::sync::Arc;
/// use nalgebra::Vector3;
/// use wayfix_color_map::{PostBand, PinholeCamera, ColorId, ColorMap, MapRenderer, ColoredShape};
/// use wayfix_color_model::{FeatureLikelihoodParams, FeatureLikelihood, CameraPoseLikelihood};
/// use wayfix_estimation_traits::{LieGroup, Pose3};
/// let beacon = |y, color| {
///     ColoredShape::Post { x: 2.0, y, radius: 0.1, bands: vec![PostBand { color: ColorId(color), from: 0.0, to: 0.4 }] }
/// };
/// let map = Arc::new(ColorMap::new(vec!["pink".into(), "cyan".into()], vec![beacon(0.4, 0), beacon(-0.4, 1)])?);
/// let camera = PinholeCamera::from_field_of_view(104, 80, 1.0, 0.8)?;
/// let looking = |y| Pose3 { translation: Vector3::new(0.0, y, 0.2), ..Pose3::identity() };
/// let mut renderer = MapRenderer::new(map, camera);
/// let labels: Vec<u8> = renderer
///     .labels(&looking(0.0))?
///     .pixels()
///     .iter()
///     .map(|label| label.map_or(255, |color| color.0))
///     .collect();
/// let mut view = FeatureLikelihood::new(&labels, renderer, FeatureLikelihoodParams::default())?;
/// assert!(view.log_likelihood(&looking(0.0), &[]) > view.log_likelihood(&looking(0.3), &[]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct FeatureLikelihood {
    seen: Vec<Feature>,
    renderer: MapRenderer,
    params: FeatureLikelihoodParams,
    /// Whether a colour makes features.
    is_feature: Vec<bool>,
    /// Log density of clutter: blobs per square radian and per e-fold of the area.
    log_clutter: f64,
    spans: Vec<PixelSpan>,
}

impl FeatureLikelihood {
    /// The likelihood of a classified image, 255 being background, as [`PixelClassifier`](crate::PixelClassifier) and [`ColorLookUpTable`](crate::ColorLookUpTable) make it.
    ///
    /// # Errors
    /// Returns an error if there are not as many labels as the camera has pixels, or a parameter is out of range.
    pub fn new(
        labels: &[u8],
        renderer: MapRenderer,
        params: FeatureLikelihoodParams,
    ) -> Result<Self, ColorModelError> {
        params.check()?;
        let camera = *renderer.camera();
        let (width, height) = (camera.width() as usize, camera.height() as usize);
        let (expected, got) = (width * height, labels.len());
        if expected != got {
            return Err(ColorModelError::ImageSize { width, height, expected, got });
        }
        let is_feature = feature_colors(renderer.map());
        let seen = features(&find_blobs(labels, width)?, &camera, &params, &is_feature);
        let view =
            4.0 * (0.5 * width as f64 / camera.fx()).atan() * (0.5 * height as f64 / camera.fy()).atan();
        let log_clutter = (params.mean_clutter / (view * (1.0 + (got as f64).ln()))).ln();
        Ok(Self { seen, renderer, params, is_feature, log_clutter, spans: Vec::new() })
    }

    /// Log gain of a pair over a missing blob and clutter, nats.
    fn gain(&self, seen: &Feature, expected: &Feature) -> f64 {
        let FeatureLikelihoodParams {
            detection_probability,
            bearing_sigma,
            bearing_sigma_per_extent,
            log_area_sigma,
            ..
        } = self.params;
        // Uses the extent of the detected blob, so that the peak is equally high for every pose.
        let off = (seen.bearing - expected.bearing).norm();
        let bearing = bearing_sigma.hypot(bearing_sigma_per_extent * seen.extent);
        let area = log_area_sigma.hypot(2.0 / (0.5 * seen.log_area).exp()); // a square of n pixels has a border of 4 √n
        let direction = log_normal(off, bearing) - (TAU.sqrt() * bearing).ln();
        let size = log_normal(seen.log_area - expected.log_area, area);
        (detection_probability / (1.0 - detection_probability)).ln() + direction + size - self.log_clutter
    }
}

impl CameraPoseLikelihood for FeatureLikelihood {
    fn log_likelihood(&mut self, camera_pose: &Pose3<f64>, _light: &[ColorDensity]) -> LogWeight {
        let Self { renderer, spans, is_feature, params, .. } = self;
        spans.clear();
        let mut add = |span: PixelSpan| {
            if is_feature[span.color.index()] {
                spans.push(span);
            }
        };
        if renderer.spans(camera_pose, &mut add).is_err() {
            return f64::NEG_INFINITY;
        }
        let expected = features(&blobs_of_spans(spans), renderer.camera(), params, is_feature);
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (s, seen) in self.seen.iter().enumerate() {
            let same = expected.iter().enumerate().filter(|(_, expected)| expected.color == seen.color);
            pairs.extend(same.map(|(e, expected)| (self.gain(seen, expected), s, e)));
        }
        pairs.retain(|(gain, ..)| *gain > 0.0);
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let missed = expected.len() as f64 * (1.0 - self.params.detection_probability).ln();
        missed + best_pairs(&pairs, self.seen.len(), expected.len())
    }
}

/// The gains of the best pairs, each blob in one at most.
fn best_pairs(pairs: &[(f64, usize, usize)], n_seen: usize, n_expected: usize) -> f64 {
    let (mut seen_taken, mut expected_taken) = (vec![false; n_seen], vec![false; n_expected]);
    let mut total = 0.0;
    for &(gain, seen, expected) in pairs {
        if !seen_taken[seen] && !expected_taken[expected] {
            (seen_taken[seen], expected_taken[expected]) = (true, true);
            total += gain;
        }
    }
    total
}

/// A blob as the camera's directions have it.
#[derive(Clone)]
struct Feature {
    color: ColorId,
    /// Azimuth to the left and elevation, radians.
    bearing: Vector2<f64>,
    log_area: f64,
    /// Angle that a square of its area takes, radians.
    extent: f64,
}

fn features(
    blobs: &[ColorBlob],
    camera: &PinholeCamera,
    params: &FeatureLikelihoodParams,
    is_feature: &[bool],
) -> Vec<Feature> {
    let is_counted = |blob: &&ColorBlob| {
        blob.n_pixels >= params.min_pixels && is_feature.get(blob.color.index()).is_some_and(|is| *is)
    };
    let feature = |blob: &ColorBlob| {
        let ray: Vector3<f64> = camera.ray(blob.centroid.0, blob.centroid.1);
        let n = blob.n_pixels as f64;
        Feature {
            color: blob.color,
            bearing: Vector2::new(ray.y.atan(), (ray.z / ray.xy().norm()).atan()),
            log_area: n.ln(),
            extent: (n / (camera.fx() * camera.fy())).sqrt(),
        }
    };
    blobs.iter().filter(is_counted).map(feature).collect()
}

/// Colours of the map that no horizontal polygon has.
pub(crate) fn feature_colors(map: &ColorMap) -> Vec<bool> {
    let mut is_feature = vec![true; map.colors().len()];
    for shape in map.shapes() {
        if let ColoredShape::Polygon { color, vertices } = shape
            && vertices.iter().all(|vertex| (vertex.z - vertices[0].z).abs() < 1e-9)
        {
            is_feature[color.index()] = false;
        }
    }
    is_feature
}

/// $`\ln N(x; 0, σ^2)`$.
fn log_normal(x: f64, sigma: f64) -> f64 {
    -0.5 * (x / sigma).powi(2) - (TAU.sqrt() * sigma).ln()
}
