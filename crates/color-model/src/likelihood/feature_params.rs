use crate::ColorModelError;

/// How blobs of a classified image are compared with those that the map should show.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct FeatureParams {
    /// Smaller blobs are noise, in the image as in the map's view.
    pub min_pixels: usize,
    /// Probability that a blob which the map should show is there, in (0, 1): missing ones cost $`\ln(1 - p_D)`$ each, no more.
    pub detection: f64,
    /// Blobs of an image that nothing in the map explains, on average and for each colour.
    pub clutter: f64,
    /// Standard deviation of a small blob's direction, azimuth and elevation alike, radians.
    pub bearing: f64,
    /// What a blob's own extent adds to that, as a share of the angle that a square of its area takes: half-hidden blobs have their centre elsewhere.
    pub bearing_per_extent: f64,
    /// Standard deviation of the logarithm of a large blob's area. Small ones differ more: half a pixel all around.
    pub log_area: f64,
}

impl Default for FeatureParams {
    fn default() -> Self {
        Self {
            min_pixels: 8,
            detection: 0.9,
            clutter: 1.0,
            bearing: 0.02,
            bearing_per_extent: 0.1,
            log_area: 0.3,
        }
    }
}

impl FeatureParams {
    pub(crate) fn check(&self) -> Result<(), ColorModelError> {
        let check = |what, value: f64, is_good: bool| {
            if is_good && value.is_finite() {
                Ok(())
            } else {
                Err(ColorModelError::OutOfRange { what, value })
            }
        };
        let Self { detection, clutter, bearing, bearing_per_extent, log_area, .. } = *self;
        check("fewest pixels of a blob", self.min_pixels as f64, self.min_pixels > 0)?;
        check("probability of detection", detection, detection > 0.0 && detection < 1.0)?;
        check("clutter", clutter, clutter > 0.0)?;
        check("deviation of a bearing (rad)", bearing, bearing > 0.0)?;
        check("deviation of a bearing per extent", bearing_per_extent, bearing_per_extent >= 0.0)?;
        check("deviation of a log area", log_area, log_area > 0.0)
    }
}
