//! Anchors without the truth: the first landmarks, or landmarks that are given with or without a covariance.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use std::collections::BTreeSet;

use approx::assert_abs_diff_eq;
use nalgebra::Vector2;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::{
    AnchorError, AnchorParams, EkfSlam, KnownIdAssociation, LandmarkId, Observation, OdometryMotion,
    RangeBearing, RangeBearingSensor, SlamError, SlamParams,
};

fn empty(params: SlamParams) -> EkfSlam<RangeBearingSensor> {
    EkfSlam::new(RangeBearingSensor::default(), params, common::start()).unwrap()
}

fn anchor(id: u32, covariance: Option<[[f64; 2]; 2]>) -> AnchorParams<[f64; 2]> {
    AnchorParams { id, at: [1.0, 2.0], covariance }
}

#[test]
fn the_first_landmark_becomes_the_anchor_and_stays_it() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let landmarks = common::landmarks(12, &mut rng);
    let steps = common::drive(80, &landmarks, &mut rng);
    let mut slam = empty(SlamParams { anchor_first: 1, ..SlamParams::default() });
    let mut fixed = None;
    for step in &steps {
        slam.predict(&OdometryMotion::default(), &step.increment).unwrap();
        slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
        let anchors: Vec<(LandmarkId, Vector2<f64>)> =
            slam.anchors().map(|(id, place)| (id, *place)).collect();
        assert!(anchors.len() <= 1);
        fixed = fixed.or(anchors.first().copied());
        assert_eq!(fixed, anchors.first().copied(), "it moves no more");
    }
    let (id, place) = fixed.unwrap();
    let [x, y] = landmarks[id.0 as usize];
    // Seen from within 7 m, 5 cm and 0.01 rad each: four standard deviations.
    assert!((place - Vector2::new(x, y)).norm() < 4.0 * (0.05_f64.powi(2) + 0.07_f64.powi(2)).sqrt());
    assert!(slam.landmark(id).is_none() && slam.contains(id));
}

#[test]
fn given_anchors_enter_exactly_or_with_their_covariance() {
    let mut slam = empty(SlamParams::default());
    let anchors = [anchor(4, None), anchor(9, Some([[0.04, 0.01], [0.01, 0.09]]))];
    slam.add_anchors(&anchors, Some(&BTreeSet::from([4, 9, 11])), Vector2::from).unwrap();
    assert_eq!(slam.anchors().map(|(id, _)| id.0).collect::<Vec<_>>(), [4]);
    assert_eq!(slam.landmark(LandmarkId(9)).unwrap().covariance.m12, 0.01);
}

#[test]
fn unknown_ids_and_singular_covariances_are_typed_errors() {
    let seen = BTreeSet::from([4]);
    let refused = |anchors: &[AnchorParams<[f64; 2]>]| {
        empty(SlamParams::default()).add_anchors(anchors, Some(&seen), Vector2::from).unwrap_err()
    };
    assert_eq!(refused(&[anchor(5, None)]), AnchorError::UnknownId { id: 5, n_seen: 1 });
    let singular = [
        ([[1.0, 1.0], [1.0, 1.0]], 0.0), // [[a, b], [b, a]] has the eigenvalues a + b and a − b
        ([[1.0, 2.0], [2.0, 1.0]], -1.0),
        ([[0.0, 0.0], [0.0, 1.0]], 0.0),
    ];
    for (covariance, smallest) in singular {
        let error = refused(&[anchor(4, Some(covariance))]);
        let AnchorError::Landmark { id: 4, source: SlamError::NotACovariance { value, .. } } = error else {
            panic!("{error}")
        };
        assert_abs_diff_eq!(value, smallest, epsilon = 1e-12);
    }
    let twice = refused(&[anchor(4, None), anchor(4, None)]);
    assert_eq!(twice, AnchorError::Landmark { id: 4, source: SlamError::LandmarkExists(LandmarkId(4)) });
    let nowhere = AnchorParams { at: [f64::NAN, 0.0], ..anchor(4, None) };
    let source = SlamError::NotFinite { what: "landmark" };
    assert_eq!(refused(&[nowhere]), AnchorError::Landmark { id: 4, source });
}

/// [Andrade-Cetto 2005, Sec. 2.2]: "revised more than 50 times".
#[test]
fn retirement_comes_with_the_revision_after_the_fiftieth() {
    let start = Pose2::new(0.0, 0.0, 0.0);
    let params = SlamParams { retire_after: Some(50), ..SlamParams::default() };
    let mut slam = EkfSlam::new(RangeBearingSensor::default(), params, start).unwrap();
    let seen = [Observation { label: Some(LandmarkId(1)), measurement: RangeBearing::new(2.0, 0.0) }];
    slam.update(&seen, &mut KnownIdAssociation).unwrap(); // starts it
    for _ in 0..50 {
        slam.update(&seen, &mut KnownIdAssociation).unwrap();
    }
    assert_eq!(slam.n_retired(), 0, "fifty revisions are not more than fifty");
    slam.update(&seen, &mut KnownIdAssociation).unwrap();
    assert_eq!(slam.n_retired(), 1);
}
