//! What enters the map, what leaves it, and what ties it to the world.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use approx::assert_abs_diff_eq;
use nalgebra::{Matrix2, Vector2};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_slam_ekf::{
    Association, DataAssociation, EkfSlam, KnownIdAssociation, LandmarkConfirmationParams, LandmarkId,
    NearestNeighbour, NearestNeighbourParams, Observation, ObservationOutcome, OdometryMotion, OutlierRule,
    RangeBearing, RangeBearingSensor, RelativePositionSensor, SlamError, SlamParams,
};

const SEED: u64 = 7;

fn slam(params: SlamParams) -> EkfSlam<RangeBearingSensor> {
    EkfSlam::new(RangeBearingSensor::default(), params, common::start()).unwrap()
}

fn seen(id: u32, range: f64, bearing: f64) -> Observation<RangeBearing> {
    Observation { label: Some(LandmarkId(id)), measurement: RangeBearing::new(range, bearing) }
}

/// Sum of the position variances of the robot after a lap.
fn uncertainty_after_a_lap(anchored: bool, n_steps: usize) -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks(10, &mut rng);
    let steps = common::drive(n_steps, &landmarks, &mut rng);
    let start = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(0.25, 0.25, 0.01));
    let sensor = RangeBearingSensor::default();
    let mut slam =
        EkfSlam::with_start_covariance(sensor, SlamParams::default(), common::start(), start).unwrap();
    if anchored {
        for (id, [x, y]) in landmarks.iter().enumerate().take(2) {
            slam.add_anchor(LandmarkId(id as u32), Vector2::new(*x, *y)).unwrap();
        }
    }
    for step in &steps {
        slam.predict(&OdometryMotion::default(), &step.increment).unwrap();
        slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
    }
    slam.robot_covariance().fixed_view::<2, 2>(0, 0).trace()
}

#[test]
fn an_anchor_ties_the_map_to_the_world_and_nothing_else_does() {
    // A robot that starts uncertain by 0.5 m either way can never know its place in the world better without an anchor.
    assert!(uncertainty_after_a_lap(false, 80) > 0.5 * 0.99);
    let anchored = uncertainty_after_a_lap(true, 80);
    assert!(anchored < 2.0 * 0.05_f64.powi(2), "{anchored}"); // two sightings of 5 cm beat it
}

#[test]
fn the_estimate_moves_to_the_truth_with_both_sensors() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks(10, &mut rng);
    let steps = common::drive(76, &landmarks, &mut rng); // one lap
    let mut by_range = slam(SlamParams::default());
    let mut by_position =
        EkfSlam::new(RelativePositionSensor { sigma: 0.06 }, SlamParams::default(), common::start()).unwrap();
    let mut dead_reckoning = common::start();
    for step in &steps {
        dead_reckoning = dead_reckoning.retract(&common::start().local(&common::start().retract(
            &nalgebra::Vector3::new(step.increment.x(), step.increment.y(), step.increment.heading()),
        )));
        by_range.predict(&OdometryMotion::default(), &step.increment).unwrap();
        by_position.predict(&OdometryMotion::default(), &step.increment).unwrap();
        by_range.update(&step.observations, &mut KnownIdAssociation).unwrap();
        let positions: Vec<_> = step
            .observations
            .iter()
            .map(|seen| Observation { label: seen.label, measurement: seen.measurement.point() })
            .collect();
        by_position.update(&positions, &mut KnownIdAssociation).unwrap();
    }
    let truth = steps.last().unwrap().truth;
    let distance = |pose: &Pose2<f64>| (pose.translation - truth.translation).norm();
    let drift = distance(&dead_reckoning);
    for (name, pose) in [("range", by_range.robot()), ("position", by_position.robot())] {
        assert!(
            distance(pose) < 0.1 && distance(pose) < 0.5 * drift,
            "{name}: {} of {drift}",
            distance(pose)
        );
    }
}

