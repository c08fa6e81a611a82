use rand::Rng;
use wayfix_particle::{KldParams, KldSampling, NormalizedWeights, Resampler, SystematicResampler, grid_cell};

use super::{LocalizerParams, particle::ColorParticle, relight::Relight};
use crate::ColorModelError;

/// Sides of a cell that particles occupy, metres and radians.
const CELL: [f64; 3] = [0.1, 0.1, 0.1];

/// The next generation of particles: as many as their spread needs [Fox 2003], between the bounds, drawn anew when few are effective.
pub(crate) fn renew<R: Rng + ?Sized>(
    particles: &[ColorParticle],
    weights: &NormalizedWeights,
    relight: &Relight,
    params: &LocalizerParams,
    most: usize,
    rng: &mut R,
) -> Result<(Vec<ColorParticle>, NormalizedWeights), ColorModelError> {
    let kld = KldSampling::new(KldParams {
        min_particles: params.min_particles.min(most),
        max_particles: most,
        ..KldParams::default()
    })?;
    let cell = |at: usize| {
        let body = particles[at].sampled.body;
        grid_cell([body.x(), body.y(), body.heading()], CELL)
    };
    let n_wanted = n_wanted(&kld, &SystematicResampler.ancestors(weights, most, rng)?, cell);
    let is_poor = weights.effective_sample_size() < params.resample_below * particles.len() as f64;
    let has_enough = (n_wanted..=2 * n_wanted).contains(&particles.len());
    if !is_poor && has_enough && particles.len() <= most {
        let all: Vec<usize> = (0..particles.len()).collect();
        return Ok((relight.descendants(particles, &all), weights.clone()));
    }
    let ancestors = SystematicResampler.ancestors(weights, n_wanted, rng)?;
    let equal = NormalizedWeights::from_linear(vec![1.0; n_wanted])?;
    Ok((relight.descendants(particles, &ancestors), equal))
}

fn n_wanted(kld: &KldSampling, drawn: &[usize], cell: impl Fn(usize) -> [i64; 3]) -> usize {
    let cells: std::collections::BTreeSet<_> = drawn.iter().map(|&at| cell(at)).collect();
    kld.required(cells.len())
}
