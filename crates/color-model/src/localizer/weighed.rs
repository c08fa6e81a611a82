use rand::{Rng, RngExt};
use wayfix_estimation_traits::Pose2;
use wayfix_particle::NormalizedWeights;

use super::{
    hidden::{or_hidden, was_hidden},
    particle::ColorParticle,
    views::Views,
};
use crate::{ColorModelError, LightingBank};

/// Log-likelihood of a view that cannot be, where a mean is taken, nats.
const IMPOSSIBLE: f64 = -1e6;

/// Importance weights, and the lighting filter that each particle chose.
pub(crate) struct Weighed {
    pub(crate) weights: NormalizedWeights,
    /// The active member of each particle's bank.
    pub(crate) members: Vec<usize>,
    /// Log of the mean likelihood over the particles, nats.
    pub(crate) log_evidence: f64,
    /// Mean log-likelihood over the weighed particles, nats.
    pub(crate) mean_log_likelihood: f64,
    /// The same of a frame that may be hidden.
    pub(crate) mean_log_evidence: f64,
    /// Probability that it is.
    pub(crate) hidden: f64,
    /// The exponent of the likelihoods that left enough particles effective, at most 1.
    pub(crate) tempering: f64,
    n_members: usize,
}

impl Weighed {
    /// Draws each particle's switch from the optimal proposal $`p(j | i, z) ∝ π_{ij}\, p(z | x, \bar θ_j)`$ by enumeration; the weight is then what
    /// the members sum to, whichever was drawn. [Andrieu et al. 2002]
    ///
    /// # Errors
    /// When the frame is impossible from every particle.
    pub(crate) fn new<'a, R: Rng + ?Sized>(
        banks: impl Iterator<Item = &'a LightingBank>,
        prior: &NormalizedWeights,
        views: &Views,
        hidden: f64,
        least_effective: f64,
        rng: &mut R,
    ) -> Result<Self, ColorModelError> {
        let draws: Vec<(usize, f64)> =
            banks.enumerate().map(|(at, bank)| draw_member(bank, views.by_member(at), rng)).collect();
        let log_likelihoods: Vec<f64> = draws.iter().map(|(_, log_likelihood)| *log_likelihood).collect();
        let least = least_effective * prior.effective_sample_size();
        let log_evidences: Vec<f64> = log_likelihoods.iter().map(|l| or_hidden(*l, hidden)).collect();
        let (weights, tempering) = softened(&log_evidences, prior, least)?;
        let log_weights: Vec<f64> =
            log_evidences.iter().zip(prior.as_slice()).map(|(l, w)| l + w.ln()).collect();
        let mean = |value: &dyn Fn(usize) -> f64| {
            let weighed = weights.as_slice().iter().enumerate().filter(|(_, weight)| **weight > 0.0);
            weighed.map(|(at, weight)| value(at) * weight).sum()
        };
        Ok(Self {
            log_evidence: wayfix_gaussian_core::log_sum_exp(&log_weights),
            members: draws.iter().map(|(member, _)| *member).collect(),
            mean_log_likelihood: mean(&|at| log_likelihoods[at].max(IMPOSSIBLE)),
            mean_log_evidence: mean(&|at| log_evidences[at]),
            hidden: mean(&|at| was_hidden(log_likelihoods[at], hidden)),
            tempering,
            n_members: views.n_members(),
            weights,
        })
    }

    /// Body poses with weights.
    pub(crate) fn poses(&self, particles: &[ColorParticle]) -> Vec<(Pose2<f64>, f64)> {
        let bodies = particles.iter().map(|particle| particle.sampled.body);
        bodies.zip(self.weights.as_slice().iter().copied()).collect()
    }

    /// Weight of the particles in each member's light.
    pub(crate) fn light_probabilities(&self) -> Vec<f64> {
        let mut probabilities = vec![0.0; self.n_members];
        for (member, weight) in self.members.iter().zip(self.weights.as_slice()) {
            probabilities[*member] += weight;
        }
        probabilities
    }
}

/// Weights under the largest power of the likelihood, up to 1, that leaves `least` effective particles.
///
/// A few particles spread over a field are too coarse for a likelihood as narrow as an image's: the nearest would take all the weight, near
/// or not. Softened, they move together over some frames; once they are as close as the likelihood is wide, the power is 1.
pub(crate) fn softened(
    log_likelihoods: &[f64],
    prior: &NormalizedWeights,
    least: f64,
) -> Result<(NormalizedWeights, f64), ColorModelError> {
    let weights = |power: f64| {
        let log_weight = |(l, w): (&f64, &f64)| if *l == f64::NEG_INFINITY { *l } else { power * l + w.ln() };
        NormalizedWeights::from_log(
            &log_likelihoods.iter().zip(prior.as_slice()).map(log_weight).collect::<Vec<_>>(),
        )
    };
    let full = weights(1.0)?;
    if full.effective_sample_size() >= least {
        return Ok((full, 1.0));
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        let enough = weights(middle)?.effective_sample_size() >= least;
        *(if enough { &mut low } else { &mut high }) = middle;
    }
    Ok((weights(low)?, low))
}

/// The member drawn, and the log-likelihood that all members sum to.
fn draw_member<R: Rng + ?Sized>(bank: &LightingBank, by_member: &[f64], rng: &mut R) -> (usize, f64) {
    let uniform: f64 = rng.random(); // drawn in any case, so that particles stay in step
    let best = by_member.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if best == f64::NEG_INFINITY {
        return (bank.active(), best);
    }
    let share = |member: usize| bank.switch_probability(member) * (by_member[member] - best).exp();
    let total: f64 = (0..by_member.len()).map(share).sum();
    let mut left = uniform * total;
    let drawn = (0..by_member.len()).find(|&member| {
        left -= share(member);
        left < 0.0
    });
    (drawn.unwrap_or(bank.active()), best + total.ln())
}
