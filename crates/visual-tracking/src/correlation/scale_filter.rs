use std::f64::consts::TAU;

use super::channels::gradient_channels::{N_GRADIENT, gradient_channels};
use super::channels::patch::Patch;
use super::response::vertex;
use crate::RgbImage;

/// Pixels along a cell of the small pictures that scales are judged by.
const CELL: usize = 4;
/// Pixels of such a picture.
const AREA: f64 = 1024.0;
/// Keeps frequencies without energy from deciding.
const REGULARIZATION: f32 = 0.01;
/// Width of the desired response, in scales.
const SIGMA: f64 = 1.5;

/// A correlation filter over scales alone. [Danelljan et al. 2017]
#[derive(Clone, Debug)]
pub(super) struct ScaleFilter {
    factors: Vec<f64>,
    step: f64,
    size: (usize, usize),
    /// $`e^{-2πi k s/S}`$ by frequency, then scale, of the lower half of the frequencies.
    waves: Vec<Vec<[f32; 2]>>,
    desired: Vec<f32>,
    taper: Vec<f32>,
    /// Per frequency: $`\sum x \hat y`$ for every feature, and $`\sum |x|^2`$.
    numerator: Vec<Vec<[f32; 2]>>,
    denominator: Vec<f32>,
}

impl ScaleFilter {
    /// `n_scales` (odd) steps of the factor `step` for a target of `target` pixels.
    pub(super) fn new(n_scales: usize, step: f64, target: [f64; 2]) -> Self {
        let middle = (n_scales / 2) as i32;
        let factors = (0..n_scales).map(|i| step.powi(i as i32 - middle)).collect();
        let wave = |k: usize| {
            let angle = |s: usize| -TAU * ((k * s) % n_scales) as f64 / n_scales as f64;
            (0..n_scales).map(|s| [libm::cos(angle(s)) as f32, libm::sin(angle(s)) as f32]).collect()
        };
        let waves: Vec<Vec<[f32; 2]>> = (0..=n_scales / 2).map(wave).collect();
        let off = |s: usize| (s as f64 - f64::from(middle)) / SIGMA;
        let spectrum = |wave: &Vec<[f32; 2]>| {
            // the desired peak sits at the middle scale, where a sample's own scale is too: seen from there it is even
            (0..n_scales)
                .map(|s| {
                    wave[(s + n_scales - middle as usize) % n_scales][0]
                        * libm::exp(-0.5 * off(s).powi(2)) as f32
                })
                .sum()
        };
        let desired = waves.iter().map(spectrum).collect();
        let hann = |s: usize| 0.5 - 0.5 * libm::cos(TAU * (s + 1) as f64 / (n_scales + 1) as f64);
        let shrink = (AREA / (target[0] * target[1])).sqrt();
        let side = |pixels: f64| (((pixels * shrink) / CELL as f64).round() as usize).clamp(3, 24) * CELL;
        Self {
            factors,
            step,
            size: (side(target[0]), side(target[1])),
            waves,
            desired,
            taper: (0..n_scales).map(|s| hann(s) as f32).collect(),
            numerator: Vec::new(),
            denominator: Vec::new(),
        }
    }

    /// Learns the target of `target` pixels around `center`.
    pub(super) fn learn(&mut self, picture: &RgbImage, center: [f64; 2], target: [f64; 2], rate: f32) {
        let spectrum = self.spectrum(picture, center, target);
        let rate = if self.numerator.is_empty() { 1.0 } else { rate };
        let n_features = spectrum[0].len();
        self.numerator.resize(spectrum.len(), vec![[0.0; 2]; n_features]);
        self.denominator.resize(spectrum.len(), 0.0);
        for (k, features) in spectrum.iter().enumerate() {
            let mut energy = 0.0;
            for (sum, x) in self.numerator[k].iter_mut().zip(features) {
                for part in 0..2 {
                    sum[part] += rate * (x[part] * self.desired[k] - sum[part]);
                    energy += x[part] * x[part];
                }
            }
            self.denominator[k] += rate * (energy - self.denominator[k]);
        }
    }

