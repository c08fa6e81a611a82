use rand::Rng;

use super::camera::{CameraParams, ChromaSubsampling, ExposureMode};
use crate::league::{LinearRgb, yuv};
use crate::random::deviate::quick_normal;

/// Entries of the table of the response.
const STEPS: usize = 4096;

/// Converts light to image bytes: chip and electronics.
pub(super) struct ImagePipeline {
    params: CameraParams,
    /// Transmission of the lens, row by row.
    lens: Vec<LinearRgb>,
    response: Vec<f64>,
}

impl ImagePipeline {
    pub(super) fn new(params: CameraParams) -> Self {
        let response =
            (0..=STEPS).map(|step| 255.0 * libm::pow(step as f64 / STEPS as f64, params.gamma)).collect();
        Self { params, lens: lens(&params), response }
    }

    /// `balance` multiplies the gains of the channels.
    pub(super) fn process<R: Rng + ?Sized>(
        &self,
        light: &[LinearRgb],
        balance: &LinearRgb,
        rng: &mut R,
    ) -> Vec<u8> {
        let stray = light.iter().sum::<LinearRgb>() * (self.params.stray_light / light.len().max(1) as f64);
        let seen = light
            .iter()
            .zip(&self.lens)
            .map(|(light, lens)| self.mixed(&(light + stray).component_mul(lens)));
        let gains = match self.params.exposure_mode {
            ExposureMode::Manual => self.params.white_balance * self.params.gain,
            ExposureMode::Automatic => {
                automatic_gains(seen.clone().sum::<LinearRgb>() / light.len().max(1) as f64)
            }
        };
        let gains = gains.component_mul(balance);
        let grey = seen.map(|seen| seen.component_mul(&gains).map(|signal| self.grey_value(signal, rng)));
        self.share_chroma(grey.map(|rgb| yuv::from_rgb(&rgb)).collect())
    }

    /// The filters of the pixels differ from the primaries.
    fn mixed(&self, light: &LinearRgb) -> LinearRgb {
        let cross = self.params.crosstalk;
        light * (1.0 - 3.0 * cross) + LinearRgb::repeat(cross * light.sum())
    }

    fn grey_value<R: Rng + ?Sized>(&self, signal: f64, rng: &mut R) -> f64 {
        let read = self.params.read_noise_sigma;
        let sigma = (signal / self.params.full_well_electrons + read * read).sqrt();
        let noisy = (signal + sigma * quick_normal(rng)).clamp(0.0, 1.0);
        self.response[(noisy * STEPS as f64) as usize]
    }

    /// Averages U and V over the pixels that share them, and makes bytes.
    fn share_chroma(&self, yuv: Vec<LinearRgb>) -> Vec<u8> {
        let width = self.params.camera.width() as usize;
        let across = match self.params.chroma_subsampling {
            ChromaSubsampling::Each => 1,
            ChromaSubsampling::Pairs => 2,
        };
        let mut bytes = Vec::with_capacity(3 * yuv.len());
        for group in yuv.chunks(width).flat_map(|row| row.chunks(across)) {
            let mean = group.iter().sum::<LinearRgb>() / group.len() as f64;
            bytes.extend(group.iter().flat_map(|own| yuv::to_rgb(own.x, mean.y, mean.z)));
        }
        bytes
    }
}

/// Average metering and grey world: the mean of every channel becomes the grey card's.
fn automatic_gains(mean: LinearRgb) -> LinearRgb {
    /// Reflectance of a photographer's grey card, to which exposure meters are set. [ISO 2720]
    const GREY_CARD: f64 = 0.18;
    mean.map(|mean| GREY_CARD / mean.max(f64::EPSILON))
}

/// A smooth fall to the corners, where the stated share is lost.
fn lens(params: &CameraParams) -> Vec<LinearRgb> {
    let (width, height) = (params.camera.width(), params.camera.height());
    let (half_width, half_height) = (0.5 * f64::from(width), 0.5 * f64::from(height));
    let through = |column: u32, row: u32| {
        let (x, y) = (f64::from(column) + 0.5 - half_width, f64::from(row) + 0.5 - half_height);
        let corner = (x * x + y * y) / (half_width * half_width + half_height * half_height);
        LinearRgb::repeat(1.0) - params.vignetting * corner
    };
    (0..height).flat_map(|row| (0..width).map(move |column| through(column, row))).collect()
}
