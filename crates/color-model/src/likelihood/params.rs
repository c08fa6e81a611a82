use nalgebra::{Matrix3, Vector3};

use crate::{ColorDensity, ColorModelError, PixelSums};

/// Correlation of the errors of pixels from the unknown light: one error for all, or one for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LightErrorCorrelation {
    /// All pixels of an image share one light: its uncertainty counts once.
    #[default]
    Common,
    /// Pixels are independent, as in [Schulz & Fox 2004, Eqs. 9, 16]: the uncertainty of the light counts for every pixel.
    Each,
}

/// Parameters of the pixel likelihood.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct PixelLikelihoodParams {
    /// Correlation of the errors of pixels from the unknown light: one error for all, or one for each.
    pub light_error_correlation: LightErrorCorrelation,
    /// Number of independent observations that an image is worth: log-likelihoods are multiplied by this over the number of pixels. Neighbouring
    /// pixels share shade, blur and label errors, so their errors are correlated.
    pub independent_pixels: f64,
    /// Share of the map's surface hidden by unmapped objects: a pixel that no map colour explains counts $`\ln`$ of it, at any position.
    pub outlier_share: f64,
    /// The worst that the pixels of one colour can count on average, nats a pixel below the background: a hidden surface does not make a
    /// pose impossible. Infinite for the pixel product as it is in the paper.
    pub log_likelihood_floor: f64,
    /// Variation of a colour over an image and over the field, outside the lighting model: standard deviation of Y as a share of the light's mean
    /// Y, because shade and vignetting multiply the light. Added to the covariance of the lighting filter.
    pub brightness_variation: f64,
    /// The same of U and of V, as a share of the light's mean Y.
    pub chroma_variation: f64,
    /// Pixels left out at both ends of each span, where a small error of the pose changes the label.
    pub edge_margin_pixels: u16,
    /// Share of a uniform background beside the colours that the frames show.
    pub uniform_background_share: f64,
}

impl Default for PixelLikelihoodParams {
    fn default() -> Self {
        Self {
            light_error_correlation: LightErrorCorrelation::Common,
            independent_pixels: 60.0,
            outlier_share: 0.3,
            log_likelihood_floor: 3.0,
            brightness_variation: 0.12,
            chroma_variation: 0.03,
            edge_margin_pixels: 1,
            uniform_background_share: 0.02,
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
    /// The densities of all colours under one light, each widened along the direction of shade, by $`σ^2 s_m s_m^\top`$ with
    /// $`s_m = (Y_m,\; U_m - 128,\; V_m - 128)`$ and $`σ`$ = `brightness_variation`. These densities classify single pixels. Less light scales red,
    /// green and blue by one factor, also with gamma, which moves a colour towards black. Black is Y = 0, as in full-range YUV.
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
            let from_black = (color.mean - Vector3::new(0.0, 128.0, 128.0)) * self.brightness_variation;
            color.covariance += from_black * from_black.transpose();
            color
        };
        colors.into_iter().map(shaded).collect()
    }

    /// The densities of all colours under one light over a whole image, with the variances of `uneven_…`; used to weigh a pose's pixels.
    pub(crate) fn uneven(&self, colors: impl IntoIterator<Item = ColorDensity>) -> Vec<ColorDensity> {
        let mut colors: Vec<ColorDensity> = colors.into_iter().collect();
        let brightness = colors.iter().map(|color| color.mean.x).sum::<f64>() / colors.len() as f64;
        let unevenness = Matrix3::from_diagonal(&self.unevenness(brightness));
        colors.iter_mut().for_each(|color| color.covariance += unevenness);
        colors
    }

    /// The variances of `uneven_…` in a light of this mean Y.
    pub(crate) fn unevenness(&self, brightness: f64) -> Vector3<f64> {
        let [y, uv] =
            [self.brightness_variation, self.chroma_variation].map(|share| (share * brightness).powi(2));
        Vector3::new(y, uv, uv)
    }

    pub(crate) fn check(&self) -> Result<(), ColorModelError> {
        let check = |what, value, is_sound: bool| {
            if is_sound { Ok(()) } else { Err(ColorModelError::OutOfRange { what, value }) }
        };
        let is_share = |value: f64| value > 0.0 && value <= 1.0;
        let Self {
            independent_pixels,
            outlier_share,
            log_likelihood_floor,
            uniform_background_share,
            brightness_variation,
            chroma_variation,
            ..
        } = *self;
        check(
            "independent_pixels",
            independent_pixels,
            independent_pixels > 0.0 && independent_pixels.is_finite(),
        )?;
        check("outlier_share", outlier_share, is_share(outlier_share))?;
        check("log_likelihood_floor", log_likelihood_floor, log_likelihood_floor > 0.0)?;
        check("uniform_background_share", uniform_background_share, is_share(uniform_background_share))?;
        for (what, value) in
            [("brightness_variation", brightness_variation), ("chroma_variation", chroma_variation)]
        {
            check(what, value, value >= 0.0 && value.is_finite())?;
        }
        Ok(())
    }

    /// $`\sum_m \max(-f n_m,\; \sum_{c ∈ m} [\ln p(c | m) - \ln p_{bg}(c)] + o_m \ln ε)`$, tempered.
    pub(crate) fn log_likelihood(&self, n_pixels: usize, regions: impl Iterator<Item = Region>) -> f64 {
        let log_outlier = self.outlier_share.ln();
        let log_ratio = |region: Region| {
            let n = region.count + region.n_outliers;
            let outliers = log_outlier * region.n_outliers;
            let log_ratio = region.log_density + region.background + outliers;
            if n > 0.0 { log_ratio.max(-self.log_likelihood_floor * n) } else { 0.0 }
        };
        regions.map(log_ratio).sum::<f64>() * self.independent_pixels / n_pixels.max(1) as f64
    }
}