    /// The factor by which a target of `target` pixels around `center` has grown.
    pub(super) fn factor(&self, picture: &RgbImage, center: [f64; 2], target: [f64; 2]) -> f64 {
        let spectrum = self.spectrum(picture, center, target);
        let answers: Vec<[f32; 2]> = spectrum.iter().enumerate().map(|(k, x)| self.answer(k, x)).collect();
        let n = self.factors.len();
        let at = |shift: usize| -> f64 {
            let mut sum = f64::from(answers[0][0]);
            for (k, [re, im]) in answers.iter().enumerate().skip(1) {
                let [cos, sin] = self.waves[k][shift]; // of −φ
                sum += 2.0 * f64::from(re * cos + im * sin);
            }
            sum
        };
        let response: Vec<f64> = (0..n).map(at).collect();
        let Some(best) = (0..n).max_by(|&a, &b| response[a].total_cmp(&response[b])) else { return 1.0 };
        let shift = if best > n / 2 { best as f64 - n as f64 } else { best as f64 };
        let part = vertex(response[(best + n - 1) % n], response[best], response[(best + 1) % n]);
        libm::pow(self.step, shift + part)
    }

    fn answer(&self, k: usize, features: &[[f32; 2]]) -> [f32; 2] {
        let Some(numerator) = self.numerator.get(k) else { return [0.0; 2] };
        let (mut re, mut im) = (0.0, 0.0);
        for (f, x) in numerator.iter().zip(features) {
            re += f[0] * x[0] + f[1] * x[1];
            im += f[0] * x[1] - f[1] * x[0];
        }
        let energy = self.denominator[k] + REGULARIZATION;
        [re / energy, im / energy]
    }

    /// For every frequency over scales: that of every feature.
    fn spectrum(&self, picture: &RgbImage, center: [f64; 2], target: [f64; 2]) -> Vec<Vec<[f32; 2]>> {
        let samples: Vec<Vec<[f32; N_GRADIENT]>> = self
            .factors
            .iter()
            .map(|factor| {
                let extent = target.map(|side| side * factor);
                gradient_channels(&Patch::sampled(picture, center, extent, self.size), CELL)
            })
            .collect();
        let n_features = samples[0].len() * N_GRADIENT;
        self.waves
            .iter()
            .map(|wave| {
                let mut sums = vec![[0.0_f32; 2]; n_features];
                for ((sample, &[cos, sin]), &taper) in samples.iter().zip(wave).zip(&self.taper) {
                    for (sum, &x) in sums.iter_mut().zip(sample.as_flattened()) {
                        sum[0] += taper * x * cos;
                        sum[1] += taper * x * sin;
                    }
                }
                sums
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    /// An image of blobs enlarged by a factor about the centre.
    fn zoomed(factor: f64) -> RgbImage {
        let value = |i: usize| {
            let off = |at: usize| (at as f64 + 0.5 - 60.0) / factor;
            let (x, y) = (off(i % 120), off(i / 120));
            let waves = (0.35 * x).sin() * (0.28 * y + 0.5).cos() + (0.21 * x + 0.33 * y).sin();
            [(128.0 + 55.0 * waves) as u8; 3]
        };
        RgbImage::from_raw(120, 120, (0..120 * 120).flat_map(value).collect()).expect("3 bytes a pixel")
    }

    #[test]
    fn finds_by_how_much_the_target_has_grown() {
        let (center, size) = ([60.0, 60.0], [40.0, 48.0]);
        let mut filter = ScaleFilter::new(17, 1.03, size);
        filter.learn(&zoomed(1.0), center, size, 1.0);
        for factor in [0.9, 0.97, 1.0, 1.05, 1.12] {
            // the taper over scales is biased towards no change, so a large step takes two updates
            let shown = zoomed(factor);
            let first = filter.factor(&shown, center, size);
            let found = first * filter.factor(&shown, center, size.map(|side| side * first));
            // one step between scales
            assert!(abs_diff_eq!(found / factor, 1.0, epsilon = 0.03), "{factor}: {found}");
        }
    }
}
