use nalgebra::{Matrix3, Vector3};
use wayfix_color_map::ColorId;

use super::{particle::ColorParticle, surroundings::Surroundings};
use crate::{Background, ColorDensity, ColorModelError, Frame, SumDensity, YuvImage};

/// All map colours under all lights that the particles think of: tells pixels that some map colour may explain from outliers.
///
/// A pixel that the background explains better than any colour of the map, under any member of the bank, belongs to something that the map
/// does not know (a ball, a robot, a spectator). That does not depend on where the robot is, so it is decided once a frame, and the sums stay exact.
pub(crate) struct Palette {
    densities: Vec<SumDensity>,
}

/// A frame, and what it could be explained by at best.
pub(crate) struct Look {
    pub(crate) frame: Frame,
    /// $`\sum_c \max_m [\ln p(c|m) - \ln p_{bg}(c)]`$ over all pixels that are no outliers.
    pub(crate) explainable: f64,
}

impl Palette {
    /// Every colour's mixture over the particles, matched in mean and covariance.
    pub(crate) fn of(particles: &[ColorParticle], weights: &[f64]) -> Result<Self, ColorModelError> {
        let Some(first) = particles.first() else { return Ok(Self { densities: Vec::new() }) };
        let (n_members, n_colors) =
            (first.conditional().bank.n_members(), first.conditional().bank.n_colors());
        let densities = (0..n_members)
            .flat_map(|member| (0..n_colors).map(move |color| (member, ColorId(color as u8))))
            .map(|(member, color)| SumDensity::new(&mixed(particles, weights, member, color)))
            .collect::<Result<_, _>>()?;
        Ok(Self { densities })
    }

    pub(crate) fn look(
        &self,
        image: &YuvImage,
        background: Option<&Background>,
    ) -> Result<Look, ColorModelError> {
        let surroundings = Surroundings::of(image);
        let nats_of = |pixel| {
            background.map_or_else(|| surroundings.nats(pixel), |learned| -learned.log_density(pixel))
        };
        let mut memo = Memo::default();
        let mut explainable = 0.0;
        let frame = Frame::with_background(image, |pixel| {
            let best = memo.get(pixel, |pixel| self.best(pixel));
            let nats = nats_of(pixel);
            (best + nats > 0.0).then(|| {
                explainable += best + nats;
                nats
            })
        })?;
        Ok(Look { frame, explainable })
    }

    fn best(&self, pixel: [u8; 3]) -> f64 {
        self.densities.iter().map(|density| density.log(pixel)).fold(f64::NEG_INFINITY, f64::max)
    }
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
