//! Landmarks that stand close together: told apart when they are two, made one when they are one.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use nalgebra::{Matrix2, Vector2};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::{
    CorrelatedNoise, EkfSlam, JointCompatibility, JointCompatibilityParams, KnownIdAssociation,
    LandmarkConfirmationParams, LandmarkId, LandmarkMerge, LandmarkMergingParams, NearestNeighbour,
    NearestNeighbourParams, Observation, ObservationOutcome, OdometryMotion, RangeBearing,
    RangeBearingSensor, SlamError, SlamParams,
};

const SEED: u64 = 11;

fn slam(sensor: RangeBearingSensor, merging: Option<LandmarkMergingParams>) -> EkfSlam<RangeBearingSensor> {
    let confirmation =
        LandmarkConfirmationParams { min_detections: 1, ..LandmarkConfirmationParams::default() };
    let params = SlamParams { confirmation, merging, ..SlamParams::default() };
    EkfSlam::new(sensor, params, Pose2::new(0.0, 0.0, 0.0)).unwrap()
}

fn unlabelled(range: f64, bearing: f64) -> Observation<RangeBearing> {
    Observation { label: None, measurement: RangeBearing::new(range, bearing) }
}

fn labelled(id: u32, range: f64, bearing: f64) -> Observation<RangeBearing> {
    Observation { label: Some(LandmarkId(id)), ..unlabelled(range, bearing) }
}

/// Two neighbours, all of each look turned by one error of a normal distribution; how many landmarks association makes of them.
fn n_landmarks_of_two(correlated_noise: Option<CorrelatedNoise>) -> usize {
    let sensor =
        RangeBearingSensor { bearing_sigma: 0.035, correlated_noise, ..RangeBearingSensor::default() };
    let mut slam = slam(sensor, None);
    let params =
        JointCompatibilityParams { one_detection_per_landmark: true, ..JointCompatibilityParams::default() };
    let mut rule = JointCompatibility::new(params).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    for _ in 0..30 {
        let common = 0.02 * common::normal(&mut rng);
        let mut bearing = |place: f64| place + common + 0.005 * common::normal(&mut rng);
        let look = [unlabelled(3.5, bearing(0.0)), unlabelled(3.5, bearing(0.057))];
        slam.update(&look, &mut rule).unwrap();
    }
    slam.n_landmarks()
}

#[test]
fn neighbours_are_told_apart_by_what_a_look_errs_in_common() {
    let errors = CorrelatedNoise {
        independent_bearing_sigma: 0.005,
        common_bearing_sigma: 0.02,
        ..CorrelatedNoise::default()
    };
    assert_eq!(n_landmarks_of_two(Some(errors)), 2);
    // The sightings are 0.057 rad apart as landmarks 0 and 1 are, but shifted by 0.04; landmarks 1 and 2 are nearer and 0.035 apart.
    // Joint NIS with a common error: 0.04² / 0.0004125 = 3.9 against 0.022² / (2 · 0.005²) = 9.7; independent: 7.5 against 0.7.
    let look = [unlabelled(3.5, 0.04), unlabelled(3.5, 0.097)];
    let pairings = |correlated_noise: CorrelatedNoise| {
        let sensor =
            RangeBearingSensor { correlated_noise: Some(correlated_noise), ..RangeBearingSensor::default() };
        let mut slam = slam(sensor, None);
        for (id, bearing) in [(0, 0.0), (1, 0.057), (2, 0.092)] {
            let (y, x) = f64::sin_cos(bearing);
            slam.insert(LandmarkId(id), Vector2::new(3.5 * x, 3.5 * y), Matrix2::identity() * 1e-6).unwrap();
        }
        let mut rule = JointCompatibility::new(JointCompatibilityParams::default()).unwrap();
        let report = slam.update(&look, &mut rule).unwrap();
        let of = |outcome: &ObservationOutcome<RangeBearing>| match outcome {
            ObservationOutcome::Accepted { landmark, .. } => Some(landmark.0),
            _ => None,
        };
        report.outcomes.iter().map(of).collect::<Vec<_>>()
    };
    let independent = CorrelatedNoise { independent_bearing_sigma: 0.0206, ..CorrelatedNoise::default() };
    assert_eq!(pairings(errors), [Some(0), Some(1)]);
    assert_eq!(pairings(independent), [Some(1), Some(2)]);
}

