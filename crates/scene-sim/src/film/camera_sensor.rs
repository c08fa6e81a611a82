use rand_chacha::ChaCha8Rng;

use super::sine_sum::SineSum;
use crate::random::deviate::quick_normal;
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::RgbPicture;
use crate::scenery::canvas::{Canvas, Color};

/// Target mean of the automatic exposure, of full scale, and its gain per frame.
const MIDDLE_GREY: f64 = 0.22;
const FOLLOWS: f64 = 0.06;
/// Amplitude of the drift of red and blue against green.
const WHITE_BALANCE: f64 = 0.04;
/// Electrons in a full pixel of an ordinary web camera, and its noise in the dark as a share of full scale.
const FULL_WELL: f64 = 6000.0;
const READ_NOISE: f64 = 0.003;
/// Weight of each neighbour in the blur, along rows and then along columns.
const BLUR: f64 = 0.15;
const STEPS: usize = 4096;

/// A camera: blur, automatic exposure, drifting white balance, noise, the response of displays, 8 bits.
pub(super) struct CameraSensor {
    exposure: Option<f64>,
    balance: [SineSum; 2],
    response: Vec<u8>,
    rng: ChaCha8Rng,
}

impl CameraSensor {
    pub(super) fn new(streams: &mut RandomStreams) -> Self {
        let rng = streams.of(RandomStreamPurpose::WhiteBalance);
        let balance = [SineSum::new(7.0, rng), SineSum::new(8.0, rng)];
        let byte = |step: usize| (255.0 * libm::pow(step as f64 / STEPS as f64, 1.0 / 2.2)).round() as u8;
        let rng = streams.of(RandomStreamPurpose::Pixels).clone();
        Self { exposure: None, balance, response: (0..=STEPS).map(byte).collect(), rng }
    }

    /// The picture that falls on the chip, in bytes.
    pub(super) fn process(&mut self, mut light: Canvas, seconds: f64) -> RgbPicture {
        blur(&mut light);
        let mean = light.pixels.iter().flatten().sum::<f64>() / (3 * light.pixels.len()) as f64;
        let wanted = MIDDLE_GREY / mean.max(1e-6);
        let last = self.exposure.unwrap_or(wanted);
        let exposure = last * libm::pow(wanted / last, FOLLOWS);
        self.exposure = Some(exposure);
        let [red, blue] = self.balance.map(|swing| 1.0 + WHITE_BALANCE * swing.at(seconds));
        let gain = [red * exposure, exposure, blue * exposure];
        let mut rgb = Vec::with_capacity(3 * light.pixels.len());
        for pixel in &light.pixels {
            for (value, gain) in pixel.iter().zip(gain) {
                let signal = (value * gain).min(1.0);
                let sigma = (signal / FULL_WELL + READ_NOISE * READ_NOISE).sqrt();
                let noisy = (signal + sigma * quick_normal(&mut self.rng)).clamp(0.0, 1.0);
                rgb.push(self.response[(noisy * STEPS as f64) as usize]);
            }
        }
        RgbPicture { width: light.width, height: light.height, rgb }
    }
}

/// A lens that is a little soft; beyond the edge the last pixel repeats.
fn blur(light: &mut Canvas) {
    let (width, height) = (light.width, light.height);
    for row in 0..height {
        smear(&mut light.pixels, row * width, 1, width);
    }
    for column in 0..width {
        smear(&mut light.pixels, column, width, height);
    }
}

/// Blurs `n` pixels with stride `step`.
fn smear(pixels: &mut [Color], start: usize, step: usize, n: usize) {
    let mut before = pixels[start];
    for i in 0..n {
        let here = pixels[start + i * step];
        let after = pixels[start + (i + 1).min(n - 1) * step];
        pixels[start + i * step] =
            [0, 1, 2].map(|c| (1.0 - 2.0 * BLUR) * here[c] + BLUR * (before[c] + after[c]));
        before = here;
    }
}
