use super::{AzimuthDirection, BrightnessNormalization, IntensityScale};
use crate::{AppearanceMapError, check};

/// How a panorama is described.
///
/// ```
/// use wayfix_appearance_cml::{Panorama, PanoramaDescriptorExtractor, PanoramaDescriptorParams};
/// let params = PanoramaDescriptorParams::default();
/// assert!(PanoramaDescriptorExtractor::new(params, 31, 25).is_err()); // 16 harmonics need 32 columns
/// let extractor = PanoramaDescriptorExtractor::new(params, 32, 25)?;
/// let panorama = Panorama::from_rgb(32, 25, (0..32 * 25).flat_map(|i| [(i * i % 251) as u8; 3]).collect())?;
/// assert_eq!(extractor.describe(&panorama)?.coefficients().len(), 25 * (2 * 16 - 1)); // bytes
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct PanoramaDescriptorParams {
    /// Rings that the rows are averaged into; where there are fewer rows, every row is a ring. Default 25, from 1 to 64.
    pub n_rings: usize,
    /// Sectors that the columns are averaged into; where there are fewer columns, every column is a sector. Default 120, from 4 to 1024.
    pub n_sectors: usize,
    /// Harmonics of the azimuth, the constant one included. Default 16: details down to 24°; at least 2, at most half the sectors and half the columns, at most 64.
    pub n_harmonics: usize,
    /// Standard deviation, in sectors and in rings, of the Gaussian that views are smoothed with; 0 leaves them as they are. Finer detail shows the
    /// exact position more than the place: it differs too much a third of a metre beside the taught lane. Default 1.
    pub smoothing_sigma: f64,
    /// How grey values are weighed. Default: logarithmic.
    pub intensity_scale: IntensityScale,
    /// What brightness is made independent of. Default: mean and variance.
    pub brightness_normalization: BrightnessNormalization,
    /// Least standard deviation of the cells of a view, as a share of the range of the intensity scale. Default 0.01.
    pub min_contrast: f64,
    /// Largest share of pixels that are all black or all white. Default 0.8.
    pub max_saturated_share: f64,
    /// Which way the columns go round. Default: clockwise, left to right.
    pub azimuth_direction: AzimuthDirection,
}

impl Default for PanoramaDescriptorParams {
    fn default() -> Self {
        Self {
            n_rings: 25,
            n_sectors: 120,
            n_harmonics: 16,
            smoothing_sigma: 1.0,
            intensity_scale: IntensityScale::Logarithmic,
            brightness_normalization: BrightnessNormalization::MeanVariance,
            min_contrast: 0.01,
            max_saturated_share: 0.8,
            azimuth_direction: AzimuthDirection::Clockwise,
        }
    }
}

impl PanoramaDescriptorParams {
    /// Checks the ranges.
    ///
    /// # Errors
    /// [`AppearanceMapError::Parameter`] for the first value outside its range.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        let whole = |what, value: usize, holds, range| check::within(what, value as f64, holds, range);
        whole("n_rings", self.n_rings, (1..=64).contains(&self.n_rings), "from 1 to 64")?;
        whole("n_sectors", self.n_sectors, (4..=1024).contains(&self.n_sectors), "from 4 to 1024")?;
        self.check_harmonics(self.n_sectors)?;
        check::not_negative("smoothing_sigma", self.smoothing_sigma)?;
        check::share("min_contrast", self.min_contrast)?;
        check::share("max_saturated_share", self.max_saturated_share)
    }

    /// No more harmonics than can be told apart.
    pub(super) fn check_harmonics(&self, n_sectors: usize) -> Result<(), AppearanceMapError> {
        let holds = (2..=64.min(n_sectors / 2)).contains(&self.n_harmonics);
        let range = "from 2 to 64 and at most half the sectors and columns";
        check::within("n_harmonics", self.n_harmonics as f64, holds, range)
    }
}
