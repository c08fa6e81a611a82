use rand::Rng;

use super::camera::OmniCameraParams;
use crate::random::deviate::quick_normal;

/// Entries of the tone curve.
const N_TONES: usize = 4096;
/// Target mean of the exposure, of full scale.
const MEAN: f32 = 0.22;
/// Mean light of a typical view; the exposure without control is for this.
const USUAL: f32 = 0.3;

/// Makes bytes out of light: exposure, tone curve, noise.
#[derive(Clone, Debug)]
pub(super) struct ImagePipeline {
    noise: f64,
    control: f32,
    tones: Vec<f32>,
}

impl ImagePipeline {
    pub(super) fn new(params: &OmniCameraParams) -> Self {
        let tone = |i: usize| 255.0 * libm::powf(i as f32 / (N_TONES - 1) as f32, 1.0 / 2.2);
        Self {
            noise: params.pixel_noise_sigma,
            control: params.exposure_compensation_share as f32,
            tones: (0..N_TONES).map(tone).collect(),
        }
    }

    pub(super) fn process<R: Rng + ?Sized>(&self, radiance: &[[f32; 3]], rng: &mut R) -> Vec<u8> {
        let sum: f32 = radiance.iter().map(|pixel| (pixel[0] + pixel[1] + pixel[2]) / 3.0).sum();
        let mean = (sum / radiance.len() as f32).max(1e-4);
        let gain = MEAN / (libm::powf(mean, self.control) * libm::powf(USUAL, 1.0 - self.control));
        let scale = gain * (N_TONES - 1) as f32;
        let mut byte = |value: &f32| {
            let tone = self.tones[((value * scale) as usize).min(N_TONES - 1)];
            (f64::from(tone) + self.noise * quick_normal(rng)).round().clamp(0.0, 255.0) as u8
        };
        radiance.iter().flatten().map(&mut byte).collect()
    }
}
