use std::sync::Arc;

use rand::Rng;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_particle::{NormalizedWeights, RaoBlackwellParticle, Resampler, SystematicResampler};

use super::{PoseEstimate, estimate::dominant_cluster, light::Light, particle::ColorParticle, seen::Seen};
use crate::ColorModelError;

/// One place where the robot may be: particles that are weighed and resampled among themselves, and what all frames say for it.
///
/// Resampled together, the particles of a few frames' favourite would crowd out the others; apart, every place keeps its particles
/// and its light until the frames have decided: a mixture of particle filters [Vermaak et al. 2003].
#[derive(Clone)]
pub(crate) struct Hypothesis {
    pub(crate) particles: Vec<ColorParticle>,
    pub(crate) weights: NormalizedWeights,
    /// Log-likelihood of the frames since the robot was looked for, nats.
    pub(crate) log_evidence: f64,
    /// Probability that the last view was hidden, if the robot is here.
    pub(crate) hidden: f64,
}

impl Hypothesis {
    /// Where most of its particles are.
    pub(crate) fn place(&self) -> Option<Pose2<f64>> {
        dominant_cluster(&self.poses()).map(|estimate| *estimate.pose.mean())
    }

    /// The light of its heaviest particle.
    pub(crate) fn light(&self) -> Option<&Arc<Light>> {
        let heaviest = self.particles.iter().zip(self.weights.as_slice()).max_by(|a, b| a.1.total_cmp(b.1));
        heaviest.map(|(particle, _)| particle.shared_conditional())
    }

    /// Gives half of the weight to particles that a search found here, under the light that is known here.
    pub(crate) fn join<R: Rng + ?Sized>(
        &mut self,
        refined: &Seen,
        rng: &mut R,
    ) -> Result<(), ColorModelError> {
        let Some(light) = self.light().map(Arc::clone) else { return Ok(()) };
        let n = self.particles.len();
        let ancestors = SystematicResampler.ancestors(&refined.weighed.weights, n, rng)?;
        let newcomer = |&at: &usize| {
            RaoBlackwellParticle::from_shared(refined.particles[at].sampled, Arc::clone(&light))
        };
        self.particles.extend(ancestors.iter().map(newcomer));
        let weights = self.weights.as_slice().iter().copied().chain(std::iter::repeat_n(1.0 / n as f64, n));
        self.weights = NormalizedWeights::from_linear(weights.collect())?;
        Ok(())
    }

    /// Body poses with weights.
    pub(crate) fn poses(&self) -> Vec<(Pose2<f64>, f64)> {
        let bodies = self.particles.iter().map(|particle| particle.sampled.body);
        bodies.zip(self.weights.as_slice().iter().copied()).collect()
    }
}

/// A hypothesis in the light of a frame.
pub(crate) struct Judged {
    pub(crate) seen: Seen,
    pub(crate) estimate: PoseEstimate,
    pub(crate) log_evidence: f64,
    /// Probability that the view was hidden.
    pub(crate) hidden: f64,
}

/// Poses nearer to each other than this, in metres and in radians, belong together.
const REACH: [f64; 3] = [0.3, 0.3, 0.4];

/// Whether two poses are one place.
pub(crate) fn is_same_place(a: &Pose2<f64>, b: &Pose2<f64>) -> bool {
    let off = a.local(b);
    (0..3).map(|axis| (off[axis] / REACH[axis]).powi(2)).sum::<f64>() < 1.0
}

/// The better of the hypotheses, best first: none twice, `most` of them, and none that the frames made `hopeless` nats less likely than the best.
pub(crate) fn shortlist(mut judged: Vec<Judged>, most: usize, hopeless: f64) -> Vec<Judged> {
    judged.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let mut kept: Vec<Judged> = Vec::new();
    for one in judged {
        let is_known = |other: &Judged| is_same_place(other.estimate.pose.mean(), one.estimate.pose.mean());
        let is_hopeless = |best: &Judged| best.log_evidence - one.log_evidence > hopeless;
        if kept.len() < most.max(1) && !kept.iter().any(is_known) && !kept.first().is_some_and(is_hopeless) {
            kept.push(one);
        }
    }
    kept
}

/// Posterior probability of the first of several hypotheses, equally probable beforehand.
pub(crate) fn share_of_first(judged: &[Judged]) -> f64 {
    let Some(first) = judged.first() else { return 0.0 };
    1.0 / judged.iter().map(|one| (one.log_evidence - first.log_evidence).exp()).sum::<f64>()
}