#[test]
fn what_is_removed_leaves_the_marginal_of_the_rest() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks(6, &mut rng);
    let mut slam = slam(SlamParams::default());
    for step in common::drive(10, &landmarks, &mut rng) {
        slam.predict(&OdometryMotion::default(), &step.increment).unwrap();
        slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
    }
    let before: Vec<_> = slam.landmarks().filter(|landmark| landmark.id != LandmarkId(1)).collect();
    let (robot, n) = (slam.robot_covariance(), slam.covariance().nrows());
    assert!(
        slam.landmark(LandmarkId(1)).is_some() && slam.remove(LandmarkId(1)) && !slam.remove(LandmarkId(1))
    );
    assert_eq!(slam.landmarks().collect::<Vec<_>>(), before);
    assert_eq!((slam.robot_covariance(), slam.covariance().nrows()), (robot, n - 2));
}

#[test]
fn false_first_detection_is_replaced_and_unseen_one_removed() {
    let confirmation = LandmarkConfirmationParams {
        min_detections: 2,
        max_consecutive_misses: Some(3),
        ..LandmarkConfirmationParams::default()
    };
    let mut slam = slam(SlamParams { confirmation, ..SlamParams::default() });
    let mut look = |observations: &[Observation<RangeBearing>]| {
        slam.update(observations, &mut KnownIdAssociation).unwrap().outcomes
    };
    assert_eq!(
        look(&[seen(1, 9.0, 1.0), seen(2, 3.0, 0.0)])[0],
        ObservationOutcome::Initialized { landmark: LandmarkId(1) }
    );
    assert_eq!(look(&[seen(1, 2.0, 0.5)])[0], ObservationOutcome::Restarted { landmark: LandmarkId(1) });
    assert!(matches!(look(&[seen(1, 2.0, 0.5)])[0], ObservationOutcome::Accepted { .. }));
    look(&[]);
    assert_eq!(slam.n_tentative(), 1); // landmark 2, seen once, three looks ago
    slam.update(&[], &mut KnownIdAssociation).unwrap();
    assert_eq!((slam.n_landmarks(), slam.n_tentative()), (1, 0));
    let confirmed = slam.landmark(LandmarkId(1)).unwrap();
    assert_abs_diff_eq!(slam.robot().inverse_transform(&confirmed.mean).norm(), 2.0, epsilon = 0.05);
}

#[test]
fn an_identity_seen_twice_in_one_look_counts_once() {
    let mut slam = slam(SlamParams::default());
    let report = slam.update(&[seen(1, 2.0, 0.0), seen(1, 2.5, 0.1)], &mut KnownIdAssociation).unwrap();
    assert_eq!(report.outcomes[1], ObservationOutcome::Duplicate { landmark: LandmarkId(1) });
    assert_eq!(report.n_rejected(), 1);
}

