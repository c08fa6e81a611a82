//! Bad input gets a typed error, and nothing changes.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its particles has failed")]

use approx::assert_abs_diff_eq;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Angle;
use wayfix_particle::{
    MultinomialResampler, NormalizedWeights, ParticleChunkRng, ParticleError, ParticleSet, Resampler,
    ResidualResampler, StratifiedResampler, SystematicResampler,
};

const BAD: [f64; 2] = [f64::NAN, f64::INFINITY];
const NONE: f64 = f64::NEG_INFINITY;

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(20_261_121)
}

/// 200 particles, more than one chunk.
fn particles() -> ParticleSet<f64> {
    let mut particles = ParticleSet::new((0..200).map(f64::from).collect()).unwrap();
    particles.reweigh(|x| -0.01 * x).unwrap();
    particles
}

#[test]
fn a_set_needs_particles_and_as_many_weights() {
    assert_eq!(ParticleSet::<f64>::new(vec![]), Err(ParticleError::NoParticles));
    assert_eq!(ParticleSet::from_fn(0, |_| 0.0, &mut rng()), Err(ParticleError::NoParticles));
    assert_eq!(ParticleSet::<f64>::from_log_weights(vec![], vec![]), Err(ParticleError::NoParticles));
    assert_eq!(
        ParticleSet::from_log_weights(vec![1.0], vec![0.0, 0.0]),
        Err(ParticleError::Lengths { states: 1, log_weights: 2 })
    );
    for bad in BAD {
        let refused = ParticleSet::from_log_weights(vec![1.0, 2.0], vec![NONE, bad]);
        assert!(matches!(refused, Err(ParticleError::LogWeight { index: 1, .. })));
    }
}

#[test]
fn more_particles_than_memory_are_refused() {
    let requested = usize::MAX / 2;
    let too_many = ParticleError::TooMany { requested };
    assert_eq!(ParticleSet::from_fn(requested, |_| 0.0, &mut rng()), Err(too_many.clone()));
    let mut set = particles();
    assert_eq!(set.resample(&SystematicResampler, requested, &mut rng()), Err(too_many.clone()));
    assert_eq!(set.resample(&SystematicResampler, 0, &mut rng()), Err(ParticleError::NoParticles));
    assert_eq!(set, particles());
    let weights = NormalizedWeights::from_linear(vec![1.0]).unwrap();
    assert_eq!(StratifiedResampler.ancestors(&weights, requested, &mut rng()), Err(too_many));
}

#[test]
fn a_resampler_that_invents_ancestors_is_refused() {
    struct OffByOne;
    impl Resampler for OffByOne {
        fn fill<R: Rng + ?Sized>(&self, weights: &NormalizedWeights, ancestors: &mut [usize], _: &mut R) {
            ancestors.fill(weights.as_slice().len());
        }
    }
    let mut set = particles();
    let refused = ParticleError::Ancestor { ancestor: 200, n_particles: 200 };
    assert_eq!(set.resample(&OffByOne, 10, &mut rng()), Err(refused));
    assert_eq!(set, particles());
}

#[test]
fn a_bad_likelihood_is_refused_with_its_particle() {
    for bad in BAD {
        let mut set = particles();
        let likelihood = |x: &f64| if *x >= 150.0 { bad } else { -1.0 };
        let refused = [set.reweigh(likelihood), set.correct_with(|| (), |(), x| likelihood(x)).map(|_| ())];
        for error in refused.map(Result::unwrap_err) {
            assert!(matches!(error, ParticleError::LogWeight { index: 150, .. }), "{error}");
        }
        let step = |(): &mut (), x: &mut f64, _: &mut ParticleChunkRng| {
            *x += 1.0;
            Ok(likelihood(x))
        };
        let advanced: Result<(), ParticleError> = set.advance_with(|| (), step, &mut rng());
        assert!(matches!(advanced, Err(ParticleError::LogWeight { index: 149, .. })));
        assert_eq!(set, particles());
    }
}

#[test]
fn log_weights_that_add_up_to_infinity_are_refused() {
    let mut set = ParticleSet::from_log_weights(vec![1.0], vec![f64::MAX]).unwrap();
    assert!(matches!(set.reweigh(|_| f64::MAX), Err(ParticleError::LogWeight { index: 0, .. })));
    assert_eq!(set.log_weights(), [f64::MAX]);
    assert_eq!(set.normalize().unwrap().log_likelihood, f64::MAX);
    assert_eq!(set.log_weights(), [0.0]);
}

#[test]
fn impossible_particles_are_legal_until_all_are() {
    let mut set = particles();
    set.reweigh(|x| if *x == 7.0 { 0.0 } else { NONE }).unwrap();
    assert_eq!((set.effective_sample_size(), *set.heaviest()), (1.0, 7.0));
    let survivor = set.clone();

    let none_left = ParticleError::NoWeight { count: 200 };
    assert_eq!(set.correct_with(|| (), |(), _| NONE), Err(none_left.clone()));
    assert_eq!(set, survivor, "a measurement that nobody explains leaves no trace");

    set.reweigh(|_| NONE).unwrap();
    let dead = set.clone();
    assert_eq!(set.normalize(), Err(none_left.clone()));
    assert_eq!(set.resample(&SystematicResampler, 10, &mut rng()), Err(none_left.clone()));
    assert_eq!(set.moments(|x| Angle::new(*x)), Err(none_left));
    assert_eq!(set.effective_sample_size(), 0.0);
    assert_eq!(set, dead, "nothing resets the weights on its own");
    set.reset_weights();
    assert_abs_diff_eq!(set.effective_sample_size(), 200.0, epsilon = 1e-9);
}

#[test]
fn one_particle_takes_all_in_every_scheme() {
    let weights = NormalizedWeights::from_log(&[NONE, -1e308, NONE]).unwrap();
    assert_eq!(SystematicResampler.ancestors(&weights, 5, &mut rng()).unwrap(), [1; 5]);
    assert_eq!(StratifiedResampler.ancestors(&weights, 5, &mut rng()).unwrap(), [1; 5]);
    assert_eq!(ResidualResampler.ancestors(&weights, 5, &mut rng()).unwrap(), [1; 5]);
    assert_eq!(MultinomialResampler.ancestors(&weights, 5, &mut rng()).unwrap(), [1; 5]);
    assert!(MultinomialResampler.ancestors(&weights, 0, &mut rng()).unwrap().is_empty());
    assert!(ResidualResampler.ancestors(&weights, 0, &mut rng()).unwrap().is_empty());
}

#[test]
fn a_state_that_is_not_finite_has_no_mean() {
    let set = ParticleSet::new(vec![Angle::new(1.0), Angle::new(f64::NAN)]).unwrap();
    assert!(matches!(set.moments(|x| *x), Err(ParticleError::Moments(_))));
}