#[test]
fn second_detection_near_a_match_is_another_landmark() {
    let outcomes = |one_detection_per_landmark: bool, joint: bool| {
        let mut slam = slam(RangeBearingSensor::default(), None);
        slam.insert(LandmarkId(100), Vector2::new(2.0, 0.0), Matrix2::identity() * 1e-6).unwrap();
        let look = [unlabelled(2.0, 0.0), unlabelled(2.1, 0.0)]; // 0.1 m is two standard deviations
        let report = if joint {
            let params = JointCompatibilityParams {
                one_detection_per_landmark,
                ..JointCompatibilityParams::default()
            };
            slam.update(&look, &mut JointCompatibility::new(params).unwrap())
        } else {
            let params =
                NearestNeighbourParams { one_detection_per_landmark, ..NearestNeighbourParams::default() };
            slam.update(&look, &mut NearestNeighbour::new(params).unwrap())
        };
        report.unwrap().outcomes
    };
    for joint in [false, true] {
        assert_eq!(outcomes(true, joint)[1], ObservationOutcome::Initialized { landmark: LandmarkId(0) });
        assert_eq!(outcomes(false, joint)[1], ObservationOutcome::Ambiguous);
    }
}

#[test]
fn landmarks_below_the_least_distance_are_merged() {
    let merging = Some(LandmarkMergingParams { min_separation: 0.2, n_sigmas: 2.0 });
    let mut slam = slam(RangeBearingSensor::default(), merging);
    for _ in 0..20 {
        slam.update(&[labelled(1, 2.0, 0.0)], &mut KnownIdAssociation).unwrap();
    }
    let mut merges = Vec::new();
    for _ in 0..20 {
        merges.extend(slam.update(&[labelled(2, 2.05, 0.0)], &mut KnownIdAssociation).unwrap().merges);
        if !merges.is_empty() {
            break;
        }
    }
    assert_eq!(merges, [LandmarkMerge { kept: LandmarkId(1), removed: LandmarkId(2) }]); // the one that was seen more often stays
    assert_eq!((slam.n_landmarks(), slam.covariance().nrows()), (1, 5));
    let x = slam.landmark(LandmarkId(1)).unwrap().mean.x;
    assert!(x > 2.0 && x < 2.05, "{x}"); // between the two places it was taken for
}

#[test]
fn two_that_may_stand_apart_stay_two() {
    let merging = Some(LandmarkMergingParams { min_separation: 0.2, n_sigmas: 2.0 });
    let mut slam = slam(RangeBearingSensor::default(), merging);
    // 0.1 m apart, but seen once each: two standard deviations of their difference are 2 · √(2 · (0.05² + 0.02²)) = 0.15 m, and 0.1 m is left.
    let report =
        slam.update(&[labelled(1, 2.0, 0.0), labelled(2, 2.1, 0.0)], &mut KnownIdAssociation).unwrap();
    assert!(report.merges.is_empty());
    for _ in 0..200 {
        let report =
            slam.update(&[labelled(1, 2.0, 0.0), labelled(3, 2.25, 0.0)], &mut KnownIdAssociation).unwrap();
        assert!(report.merges.is_empty()); // 0.25 m apart, however certain
    }
}

#[test]
fn merge_equals_an_update_that_both_coincide() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks(6, &mut rng);
    let mut slam =
        EkfSlam::new(RangeBearingSensor::default(), SlamParams::default(), common::start()).unwrap();
    for step in common::drive(10, &landmarks, &mut rng) {
        slam.predict(&OdometryMotion::default(), &step.increment).unwrap();
        slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
    }
    let ids: Vec<LandmarkId> = slam.landmarks().map(|landmark| landmark.id).collect();
    let (a, b) = (slam.landmark(ids[0]).unwrap(), slam.landmark(ids[1]).unwrap());
    let before = slam.robot_covariance();
    assert!(slam.merge(a.id, b.id) && slam.landmark(b.id).is_none());
    let merged = slam.landmark(a.id).unwrap();
    assert!((merged.mean - b.mean).norm() < (a.mean - b.mean).norm()); // drawn towards the other
    assert!(merged.covariance.trace() < a.covariance.trace()); // a measurement more makes nothing less certain
    assert!(slam.robot_covariance().trace() <= before.trace() * (1.0 + 1e-9));
}

#[test]
fn impossible_merge_changes_nothing() {
    let mut slam = slam(RangeBearingSensor::default(), None);
    slam.update(&[labelled(1, 2.0, 0.0)], &mut KnownIdAssociation).unwrap();
    slam.add_anchor(LandmarkId(9), Vector2::new(2.0, 0.0)).unwrap();
    let before = format!("{slam:?}");
    for (kept, removed) in [(1, 1), (1, 2), (2, 1), (1, 9), (9, 1)] {
        assert!(!slam.merge(LandmarkId(kept), LandmarkId(removed)));
    }
    assert_eq!(format!("{slam:?}"), before);
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        for merging in [
            LandmarkMergingParams { min_separation: bad, n_sigmas: 2.0 },
            LandmarkMergingParams { min_separation: 0.1, n_sigmas: bad },
        ] {
            let params = SlamParams { merging: Some(merging), ..SlamParams::default() };
            let refused = EkfSlam::new(RangeBearingSensor::default(), params, Pose2::new(0.0, 0.0, 0.0));
            assert!(matches!(refused, Err(SlamError::Parameter { .. })));
        }
    }
}
