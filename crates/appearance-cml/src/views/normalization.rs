use crate::AppearanceMapError;

/// Scale of grey values before descriptors: linear or logarithmic.
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceMapError, BrightnessNormalization, IntensityScale, Panorama};
/// # use wayfix_appearance_cml::{PanoramaDescriptorExtractor, PanoramaDescriptorParams, ViewDescriptor};
/// # let lit = |light: usize| Panorama::from_rgb(64, 1, (0..64).flat_map(|i| [((40 + i) * light) as u8; 3]).collect());
/// # let of_twice_the_light = |intensity_scale| -> Result<f64, AppearanceMapError> {
/// #     let brightness_normalization = BrightnessNormalization::Mean;
/// #     let params = PanoramaDescriptorParams { intensity_scale, brightness_normalization, ..Default::default() };
/// #     let extractor = PanoramaDescriptorExtractor::new(params, 64, 1)?;
/// #     Ok(extractor.describe(&lit(2)?)?.compare(&extractor.describe(&lit(1)?)?).distance)
/// # };
/// // The distance of a view to the same view in twice the light, only their means removed.
/// let [linear, logarithmic] = [of_twice_the_light(IntensityScale::Linear)?, of_twice_the_light(IntensityScale::Logarithmic)?];
/// assert!(logarithmic < 0.2 * linear);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum IntensityScale {
    /// As they are.
    Linear,
    /// $`\ln(8 + \text{grey})`$: light multiplies what surfaces reflect, so its changes become an offset, which normalization takes away. The 8
    /// keeps the noise of dark pixels small.
    Logarithmic,
}

/// What the brightness of a view is made independent of.
///
/// ```
/// # use wayfix_appearance_cml::{AppearanceMapError, BrightnessNormalization, IntensityScale, Panorama};
/// # use wayfix_appearance_cml::{PanoramaDescriptorExtractor, PanoramaDescriptorParams, ViewDescriptor};
/// # let distance = |brightness_normalization, gain: usize, offset: usize| -> Result<f64, AppearanceMapError> {
/// #     let grey = |gain, offset| (0..64).flat_map(|i| [((40 + i) * gain + offset) as u8; 3]).collect();
/// #     let params = PanoramaDescriptorParams { brightness_normalization, intensity_scale: IntensityScale::Linear, ..Default::default() };
/// #     let extractor = PanoramaDescriptorExtractor::new(params, 64, 1)?;
/// #     let describe = |gain, offset| extractor.describe(&Panorama::from_rgb(64, 1, grey(gain, offset))?);
/// #     Ok(describe(gain, offset)?.compare(&describe(1, 0)?).distance)
/// # };
/// // The distance of a view to the same view with 51 added to all grey values, and with twice the grey values.
/// assert!((distance(BrightnessNormalization::None, 1, 51)? - 0.2).abs() < 0.01); // 51 of 255
/// assert!(distance(BrightnessNormalization::Mean, 1, 51)? < 0.01);
/// assert!(distance(BrightnessNormalization::Mean, 2, 0)? > 0.05);
/// assert!(distance(BrightnessNormalization::MeanVariance, 2, 0)? < 0.01);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum BrightnessNormalization {
    /// Of nothing: values are divided by their full range only.
    None,
    /// Of the mean over the view.
    Mean,
    /// Of mean and standard deviation over the view: distances are in standard deviations.
    MeanVariance,
}

impl IntensityScale {
    pub(super) fn of(self, grey: f64) -> f64 {
        match self {
            Self::Linear => grey,
            Self::Logarithmic => (8.0 + grey).ln(),
        }
    }

    fn range(self) -> f64 {
        self.of(255.0) - self.of(0.0)
    }
}

impl BrightnessNormalization {
    /// Normalizes the cells of a view in place.
    ///
    /// # Errors
    /// [`AppearanceMapError::BlankView`] when their standard deviation is less than `min_contrast` of the range of the intensity scale.
    pub(super) fn apply(
        self,
        tone: IntensityScale,
        min_contrast: f64,
        cells: &mut [f64],
    ) -> Result<(), AppearanceMapError> {
        let n = cells.len() as f64;
        let mean = cells.iter().sum::<f64>() / n;
        let sigma = (cells.iter().map(|cell| (cell - mean).powi(2)).sum::<f64>() / n).sqrt();
        let contrast = sigma / tone.range();
        // A constant view has no contrast but what rounding leaves.
        if contrast <= min_contrast.max(1e-9) {
            return Err(AppearanceMapError::BlankView { contrast, min_contrast });
        }
        let (offset, scale) = match self {
            Self::None => (0.0, tone.range()),
            Self::Mean => (mean, tone.range()),
            Self::MeanVariance => (mean, sigma),
        };
        cells.iter_mut().for_each(|cell| *cell = (*cell - offset) / scale);
        Ok(())
    }
}
