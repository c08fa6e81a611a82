//! Landmarks that leave the state: what stays, what gets cheaper, and what it costs in honesty.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use nalgebra::linalg::Cholesky;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Manifold;
use wayfix_gaussian_core::ChiSquaredBand;
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkId, OdometryMotion, RangeBearingSensor, SlamParams,
};

const N_RUNS: u64 = 60;

/// Two laps on a circle of 3 m, landmarks retired after so many revisions.
fn drive(seed: u64, retire_after: Option<usize>) -> (EkfSlam<RangeBearingSensor>, f64) {
    let [x, _, turn] = common::ODOMETRY;
    let motion = OdometryMotion {
        translation_variance_per_meter: 0.0,
        heading_variance_per_meter: 0.0,
        heading_variance_per_radian: 0.0,
        translation_variance_per_step: x * x,
        heading_variance_per_step: turn * turn,
    };
    let [range_sigma, bearing_sigma] = common::SIGHTING;
    let sensor = RangeBearingSensor { range_sigma, bearing_sigma, ..RangeBearingSensor::default() };
    let params = SlamParams { retire_after, ..SlamParams::default() };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let landmarks = common::landmarks(12, &mut rng);
    let steps = common::drive(150, &landmarks, &mut rng);
    let mut slam = EkfSlam::new(sensor, params, common::start()).unwrap();
    for step in &steps {
        slam.predict(&motion, &step.increment).unwrap();
        slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
    }
    let error = slam.robot().local(&steps.last().unwrap().truth);
    let nees = error.dot(&Cholesky::new(slam.robot_covariance()).unwrap().solve(&error));
    (slam, nees)
}

#[test]
fn a_retired_landmark_leaves_the_state_and_stays_in_the_map() {
    let (kept, _) = drive(1, None);
    let (slam, _) = drive(1, Some(50));
    assert!(slam.n_retired() > 0);
    assert_eq!(slam.covariance().nrows(), kept.covariance().nrows() - 2 * slam.n_retired());
    assert_eq!(slam.n_landmarks(), kept.n_landmarks());
    let ids = |slam: &EkfSlam<_>| slam.landmarks().map(|landmark| landmark.id).collect::<Vec<_>>();
    assert_eq!(ids(&slam), ids(&kept));
    let retired = (0..12).map(LandmarkId).filter(|id| slam.landmark(*id).is_some()).count();
    assert_eq!(retired, slam.n_landmarks() + slam.n_tentative());
}

#[test]
fn its_sightings_still_hold_the_robot() {
    // Sixty steps of odometry alone would leave 0.02 m √60 = 0.15 m; sightings of 5 cm at 7 m and less hold it to centimetres.
    let (slam, _) = drive(2, Some(20));
    assert_eq!(
        slam.n_tentative() + slam.n_landmarks() - slam.n_retired(),
        (slam.covariance().nrows() - 3) / 2
    );
    assert!(slam.robot_covariance().m11.sqrt() < 0.05, "{}", slam.robot_covariance());
}

#[test]
fn a_snapshot_keeps_the_retired() {
    let (slam, _) = drive(3, Some(30));
    let snapshot = slam.snapshot();
    assert_eq!(snapshot.retired.len(), slam.n_retired());
    let params = SlamParams { retire_after: Some(30), ..SlamParams::default() };
    let resumed = EkfSlam::resume(*slam.model(), params, snapshot.clone()).unwrap();
    assert_eq!(resumed.snapshot(), snapshot);
    let mut spoiled = snapshot;
    spoiled.retired[0].covariance[0] = -1.0;
    assert!(EkfSlam::resume(*slam.model(), params, spoiled).is_err());
}

#[test]
fn retirement_makes_the_filter_too_sure_of_itself() {
    let average =
        |retire_after| (0..N_RUNS).map(|seed| drive(seed, retire_after).1).sum::<f64>() / N_RUNS as f64;
    let (kept, after_50, after_5) = (average(None), average(Some(50)), average(Some(5)));
    println!(
        "NEES of 3 over {N_RUNS} runs: kept {kept:.2}, retired after 50 {after_50:.2}, after 5 {after_5:.2}"
    );
    let band = ChiSquaredBand::for_average(3, N_RUNS as usize, 0.95).unwrap();
    assert!(band.contains(kept), "{kept} outside {} to {}", band.low, band.high);
    for nees in [after_50, after_5] {
        assert!(nees > band.high, "documented as too sure, and is not: {nees}");
    }
}
