use crate::ColorModelError;

/// Parameters of the comparison of image blobs with blobs expected from the map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct FeatureLikelihoodParams {
    /// Smaller blobs are noise, in the image as in the map's view.
    pub min_pixels: usize,
    /// Probability that a blob which the map should show is there, in (0, 1): missing ones cost $`\ln(1 - p_D)`$ each, no more.
    pub detection_probability: f64,
    /// Mean number of clutter blobs per image and colour.
    pub mean_clutter: f64,
    /// Standard deviation of a small blob's azimuth and of its elevation, rad.
    pub bearing_sigma: f64,
    /// Addition to it for the blob's extent, as a share of the angle of a square of equal area: occlusion shifts the centre of a blob.
    pub bearing_sigma_per_extent: f64,
    /// Standard deviation of the logarithm of a large blob's area. Small ones differ more: half a pixel all around.
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