/// By how many nats the first of several hypotheses is ahead of the second; infinitely many when it is the only one.
pub(crate) fn lead(judged: &[Judged]) -> f64 {
    let [first, second, ..] = judged else { return f64::INFINITY };
    first.log_evidence - second.log_evidence
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use wayfix_gaussian_core::Gaussian;
    use wayfix_kalman::MarkovChain;

    use super::*;
    use crate::{
        LightingBank, LightingFilter, LightingFilterParams, PixelLikelihoodParams,
        localizer::{CameraError, CameraLocation, views::Views, weighed::Weighed},
    };

    fn light(brightness: f64) -> Arc<Light> {
        let prior =
            Gaussian::new(DVector::from_element(3, brightness), DMatrix::from_diagonal_element(3, 3, 100.0));
        let filter = LightingFilter::new(prior.unwrap(), LightingFilterParams::default()).unwrap();
        let bank = LightingBank::new(vec![filter], MarkovChain::sticky(1, 0.9).unwrap()).unwrap();
        Arc::new(Light::new(bank, &PixelLikelihoodParams::default()).unwrap())
    }

    fn particles(n: usize, x: f64, light: &Arc<Light>) -> Vec<ColorParticle> {
        let location = CameraLocation { body: Pose2::new(x, 0.0, 0.0), error: CameraError::default() };
        (0..n).map(|_| RaoBlackwellParticle::from_shared(location, Arc::clone(light))).collect()
    }

    /// What a look at `particles` gives while nothing tells them apart.
    fn seen(particles: Vec<ColorParticle>, light: &Light, rng: &mut ChaCha8Rng) -> Seen {
        let (n, views) = (particles.len(), Views::new(particles.len(), &light.bank));
        let banks = particles.iter().map(|particle| &particle.conditional().bank);
        let weighed = Weighed::new(banks, &equal(n), &views, 0.0, 0.2, rng).unwrap();
        Seen { weighed, views, particles, fit: 0.3 }
    }

    fn equal(n: usize) -> NormalizedWeights {
        NormalizedWeights::from_linear(vec![1.0; n]).unwrap()
    }

    fn judged(x: f64, log_evidence: f64) -> Judged {
        let light = light(90.0);
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let seen = seen(particles(2, x, &light), &light, &mut rng);
        let estimate = dominant_cluster(&[(Pose2::new(x, 0.0, 0.0), 1.0)]).unwrap();
        Judged { seen, estimate, log_evidence, hidden: 0.0 }
    }

    #[test]
    fn the_lead_is_over_the_next_best_place_that_is_left() {
        let apart = |hopeless| shortlist(vec![judged(1.0, -50.0), judged(0.0, -9.0)], 4, hopeless);
        assert_eq!(lead(&apart(100.0)), 41.0);
        assert_eq!(lead(&apart(40.0)), f64::INFINITY, "the other is hopeless");
        assert_eq!(
            lead(&shortlist(vec![judged(0.1, -50.0), judged(0.0, -9.0)], 4, 100.0)),
            f64::INFINITY,
            "one place"
        );
        assert!((share_of_first(&apart(100.0)) - 1.0 / (1.0 + (-41.0_f64).exp())).abs() < 1e-15);
    }

    #[test]
    fn a_refined_place_takes_half_of_the_weight_and_the_light_that_is_known() {
        let (learned, of_search) = (light(90.0), light(140.0));
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let refined = seen(particles(2, 0.2, &of_search), &of_search, &mut rng);

        let mut drifted = Hypothesis {
            particles: particles(4, 0.0, &learned),
            weights: equal(4),
            log_evidence: -7.0,
            hidden: 0.1,
        };
        drifted.join(&refined, &mut rng).unwrap();
        let there: f64 =
            drifted.poses().iter().filter(|(pose, _)| pose.x() > 0.1).map(|(_, weight)| weight).sum();
        assert!((there - 0.5).abs() < 1e-12 && drifted.particles.len() == 8);
        assert!(drifted.particles.iter().all(|p| Arc::ptr_eq(p.shared_conditional(), &learned)));
        assert_eq!(
            (drifted.log_evidence, drifted.hidden),
            (-7.0, 0.1),
            "what the frames said of the place stays"
        );
    }
}
