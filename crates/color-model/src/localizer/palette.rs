use nalgebra::{Matrix3, Vector3};
use wayfix_color_map::ColorId;

use super::{hypothesis::Hypothesis, particle::ColorParticle};
use crate::{ColorDensity, ColorModelError, PixelSumDensity, PrefixSumImage, YuvImage};

/// Every map colour under all lights that the particles think of: tells, for each colour, pixels that it may explain from outliers.
///
/// A pixel that the background explains better than the colour, under any member of the bank, belongs to something that hides it there (a
/// ball, a robot, a spectator). A robot of another colour on the carpet would widen the scatter of the whole carpet; as outliers its pixels
/// count for themselves. That does not depend on where the robot is, so it is decided once a frame, and the sums stay exact.
pub(crate) struct Palette {
    /// Of every colour.
    densities: Vec<Vec<PixelSumDensity>>,
}

impl Palette {
    /// Every colour's mixture over the particles of each hypothesis, matched in mean and covariance.
    pub(crate) fn of(hypotheses: &[Hypothesis]) -> Result<Self, ColorModelError> {
        let n_colors = hypotheses
            .iter()
            .find_map(|hypothesis| hypothesis.light())
            .map_or(0, |light| light.bank.n_colors());
        let mut densities = vec![Vec::new(); n_colors];
        for Hypothesis { particles, weights, .. } in hypotheses {
            let Some(first) = particles.first() else { continue };
            let bank = &first.conditional().bank;
            for member in 0..bank.n_members() {
                for color in (0..bank.n_colors()).map(|color| ColorId(color as u8)) {
                    densities[color.index()].push(PixelSumDensity::new(&mixed(
                        particles,
                        weights.as_slice(),
                        member,
                        color,
                    ))?);
                }
            }
        }
        Ok(Self { densities })
    }

    /// A frame against the background, for every colour without the pixels that it does not explain.
    pub(crate) fn look(
        &self,
        image: &YuvImage,
        nats_of: impl Fn([u8; 3]) -> f64,
        outlier: f64,
    ) -> Result<Vec<PrefixSumImage>, ColorModelError> {
        let look = |densities: &Vec<PixelSumDensity>| {
            let mut memo = Memo::default();
            PrefixSumImage::with_background(image, |pixel| {
                let best = memo.get(pixel, |pixel| best(densities, pixel));
                let nats = nats_of(pixel);
                (best + nats > outlier).then_some(nats)
            })
        };
        self.densities.iter().map(look).collect()
    }
}

fn best(densities: &[PixelSumDensity], pixel: [u8; 3]) -> f64 {
    densities.iter().map(|density| density.log(pixel)).fold(f64::NEG_INFINITY, f64::max)
}

fn mixed(particles: &[ColorParticle], weights: &[f64], member: usize, color: ColorId) -> ColorDensity {
    let origin = particles[0].conditional().bank.member(member).color(color).mean;
    let (mut total, mut sum, mut products) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for (particle, weight) in particles.iter().zip(weights) {
        let density = particle.conditional().bank.member(member).color(color);
        let from_origin = density.mean - origin;
        total += weight;
        sum += from_origin * *weight;
        products += (density.covariance + from_origin * from_origin.transpose()) * *weight;
    }
    let mean = sum / total;
    ColorDensity { mean: origin + mean, covariance: products / total - mean * mean.transpose() }
}

/// A function of a pixel, computed once for each of 64³ cells of YUV.
struct Memo {
    values: Vec<f32>,
}

impl Default for Memo {
    fn default() -> Self {
        Self { values: vec![f32::NAN; 1 << 18] }
    }
}

impl Memo {
    fn get(&mut self, pixel: [u8; 3], compute: impl Fn([u8; 3]) -> f64) -> f64 {
        let [y, u, v] = pixel.map(|channel| usize::from(channel >> 2));
        let value = &mut self.values[(y << 12) | (u << 6) | v];
        if value.is_nan() {
            *value = compute(pixel.map(|channel| (channel & !3) | 2)) as f32;
        }
        f64::from(*value)
    }
}
