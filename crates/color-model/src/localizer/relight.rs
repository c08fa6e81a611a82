use std::sync::Arc;

use wayfix_color_map::ColorId;
use wayfix_particle::RaoBlackwellParticle;

use super::{light::Light, particle::ColorParticle, views::Views};
use crate::{ColorMeans, ColorModelError, PixelLikelihoodParams, PixelSums};

/// Lets the light of every particle drift for `seconds`. Particles that share a light go on sharing it.
pub(crate) fn predict_light(
    particles: &mut [ColorParticle],
    seconds: f64,
    pixels: &PixelLikelihoodParams,
) -> Result<(), ColorModelError> {
    let mut last: Option<(Arc<Light>, Arc<Light>)> = None;
    for particle in particles {
        let shared = particle.shared_conditional();
        let predicted = match &last {
            Some((from, to)) if Arc::ptr_eq(from, shared) => Arc::clone(to),
            _ => {
                let mut bank = shared.bank.clone();
                bank.predict(seconds)?;
                let predicted = Arc::new(Light::new(bank, pixels)?);
                last = Some((Arc::clone(shared), Arc::clone(&predicted)));
                predicted
            }
        };
        particle.set_conditional(predicted);
    }
    Ok(())
}

/// What is needed to update the light of a particle.
pub(crate) struct Relight<'a> {
    pub(crate) views: &'a Views,
    /// The member of its bank that each particle chose.
    pub(crate) members: &'a [usize],
    /// Fewest pixels from which the mean of a colour is taken.
    pub(crate) min_pixels: u64,
    /// The colour that nothing is learned of.
    pub(crate) withheld: Option<ColorId>,
    /// How pixels are weighed.
    pub(crate) pixels: &'a PixelLikelihoodParams,
}

impl Relight<'_> {
    /// Children of `ancestors`, in that order, with the light that their ancestor saw: one update an ancestor, shared by its children.
    pub(crate) fn descendants(&self, particles: &[ColorParticle], ancestors: &[usize]) -> Vec<ColorParticle> {
        let mut last: Option<(usize, Arc<Light>)> = None;
        let child = |&ancestor: &usize| {
            let light = match &last {
                Some((at, light)) if *at == ancestor => Arc::clone(light),
                _ => self.seen(particles[ancestor].shared_conditional(), ancestor),
            };
            last = Some((ancestor, Arc::clone(&light)));
            RaoBlackwellParticle::from_shared(particles[ancestor].sampled, light)
        };
        ancestors.iter().map(child).collect()
    }

    /// The switching Kalman filter's update with the colour means that a particle sees. A light that cannot take them stays as it was.
    fn seen(&self, light: &Arc<Light>, particle: usize) -> Arc<Light> {
        let seen = means(self.views.sums(particle), self.min_pixels);
        let means = self.withheld.map_or_else(|| seen.clone(), |color| seen.without(color));
        let mut bank = light.bank.clone();
        let updated =
            bank.update_member(self.members[particle], &means).and_then(|_| Light::new(bank, self.pixels));
        updated.map_or_else(|_| Arc::clone(light), Arc::new)
    }
}

/// The mean colour of everything seen well enough, $`\bar v`$ of [Schulz & Fox 2004, Eq. 3].
fn means(sums: &[PixelSums], min_pixels: u64) -> ColorMeans {
    let mean = |sums: &PixelSums| if sums.count() >= min_pixels.max(1) { sums.mean() } else { None };
    ColorMeans::new(sums.iter().map(|sums| (mean(sums), sums.count())))
}
