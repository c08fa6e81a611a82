//! A filter that stopped and went on is the filter that never stopped, and no snapshot is taken on trust.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use nalgebra::Vector2;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::{
    EkfSlam, LandmarkConfirmationParams, LandmarkId, LinearizationPoint, NearestNeighbour,
    NearestNeighbourParams, OdometryMotion, RangeBearingSensor, SlamError, SlamParams, SlamSnapshot,
};

const SEED: u64 = 11;

type Saved = SlamSnapshot<Pose2<f64>, Vector2<f64>>;

/// Landmarks that nobody told apart, some of which are forgotten again: the filter's whole memory is at work.
fn params(linearization: LinearizationPoint) -> SlamParams {
    let confirmation = LandmarkConfirmationParams {
        min_detections: 4,
        max_consecutive_misses: Some(2),
        ..LandmarkConfirmationParams::default()
    };
    SlamParams { confirmation, linearization_point: linearization, ..SlamParams::default() }
}

fn rule() -> NearestNeighbour {
    NearestNeighbour::new(NearestNeighbourParams::default()).unwrap()
}

fn resume(snapshot: Saved) -> Result<EkfSlam<RangeBearingSensor>, SlamError> {
    EkfSlam::resume(RangeBearingSensor::default(), params(LinearizationPoint::Newest), snapshot)
}

/// A drive among unlabelled points and one anchor, stopped and resumed before each step that `stops` names.
fn drive(stops: &[usize], linearization: LinearizationPoint) -> (Saved, u32) {
    let (sensor, params) = (RangeBearingSensor::default(), params(linearization));
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks(30, &mut rng);
    let steps = common::drive(90, &landmarks, &mut rng);
    let mut slam = EkfSlam::new(sensor, params, common::start()).unwrap();
    slam.add_anchor(LandmarkId(1000), Vector2::from(landmarks[0])).unwrap();
    let mut rule = rule();
    for (k, step) in steps.iter().enumerate() {
        if stops.contains(&k) {
            slam = EkfSlam::resume(sensor, params, slam.snapshot()).unwrap();
            rule = self::rule().numbering_from(rule.next_id());
        }
        slam.predict(&OdometryMotion::default(), &step.increment).unwrap();
        slam.update(&step.observations, &mut rule).unwrap();
    }
    (slam.snapshot(), rule.next_id())
}

#[test]
fn a_filter_that_stopped_goes_on_bit_for_bit() {
    for linearization in
        [LinearizationPoint::Newest, LinearizationPoint::FirstEstimates, LinearizationPoint::Invariant]
    {
        let (whole, next_id) = drive(&[], linearization);
        assert!(whole.landmarks.len() > 10, "a map");
        let n_numbered = next_id as usize;
        assert!(n_numbered > whole.landmarks.len(), "some were forgotten, and their numbers are used up");
        for stops in [vec![45], vec![1, 2, 3], (0..90).collect()] {
            let resumed = drive(&stops, linearization);
            assert_eq!(resumed, (whole.clone(), next_id), "{linearization:?} stopped before {stops:?}");
        }
    }
}

#[test]
fn what_cannot_be_a_filter_is_refused() {
    let (good, _) = drive(&[], LinearizationPoint::Newest);
    let n = 3 + 2 * good.landmarks.len();
    assert!(resume(good.clone()).is_ok());
    let refused = |spoil: &dyn Fn(&mut Saved)| {
        let mut snapshot = good.clone();
        spoil(&mut snapshot);
        resume(snapshot).expect_err("spoiled")
    };
    let not_a_number = [f64::NAN, f64::INFINITY, 1e300];
    for number in not_a_number {
        assert!(matches!(refused(&|s| s.covariance[7] = number), SlamError::NotFinite { .. }), "{number}");
    }
    assert!(matches!(refused(&|s| s.robot = Pose2::new(0.0, f64::NAN, 0.0)), SlamError::NotFinite { .. }));
    assert!(matches!(refused(&|s| s.landmarks[3].mean.x = f64::NAN), SlamError::NotFinite { .. }));
    assert!(matches!(refused(&|s| s.anchors[0].1.x = f64::INFINITY), SlamError::NotFinite { .. }));
    assert!(matches!(refused(&|s| s.landmarks[1].id = s.landmarks[0].id), SlamError::LandmarkExists(_)));
    assert!(matches!(refused(&|s| s.anchors[0].0 = s.landmarks[0].id), SlamError::LandmarkExists(_)));
    assert!(matches!(refused(&|s| s.landmarks[0].last_seen = s.n_updates + 1), SlamError::Parameter { .. }));
    assert!(matches!(refused(&|s| s.landmarks[0].n_detections = usize::MAX), SlamError::Parameter { .. }));
    assert!(matches!(refused(&|s| s.n_updates = usize::MAX), SlamError::Parameter { .. }));
    assert!(matches!(refused(&|s| s.covariance.truncate(9)), SlamError::Dimension { got: 9, .. }));
    assert!(matches!(refused(&|s| s.covariance.push(0.0)), SlamError::Dimension { .. }));
    assert!(matches!(refused(&|s| s.landmarks.clear()), SlamError::Dimension { expected: 6, .. }));
    assert!(matches!(refused(&|s| s.covariance[0] = -1.0), SlamError::NotACovariance { .. }));
    // The entry (1, 0) at twice the larger variance: a correlation above 1.
    let larger = good.covariance[0].max(good.covariance[n]);
    assert!(matches!(refused(&|s| s.covariance[1] = 2.0 * larger), SlamError::NotACovariance { .. }));
}