#[test]
fn outliers_are_rejected_or_count_little_and_say_so() {
    let confirmation =
        LandmarkConfirmationParams { min_detections: 1, ..LandmarkConfirmationParams::default() };
    for outliers in [OutlierRule::Reject, OutlierRule::Downweight] {
        let mut slam = slam(SlamParams { outlier_rule: outliers, confirmation, ..SlamParams::default() });
        slam.update(&[seen(1, 2.0, 0.0)], &mut KnownIdAssociation).unwrap();
        let before = slam.clone();
        let report = slam.update(&[seen(1, 4.0, 0.0)], &mut KnownIdAssociation).unwrap();
        let moved = (slam.landmark(LandmarkId(1)).unwrap().mean
            - before.landmark(LandmarkId(1)).unwrap().mean)
            .norm();
        match &report.outcomes[0] {
            ObservationOutcome::Rejected { innovation, threshold, .. } => {
                assert!(outliers == OutlierRule::Reject && innovation.nis > *threshold && moved == 0.0);
            }
            ObservationOutcome::Accepted { noise_scale, .. } => {
                assert!(outliers == OutlierRule::Downweight && *noise_scale > 10.0);
                assert!(moved < 0.1, "2 m off moved it by {moved} m; unweighted it would be 1 m");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn nearest_neighbour_pairs_once_and_skips_ambiguous() {
    let mut rule = NearestNeighbour::new(NearestNeighbourParams::default()).unwrap();
    let confirmation =
        LandmarkConfirmationParams { min_detections: 1, ..LandmarkConfirmationParams::default() };
    let mut slam = slam(SlamParams { confirmation, ..SlamParams::default() });
    let unlabelled =
        |range, bearing| Observation { label: None, measurement: RangeBearing::new(range, bearing) };
    slam.update(&[unlabelled(2.0, 0.0)], &mut rule).unwrap();
    // The sighting and its rival differ from the landmark by 0.01 m and 0.05 m; a third by 0.3 m, between the thresholds (0.26 and 0.45 m).
    let outcomes = slam
        .update(&[unlabelled(2.05, 0.0), unlabelled(2.01, 0.0), unlabelled(2.3, 0.0)], &mut rule)
        .unwrap()
        .outcomes;
    assert!(
        matches!(
            outcomes[..],
            [
                ObservationOutcome::Ambiguous,
                ObservationOutcome::Accepted { .. },
                ObservationOutcome::Ambiguous
            ]
        ),
        "{outcomes:?}"
    );
    assert_eq!(slam.n_landmarks(), 1);
    slam.update(&[unlabelled(3.5, 0.0)], &mut rule).unwrap();
    assert_eq!(slam.n_landmarks(), 2);
}

#[test]
fn bad_parameters_and_landmarks_are_typed_errors() {
    let start = common::start();
    for gate_probability in [0.0, 1.0, 2.0, f64::NAN] {
        let params = SlamParams { gate_probability, ..SlamParams::default() };
        assert!(matches!(
            EkfSlam::new(RangeBearingSensor::default(), params, start),
            Err(SlamError::Parameter { .. })
        ));
    }
    for tentative_restart_nis in [0.0, -1.0, f64::NAN] {
        let confirmation =
            LandmarkConfirmationParams { tentative_restart_nis, ..LandmarkConfirmationParams::default() };
        let params = SlamParams { confirmation, ..SlamParams::default() };
        assert!(
            EkfSlam::new(RangeBearingSensor::default(), params, start).is_err(),
            "{tentative_restart_nis}"
        );
    }
    assert!(
        NearestNeighbour::new(NearestNeighbourParams {
            gate_nis: 9.0,
            new_landmark_nis: 3.0,
            ..NearestNeighbourParams::default()
        })
        .is_err()
    );
    let mut slam = slam(SlamParams::default());
    let nan = Vector2::new(f64::NAN, 0.0);
    assert_eq!(slam.add_anchor(LandmarkId(1), nan), Err(SlamError::NotFinite { what: "landmark" }));
    let indefinite = Matrix2::new(1.0, 2.0, 2.0, 1.0);
    assert!(matches!(
        slam.insert(LandmarkId(1), Vector2::zeros(), indefinite),
        Err(SlamError::NotACovariance { .. })
    ));
    slam.insert(LandmarkId(1), Vector2::zeros(), Matrix2::identity()).unwrap();
    assert_eq!(
        slam.add_anchor(LandmarkId(1), Vector2::zeros()),
        Err(SlamError::LandmarkExists(LandmarkId(1)))
    );
}

/// A rule that says what it is told, whatever it sees.
struct Says(Vec<Association>);

impl DataAssociation<RangeBearingSensor> for Says {
    fn associate(
        &mut self,
        _: &EkfSlam<RangeBearingSensor>,
        _: &[Observation<RangeBearing>],
    ) -> Vec<Association> {
        self.0.clone()
    }
}

#[test]
fn an_association_that_breaks_its_law_harms_nothing() {
    let mut slam = slam(SlamParams::default());
    slam.add_anchor(LandmarkId(7), Vector2::new(1.0, 1.0)).unwrap();
    slam.update(&[seen(1, 2.0, 0.0)], &mut KnownIdAssociation).unwrap();
    let before = format!("{slam:?}");
    let error = slam.update(&[seen(1, 2.0, 0.0)], &mut Says(Vec::new())).unwrap_err();
    assert_eq!(error, SlamError::Dimension { what: "list of associations", expected: 1, got: 0 });
    assert_eq!(format!("{slam:?}"), before);

    let anchor_again = vec![Association::New(LandmarkId(7)), Association::Matched(LandmarkId(99))];
    let report = slam.update(&[seen(1, 2.0, 0.0), seen(1, 2.0, 0.0)], &mut Says(anchor_again)).unwrap();
    assert_eq!(report.outcomes, [ObservationOutcome::Unusable, ObservationOutcome::Unusable]);
    assert_eq!(slam.anchors().count(), 1);
}
