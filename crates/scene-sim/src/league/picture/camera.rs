use wayfix_color_map::PinholeCamera;

use crate::league::LinearRgb;
use crate::{SimulationError, check};

/// The camera in a robot's head: optics, chip and image processing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraParams {
    /// Size and focal length. Default: that of an ERS-7, 208 × 160 pixels and 56.9° × 45.2°.
    pub camera: PinholeCamera,
    /// Exposure time, ms. Default 10.
    pub exposure_ms: u32,
    /// What sets gain and white balance. Default [`ExposureMode::Manual`].
    pub exposure_mode: ExposureMode,
    /// Signal, as a share of full scale, of radiance 1. Default 1.
    pub gain: f64,
    /// Gains of the three channels. Default 1.
    pub white_balance: LinearRgb,
    /// Drift of the automatic white balance: σ of the logarithm of the gains of red and blue. Default 0.02.
    pub white_balance_drift_sigma: f64,
    /// Correlation time of that drift, seconds. Default 20.
    pub white_balance_correlation_s: f64,
    /// Share of red, green and blue lost in the corners of the picture. Default (0.58, 0.50, 0.18): corners are dark and bluish.
    pub vignetting: LinearRgb,
    /// Share of each channel that comes from each of the others. Default 0.05.
    pub crosstalk: f64,
    /// Stray light: share of the image mean added to every pixel. Default 0.015.
    pub stray_light: f64,
    /// Electrons at full scale: shot noise has σ = √(signal / electrons). Default 4000.
    pub full_well_electrons: f64,
    /// Read noise, σ as a share of full scale. Default 0.003.
    pub read_noise_sigma: f64,
    /// Exponent of the response, signal to grey value. Default 0.5.
    pub gamma: f64,
    /// Which pixels share their colour. Default [`ChromaSubsampling::Pairs`].
    pub chroma_subsampling: ChromaSubsampling,
    /// Quality of the JPEG files, 1 to 100. Default 88.
    pub jpeg_quality: u8,
}

/// Chroma subsampling: pixels that share one value of U and V.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ChromaSubsampling {
    /// Each has its own (4:4:4).
    Each,
    /// Two beside each other (4:2:2).
    #[default]
    Pairs,
}

/// What sets gain and white balance of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ExposureMode {
    /// [`gain`](CameraParams::gain) and [`white_balance`](CameraParams::white_balance).
    #[default]
    Manual,
    /// Each picture: its mean becomes 18 % grey, by average metering [ISO 2720] and the grey-world assumption [Buchsbaum 1980].
    Automatic,
}

impl CameraParams {
    /// The defaults, for a custom camera.
    pub fn new(camera: PinholeCamera) -> Self {
        Self {
            camera,
            exposure_ms: 10,
            exposure_mode: ExposureMode::default(),
            gain: 1.0,
            white_balance: LinearRgb::repeat(1.0),
            white_balance_drift_sigma: 0.02,
            white_balance_correlation_s: 20.0,
            vignetting: LinearRgb::new(0.58, 0.50, 0.18),
            crosstalk: 0.05,
            stray_light: 0.015,
            full_well_electrons: 4000.0,
            read_noise_sigma: 0.003,
            gamma: 0.5,
            chroma_subsampling: ChromaSubsampling::default(),
            jpeg_quality: 88,
        }
    }

    /// The camera of an ERS-7, with the defaults.
    ///
    /// # Errors
    /// Returns the errors of [`PinholeCamera`]; none occur, because its numbers are constant.
    pub fn ers7() -> Result<Self, SimulationError> {
        Ok(Self::new(PinholeCamera::from_field_of_view(
            208,
            160,
            56.9_f64.to_radians(),
            45.2_f64.to_radians(),
        )?))
    }

    /// Whether the numbers make a camera.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        let n_pixels = self.camera.width() as usize * self.camera.height() as usize;
        check::count("pixels of the camera", n_pixels, 1 << 22)?;
        check::at_most("exposure (ms)", f64::from(self.exposure_ms), 1000.0, "at most 1000")?;
        check::not_negative("gain", self.gain)?;
        self.white_balance.iter().try_for_each(|&gain| check::not_negative("white balance", gain))?;
        check::not_negative("drift of the white balance", self.white_balance_drift_sigma)?;
        check::not_negative("correlation time of the white balance (s)", self.white_balance_correlation_s)?;
        self.vignetting.iter().try_for_each(|&loss| check::share("vignetting", loss))?;
        check::share("crosstalk", self.crosstalk)?;
        check::share("stray_light", self.stray_light)?;
        check::positive("electrons at full scale", self.full_well_electrons)?;
        check::not_negative("read noise", self.read_noise_sigma)?;
        check::positive("gamma", self.gamma)?;
        check::positive("quality of the JPEG files", f64::from(self.jpeg_quality))?;
        check::at_most("quality of the JPEG files", f64::from(self.jpeg_quality), 100.0, "at most 100")
    }
}
