//! The monitor against the table in the book, and a kidnapped robot.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its particles has failed")]

use rand::{RngExt as _, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_particle::{InjectionMonitor, InjectionParams, ParticleError, ParticleSet, Systematic};

const SEED: u64 = 20_261_121;

/// [Thrun, Burgard & Fox 2005, Table 8.3] in plain numbers, started at the first likelihood.
#[test]
fn logarithms_give_the_shares_of_the_table() {
    let params = InjectionParams { slow: 0.05, fast: 0.3 };
    let mut monitor = InjectionMonitor::new(params).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let (mut slow, mut fast) = (None, None);
    for _ in 0..500 {
        let likelihood = rng.random::<f64>().powi(12);
        let average = |average: &mut Option<f64>, alpha: f64| {
            let before = average.unwrap_or(likelihood);
            *average.insert(before + alpha * (likelihood - before))
        };
        let share = (1.0 - average(&mut fast, params.fast) / average(&mut slow, params.slow)).max(0.0);
        // The table's own difference from one is good to a few roundings.
        assert!((monitor.observe(likelihood.ln()).unwrap() - share).abs() < 1e-12);
    }
}

#[test]
fn extremes_have_an_answer() {
    let mut monitor = InjectionMonitor::new(InjectionParams::default()).unwrap();
    assert_eq!(monitor.share(), 0.0);
    assert_eq!(monitor.observe(f64::NEG_INFINITY), Ok(1.0), "nothing explained from the start");
    assert_eq!(monitor.observe(-1e300), Ok(0.0), "better than ever");
    let before = monitor;
    assert!(matches!(monitor.observe(f64::NAN), Err(ParticleError::LogWeight { .. })));
    assert!(matches!(monitor.observe(f64::INFINITY), Err(ParticleError::LogWeight { .. })));
    assert_eq!(monitor, before);
    for _ in 0..100_000 {
        let share = monitor.observe(f64::NEG_INFINITY).unwrap();
        assert!((0.0..=1.0).contains(&share));
    }
    for (slow, fast) in [(0.0, 0.1), (0.2, 0.1), (0.1, 1.1), (f64::NAN, 0.1), (0.1, f64::NAN)] {
        assert!(InjectionMonitor::new(InjectionParams { slow, fast }).is_err());
    }
}

/// Steps after which the particles are where the robot is, having been carried off from 10 to 90; `None` when they never are.
fn recovery(inject: bool, seed: u64) -> Option<usize> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut particles = ParticleSet::from_fn(300, |rng| rng.random_range(9.0..11.0), &mut rng).unwrap();
    let mut monitor = InjectionMonitor::new(InjectionParams { slow: 0.01, fast: 0.3 }).unwrap();
    for step in 0..120 {
        let truth: f64 = if step < 40 { 10.0 } else { 90.0 };
        particles.propagate(|x, rng| *x += rng.random_range(-0.5..0.5), &mut rng);
        // A measurement may be a mistake, with likelihood e⁻²⁰.
        particles.reweigh(|x| (-0.5 * (x - truth).powi(2)).max(-20.0)).unwrap();
        let share = monitor.observe(particles.normalize().unwrap().log_likelihood).unwrap();
        particles.resample(&Systematic, 300, &mut rng).unwrap();
        if inject {
            particles.inject(share, |rng| rng.random_range(0.0..100.0), &mut rng).unwrap();
        }
        let near = particles.states().iter().filter(|x| (**x - truth).abs() < 3.0).count();
        if step >= 40 && near > 150 {
            return Some(step - 40);
        }
    }
    None
}

#[test]
fn kidnapped_robot_relocalizes_only_with_injection() {
    for seed in SEED..SEED + 20 {
        // The first step injects a share 0.3; 90 particles, one in 17 near by: some fail to hit with probability 0.004 a step.
        let steps = recovery(true, seed);
        assert!(steps.is_some_and(|steps| steps < 20), "seed {seed}: {steps:?}");
        // 80 m in 80 steps of 0.29 m rms each is 31 sigma away.
        assert_eq!(recovery(false, seed), None, "seed {seed}");
    }
}
