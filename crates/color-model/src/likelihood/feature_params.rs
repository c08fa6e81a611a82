use crate::ColorModelError;

/// Parameters of the comparison of image blobs with blobs expected from the map.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::Vector3;
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera, PostBand};
/// # use wayfix_color_model::{CameraPoseLikelihood, FeatureLikelihood, FeatureLikelihoodParams};
/// # use wayfix_estimation_traits::{LieGroup, Pose3};
/// # let bands = vec![PostBand { color: ColorId(0), from: 0.0, to: 0.4 }];
/// # let beacon = ColoredShape::Post { x: 2.0, y: 0.0, radius: 0.1, bands };
/// # let map = Arc::new(ColorMap::new(vec!["pink".into()], vec![beacon])?);
/// # let renderer = MapRenderer::new(map, PinholeCamera::from_field_of_view(104, 80, 1.0, 0.8)?);
/// # let camera_pose = Pose3 { translation: Vector3::new(0.0, 0.0, 0.2), ..Pose3::identity() };
/// let params = FeatureLikelihoodParams::default();
/// let mut without_blobs = FeatureLikelihood::new(&[255; 104 * 80], renderer.clone(), params)?;
/// // The map shows one beacon from here, which is detected with probability 0.9.
/// assert!((without_blobs.log_likelihood(&camera_pose, &[]) - 0.1_f64.ln()).abs() < 1e-12);
/// let certain = FeatureLikelihoodParams { detection_probability: 1.0, ..params };
/// assert!(FeatureLikelihood::new(&[255; 104 * 80], renderer, certain).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct FeatureLikelihoodParams {
    /// Smaller blobs are noise, in the image as in the map's view. Default 8: single pixels and their neighbours.
    pub min_pixels: usize,
    /// Probability that a blob which the map should show is there, in (0, 1): missing ones cost $`\ln(1 - p_D)`$ each, no more. Default 0.9, chosen.
    pub detection_probability: f64,
    /// Mean number of clutter blobs per image and colour. Default 1, chosen.
    pub mean_clutter: f64,
    /// Standard deviation of a small blob's azimuth and of its elevation, rad. Default 0.02, about the sway of the camera.
    pub bearing_sigma: f64,
    /// Addition to it for the blob's extent, as a share of the angle of a square of equal area: occlusion shifts the centre of a blob. Default 0.1, chosen.
    pub bearing_sigma_per_extent: f64,
    /// Standard deviation of the logarithm of a large blob's area. Small ones differ more: half a pixel all around. Default 0.3, chosen.
    pub log_area_sigma: f64,
}

impl Default for FeatureLikelihoodParams {
    fn default() -> Self {
        Self {
            min_pixels: 8,
            detection_probability: 0.9,
            mean_clutter: 1.0,
            bearing_sigma: 0.02,
            bearing_sigma_per_extent: 0.1,
            log_area_sigma: 0.3,
        }
    }
}

impl FeatureLikelihoodParams {
    pub(crate) fn check(&self) -> Result<(), ColorModelError> {
        let check = |what, value: f64, is_good: bool| {
            if is_good && value.is_finite() {
                Ok(())
            } else {
                Err(ColorModelError::OutOfRange { what, value })
            }
        };
        let Self {
            detection_probability,
            mean_clutter,
            bearing_sigma,
            bearing_sigma_per_extent,
            log_area_sigma,
            ..
        } = *self;
        check("fewest pixels of a blob", self.min_pixels as f64, self.min_pixels > 0)?;
        check(
            "probability of detection",
            detection_probability,
            detection_probability > 0.0 && detection_probability < 1.0,
        )?;
        check("clutter", mean_clutter, mean_clutter > 0.0)?;
        check("deviation of a bearing (rad)", bearing_sigma, bearing_sigma > 0.0)?;
        check(
            "deviation of a bearing per extent",
            bearing_sigma_per_extent,
            bearing_sigma_per_extent >= 0.0,
        )?;
        check("deviation of a log area", log_area_sigma, log_area_sigma > 0.0)
    }
}
