//! Which landmarks leave the map: those that should have been seen and were not, counted by looks.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkConfirmationParams, LandmarkId, LandmarkModel, Observation,
    RangeBearing, RangeBearingSensor, SlamError, SlamParams,
};

/// Sees 5 m far and 1 rad to either side.
fn sensor() -> RangeBearingSensor {
    RangeBearingSensor { sensor_range: 5.0, half_field_of_view: 1.0, ..RangeBearingSensor::default() }
}

fn slam(confirmation: LandmarkConfirmationParams) -> EkfSlam<RangeBearingSensor> {
    let params = SlamParams { confirmation, ..SlamParams::default() };
    EkfSlam::new(sensor(), params, Pose2::new(0.0, 0.0, 0.0)).unwrap()
}

/// One look at landmarks `(id, range, bearing)`.
fn look(slam: &mut EkfSlam<RangeBearingSensor>, seen: &[(u32, f64, f64)]) {
    let observation = |(id, range, bearing): &(u32, f64, f64)| Observation {
        label: Some(LandmarkId(*id)),
        measurement: RangeBearing::new(*range, *bearing),
    };
    let seen: Vec<_> = seen.iter().map(observation).collect();
    slam.update(&seen, &mut KnownIdAssociation).unwrap();
}

/// After how many empty looks a landmark is gone; `None` when a hundred leave it.
fn looks_survived(slam: &mut EkfSlam<RangeBearingSensor>, id: u32) -> Option<usize> {
    (1..=100).find(|_| {
        look(slam, &[]);
        !slam.contains(LandmarkId(id))
    })
}

const AHEAD: (u32, f64, f64) = (1, 3.0, 0.0);

#[test]
fn a_sensor_should_see_what_is_within_reach_and_view() {
    for (range, bearing, expected) in
        [(5.0, 1.0, true), (5.0, -1.0, true), (5.01, 0.0, false), (1.0, 1.01, false), (1.0, -3.0, false)]
    {
        assert_eq!(
            sensor().expects_detection(&RangeBearing::new(range, bearing)),
            expected,
            "{range} {bearing}"
        );
    }
    assert!(
        RangeBearingSensor::default().expects_detection(&RangeBearing::new(1e9, 3.1)),
        "no limits by default"
    );
}

#[test]
fn tentative_landmark_survives_the_allowed_misses() {
    for max_consecutive_misses in [0, 1, 5] {
        let mut slam = slam(LandmarkConfirmationParams {
            max_consecutive_misses: Some(max_consecutive_misses),
            ..LandmarkConfirmationParams::default()
        });
        look(&mut slam, &[AHEAD]);
        assert_eq!(
            looks_survived(&mut slam, 1),
            Some(max_consecutive_misses + 1),
            "max_consecutive_misses {max_consecutive_misses}"
        );
    }
}

#[test]
fn looks_that_could_not_show_a_landmark_do_not_count() {
    for hidden in [(1, 5.5, 0.0), (1, 3.0, 1.2)] {
        let mut slam = slam(LandmarkConfirmationParams {
            max_consecutive_misses: Some(2),
            ..LandmarkConfirmationParams::default()
        });
        look(&mut slam, &[hidden]);
        assert_eq!(looks_survived(&mut slam, 1), None, "{hidden:?}");
    }
}

#[test]
fn a_sighting_renews_the_patience() {
    let mut slam = slam(LandmarkConfirmationParams {
        min_detections: 3,
        max_consecutive_misses: Some(2),
        ..LandmarkConfirmationParams::default()
    });
    look(&mut slam, &[AHEAD]);
    look(&mut slam, &[]);
    look(&mut slam, &[]);
    look(&mut slam, &[AHEAD]); // the second of three sightings
    assert_eq!(looks_survived(&mut slam, 1), Some(3));
}

#[test]
fn a_confirmed_landmark_leaves_when_it_is_seen_in_too_few_looks() {
    let confirmation = LandmarkConfirmationParams {
        max_consecutive_misses: Some(2),
        min_detection_rate: 0.5,
        ..LandmarkConfirmationParams::default()
    };
    let mut slam = slam(confirmation);
    for _ in 0..4 {
        look(&mut slam, &[AHEAD]);
    }
    assert_eq!(slam.n_landmarks(), 1);
    // Four of four, of five, …: 4/8 is the wanted half still, 4/9 is less.
    assert_eq!(looks_survived(&mut slam, 1), Some(5));
}

#[test]
fn a_share_is_not_judged_before_patience_is_out() {
    let confirmation = LandmarkConfirmationParams {
        max_consecutive_misses: Some(7),
        min_detection_rate: 1.0,
        ..LandmarkConfirmationParams::default()
    };
    let mut slam = slam(confirmation);
    look(&mut slam, &[AHEAD]);
    look(&mut slam, &[AHEAD]);
    assert_eq!(looks_survived(&mut slam, 1), Some(8), "2/3 is below 1 at once, but it takes eight misses");
}

#[test]
fn confirmed_landmark_stays_without_share_or_patience() {
    let share_only =
        LandmarkConfirmationParams { min_detection_rate: 1.0, ..LandmarkConfirmationParams::default() };
    let patience_only = LandmarkConfirmationParams {
        max_consecutive_misses: Some(1),
        ..LandmarkConfirmationParams::default()
    };
    for confirmation in [share_only, patience_only] {
        let mut slam = slam(confirmation);
        look(&mut slam, &[AHEAD]);
        look(&mut slam, &[AHEAD]);
        assert_eq!(looks_survived(&mut slam, 1), None, "{confirmation:?}");
    }
}

#[test]
fn an_anchor_stays_whatever_is_seen() {
    let confirmation = LandmarkConfirmationParams {
        max_consecutive_misses: Some(0),
        min_detection_rate: 1.0,
        ..LandmarkConfirmationParams::default()
    };
    let mut slam = slam(confirmation);
    slam.add_anchor(LandmarkId(1), [3.0, 0.0].into()).unwrap();
    assert_eq!(looks_survived(&mut slam, 1), None);
}

#[test]
fn a_share_is_between_nothing_and_all() {
    for share in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        let confirmation =
            LandmarkConfirmationParams { min_detection_rate: share, ..LandmarkConfirmationParams::default() };
        let params = SlamParams { confirmation, ..SlamParams::default() };
        let built = EkfSlam::new(sensor(), params, Pose2::new(0.0, 0.0, 0.0));
        assert!(
            matches!(built, Err(SlamError::Parameter { name: "min_detection_rate", .. })),
            "{share}: {built:?}"
        );
    }
}
