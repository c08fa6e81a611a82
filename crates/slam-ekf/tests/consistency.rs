//! Is the filter as sure as it should be? Over a short drive the standard filter is, and a check that cannot fail would be none.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

mod common;

use nalgebra::linalg::Cholesky;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Manifold;
use wayfix_gaussian_core::ChiSquaredBand;
use wayfix_slam_ekf::{EkfSlam, IncrementMotion, KnownIds, RangeBearingSensor, SlamParams};

const N_RUNS: u64 = 60;
const N_STEPS: usize = 30;

/// NEES of the pose at the end, averaged over the seeds 0..60; the filter takes every deviation times `belief`.
fn average_nees(belief: f64) -> f64 {
    let [x, _, turn] = common::ODOMETRY.map(|sigma| sigma * belief);
    let [range_sigma, bearing_sigma] = common::SIGHTING.map(|sigma| sigma * belief);
    let motion = IncrementMotion {
        translation_variance_per_meter: 0.0,
        heading_variance_per_meter: 0.0,
        heading_variance_per_radian: 0.0,
        translation_variance_per_step: x * x,
        heading_variance_per_step: turn * turn,
    };
    let sensor = RangeBearingSensor { range_sigma, range_sigma_per_meter: 0.0, bearing_sigma };
    let nees = |seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let landmarks = common::landmarks(12, &mut rng);
        let steps = common::drive(N_STEPS, &landmarks, &mut rng);
        let mut slam = EkfSlam::new(sensor, SlamParams::default(), common::start()).unwrap();
        for step in &steps {
            slam.predict(&motion, &step.increment).unwrap();
            slam.update(&step.observations, &mut KnownIds).unwrap();
        }
        let error = slam.robot().local(&steps.last().unwrap().truth);
        error.dot(&Cholesky::new(slam.robot_covariance()).unwrap().solve(&error))
    };
    (0..N_RUNS).map(nees).sum::<f64>() / N_RUNS as f64
}

#[test]
fn nees_over_sixty_runs_lies_in_its_band_and_not_when_the_noise_is_understated() {
    let band = ChiSquaredBand::for_average(3, N_RUNS as usize, 0.95).unwrap();
    let honest = average_nees(1.0);
    assert!(band.contains(honest), "{honest} outside {} to {}", band.low, band.high);
    let overconfident = average_nees(0.5);
    assert!(overconfident > 2.0 * band.high, "{overconfident}"); // variances of a quarter: NEES four times as large
}
