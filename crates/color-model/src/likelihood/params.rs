use nalgebra::{Matrix3, Vector3};

use crate::{ColorDensity, ColorModelError, PixelSums, TiledImage};

/// Whether pixels share the light that is not known.
/// ```
/// use wayfix_color_model::{LightErrorCorrelation, LikelihoodModel, PixelLikelihoodParams};
/// assert_eq!(PixelLikelihoodParams::as_published().light_error_correlation, LightErrorCorrelation::Each);
/// // Only tiles may be in the shade.
/// assert!(PixelLikelihoodParams::default().mixes_lights() && !PixelLikelihoodParams::as_published().mixes_lights());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LightErrorCorrelation {
    /// The pixels of a tile share a light, or its shade: sun and shade may lie on one carpet.
    #[default]
    #[cfg_attr(feature = "serde", serde(alias = "common"))]
    Tile,
    /// Pixels are independent, as in [Schulz & Fox 2004, Eqs. 9, 16]: the uncertainty of the light counts for every pixel.
    Each,
}

/// Parameters of the pixel likelihood.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{Matrix3, Vector3};
/// # use wayfix_color_map::{ColorMap, MapRenderer, PinholeCamera};
/// # use wayfix_color_model::{ColorDensity, PixelLikelihoodParams, PixelSpanLikelihood, PrefixSumImage, YuvImage};
/// # let frame = PrefixSumImage::new(&YuvImage::new(2, 2, vec![[90, 110, 100]; 4])?)?;
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![])?);
/// # let renderer = MapRenderer::new(map, PinholeCamera::from_field_of_view(2, 2, 1.0, 1.0)?);
/// let green = ColorDensity { mean: Vector3::new(90.0, 110.0, 100.0), covariance: Matrix3::identity() * 25.0 };
/// assert_eq!(PixelLikelihoodParams::as_published().shaded([green]), [green]); // the light is even
/// // Without outliers, one pixel could exclude a pose.
/// let strict = PixelLikelihoodParams { outlier_share: 0.0, ..PixelLikelihoodParams::default() };
/// assert!(PixelSpanLikelihood::new(&frame, renderer, strict).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct PixelLikelihoodParams {
    /// Whether the pixels of an image share the unknown light.
    pub light_error_correlation: LightErrorCorrelation,
    /// Side of a tile, pixels. The pixels of one colour in a tile share shade, blur and label errors, and count as one observation. Default 16: the
    /// edge of a shadow crosses few tiles, and landmarks have tiles of their own.
    pub tile_pixels: u16,
    /// Prior probability that a tile shows something that is not on the map, when a light is learned; of independent pixels, that a region does. To the likelihood
    /// of tiles any share of an image is as probable. Default 0.1: a person or a ball covers about a tenth of a view.
    pub outlier_share: f64,
    /// Standard deviation of the illumination over the field and over an image, as a share of the light. Default 0.12: vignetting and shade.
    pub brightness_variation: f64,
    /// Pixels left out at both ends of each span, where a small error of the pose changes the label. Default 1.
    pub edge_margin_pixels: u16,
}

impl Default for PixelLikelihoodParams {
    fn default() -> Self {
        Self {
            light_error_correlation: LightErrorCorrelation::Tile,
            tile_pixels: 16,
            outlier_share: 0.1,
            brightness_variation: 0.12,
            edge_margin_pixels: 1,
        }
    }
}

/// Statistics of the pixels that a pose assigns to one colour.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Region {
    /// Pixels, without outliers.
    pub(crate) count: f64,
    pub(crate) n_outliers: f64,
    /// $`\sum \ln p(c|m)`$.
    pub(crate) log_density: f64,
    /// $`-\sum \ln p_{bg}(c)`$.
    pub(crate) background: f64,
}

impl Region {
    pub(crate) fn new(sums: &PixelSums, log_density: f64) -> Self {
        Self {
            count: sums.count() as f64,
            n_outliers: sums.n_outliers() as f64,
            log_density,
            background: sums.background_nats(),
        }
    }
}

impl PixelLikelihoodParams {
    /// The pixel product as printed [Schulz & Fox 2004, Eq. 16]: independent pixels under independent lights, without outliers, uneven light and margins.
    pub fn as_published() -> Self {
        Self {
            light_error_correlation: LightErrorCorrelation::Each,
            tile_pixels: Self::default().tile_pixels,
            outlier_share: f64::MIN_POSITIVE,
            brightness_variation: 0.0,
            edge_margin_pixels: 0,
        }
    }

    /// The densities of all colours under one light, each widened along the direction of shade, by $`σ^2 s_m s_m^\top`$ with
    /// $`s_m = (Y_m,\; U_m - 128,\; V_m - 128)`$ and $`σ`$ = `brightness_variation`. Less light scales red, green and blue by one factor, also with gamma, which
    /// moves a colour towards black. Black is Y = 0, as in full-range YUV.
    /// ```
    /// use nalgebra::{Matrix3, Vector3};
    /// use wayfix_color_model::{ColorDensity, PixelLikelihoodParams};
    /// let yellow = ColorDensity { mean: Vector3::new(100.0, 78.0, 128.0), covariance: Matrix3::identity() * 25.0 };
    /// let [shaded] = PixelLikelihoodParams::default().shaded([yellow])[..] else { panic!("as many as there were") };
    /// assert!((shaded.covariance[(0, 0)] - (25.0 + 12.0 * 12.0)).abs() < 1e-9); // 0.12 of a Y of 100
    /// assert!((shaded.covariance[(0, 1)] - 12.0 * -6.0).abs() < 1e-9); // darker is less yellow
    /// assert_eq!(shaded.covariance[(2, 2)], 25.0);
    /// ```
    pub fn shaded(&self, colors: impl IntoIterator<Item = ColorDensity>) -> Vec<ColorDensity> {
        let shaded = |mut color: ColorDensity| {
            color.covariance += self.shade(&color.mean);
            color
        };
        colors.into_iter().map(shaded).collect()
    }

    /// Covariance of a colour of this mean by uneven light.
    pub(crate) fn shade(&self, mean: &Vector3<f64>) -> Matrix3<f64> {
        let from_black = (mean - Vector3::new(0.0, 128.0, 128.0)) * self.brightness_variation;
        from_black * from_black.transpose()
    }

    pub(crate) fn check(&self) -> Result<(), ColorModelError> {
        let check = |what, value, is_within: bool| {
            if is_within { Ok(()) } else { Err(ColorModelError::OutOfRange { what, value }) }
        };
        let Self { tile_pixels, outlier_share, brightness_variation, .. } = *self;
        let is_side = (1..=TiledImage::MAX_SIDE).contains(&tile_pixels);
        check("side of a tile (pixels)", f64::from(tile_pixels), is_side)?;
        check("share of outliers", outlier_share, outlier_share > 0.0 && outlier_share < 1.0)?;
        check(
            "brightness variation",
            brightness_variation,
            brightness_variation >= 0.0 && brightness_variation.is_finite(),
        )
    }

    /// $`\sum_m \max(n_m \ln ε,\; \sum_{c ∈ m} [\ln p(c | m) - \ln p_{bg}(c)] + o_m \ln ε)`$.
    pub(crate) fn log_likelihood(&self, regions: impl Iterator<Item = Region>) -> f64 {
        let log_outlier = self.outlier_share.ln();
        let log_ratio = |region: Region| {
            let n = region.count + region.n_outliers;
            let log_ratio = region.log_density + region.background + log_outlier * region.n_outliers;
            if n > 0.0 { log_ratio.max(log_outlier * n) } else { 0.0 }
        };
        regions.map(log_ratio).sum()
    }
}
