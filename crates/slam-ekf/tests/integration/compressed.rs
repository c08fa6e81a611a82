//! A filter with a compressed map against one with a full map, on the same loops: nobody can tell which is which.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use approx::abs_diff_eq;
use nalgebra::{Matrix2, Vector2};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_slam_ekf::{
    CovarianceUpdate, EkfSlam, KnownIdAssociation, LandmarkConfirmationParams, LandmarkId, Observation,
    ObservationOutcome, OdometryMotion, OutlierRule, RangeBearing, RangeBearingSensor, SlamParams,
    UpdateOrder,
};

type Slam = EkfSlam<RangeBearingSensor>;

const SEED: u64 = 2001;
/// Some 25 times the reach of the sensor around: most of the map is out of sight.
const RADIUS: f64 = 12.0;
const N_LANDMARKS: usize = 120;
/// A lap and a half.
const N_STEPS: usize = 450;

fn twins(params: SlamParams) -> [Slam; 2] {
    [CovarianceUpdate::Full, CovarianceUpdate::Compressed].map(|map| {
        let start = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(0.01, 0.01, 1e-4));
        let params = SlamParams { covariance_update: map, ..params };
        EkfSlam::with_start_covariance(RangeBearingSensor::default(), params, common::start_at(RADIUS), start)
            .unwrap()
    })
}

/// Every entry of the covariance to 1e-9 of the deviations that it belongs to, every mean to 1e-9 of its deviation.
fn compare([full, compressed]: &[Slam; 2], when: usize) {
    let (expected, got) = (full.covariance(), compressed.covariance());
    assert_eq!(expected.shape(), got.shape(), "step {when}");
    let scale = expected.diagonal().map(f64::sqrt);
    let largest = (&expected - &got).component_div(&(&scale * scale.transpose())).amax();
    assert!(largest < 1e-9, "step {when}: covariance by {largest:e}");

    let moved = (full.robot().translation - compressed.robot().translation).amax() / scale[0].min(scale[1]);
    let turned = (full.robot().heading() - compressed.robot().heading()).abs() / scale[2];
    assert!(moved < 1e-9 && turned < 1e-9, "step {when}: robot by {moved:e}, {turned:e}");
    assert_eq!(
        (full.n_landmarks(), full.n_tentative()),
        (compressed.n_landmarks(), compressed.n_tentative())
    );
    for (one, other) in full.landmarks().zip(compressed.landmarks()) {
        let sigma = one.covariance.diagonal().min().sqrt();
        let error = (one.mean - other.mean).amax() / sigma;
        assert!(one.id == other.id && error < 1e-9, "step {when}: landmark {} by {error:e}", one.id);
        assert!(
            abs_diff_eq!(one.covariance, other.covariance, epsilon = 1e-9 * one.covariance.amax()),
            "step {when}"
        );
    }
}

/// The kind and the landmark of each outcome: what it says must be the same to the digits compared elsewhere.
fn kinds(outcomes: &[ObservationOutcome<RangeBearing>]) -> Vec<String> {
    let kind = |outcome: &ObservationOutcome<RangeBearing>| match outcome {
        ObservationOutcome::Accepted { landmark, noise_scale, .. } => {
            format!("accepted {landmark} {noise_scale:.6}")
        }
        ObservationOutcome::Rejected { landmark, .. } => format!("gated {landmark}"),
        other => format!("{other:?}"),
    };
    outcomes.iter().map(kind).collect()
}

/// One lap and a half with everything that can happen to a map; how often each kind of outcome occurred.
fn lap(params: SlamParams) -> String {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks_around(RADIUS, N_LANDMARKS, &mut rng);
    let mut slams = twins(params);
    let mut seen = String::new();
    for (k, step) in common::drive_around(RADIUS, N_STEPS, &landmarks, &mut rng).iter().enumerate() {
        let mut observations = step.observations.clone();
        disturb(&mut observations, k, &mut rng);
        let [by_full, by_compressed] = [0, 1].map(|which| {
            let slam = &mut slams[which];
            change_map(slam, k, &landmarks);
            slam.predict(&OdometryMotion::default(), &step.increment).unwrap();
            slam.update(&observations, &mut KnownIdAssociation).unwrap().outcomes
        });
        assert_eq!(kinds(&by_full), kinds(&by_compressed), "step {k}");
        seen += &kinds(&by_full).join("\n");
        compare(&slams, k);
    }
    assert_ne!(slams[0].covariance(), slams[1].covariance(), "the same bits: nothing was ever compressed");
    seen
}

/// Outliers, false detections that never come again, and false first sightings that have to start anew.
fn disturb(observations: &mut Vec<Observation<RangeBearing>>, step: usize, rng: &mut ChaCha8Rng) {
    if step % 7 == 3
        && let Some(first) = observations.first_mut()
    {
        first.measurement = RangeBearing::new(first.measurement.range + 1.5, 0.0);
    }
    if step % 11 == 5 {
        let label = Some(LandmarkId(false_id(step)));
        observations
            .push(Observation { label, measurement: RangeBearing::new(rng.random_range(1.0..6.0), 0.3) });
    }
    if step % 22 == 6 {
        let label = Some(LandmarkId(false_id(step - 1)));
        observations.push(Observation { label, measurement: RangeBearing::new(9.0, -1.5) });
    }
}

fn false_id(step: usize) -> u32 {
    1000 + step as u32
}

/// Landmarks taken out near and far, put in from a plan, and anchors.
fn change_map(slam: &mut Slam, step: usize, landmarks: &[[f64; 2]]) {
    let place = |id: usize| Vector2::new(landmarks[id][0], landmarks[id][1]);
    match step {
        60 => slam.add_anchor(LandmarkId(40), place(40)).unwrap(),
        90 => slam.insert(LandmarkId(2000), Vector2::new(-3.0, 8.0), Matrix2::identity() * 0.04).unwrap(),
        150 | 151 => assert!(slam.remove(LandmarkId(step as u32 - 148))), // far behind
        200 | 260 => {
            let newest = slam.landmarks().max_by_key(|landmark| landmark.id).unwrap().id;
            assert!(slam.remove(newest));
        }
        _ => {}
    }
}

#[test]
fn nobody_can_tell_a_compressed_map_from_a_full_one() {
    let confirmation = LandmarkConfirmationParams {
        max_consecutive_misses: Some(6),
        ..LandmarkConfirmationParams::default()
    };
    for order in [UpdateOrder::Joint, UpdateOrder::Sequential] {
        for outliers in [OutlierRule::Downweight, OutlierRule::Reject] {
            let seen = lap(SlamParams {
                update_order: order,
                outlier_rule: outliers,
                confirmation,
                ..SlamParams::default()
            });
            let expected =
                if outliers == OutlierRule::Reject { "Restarted,gated" } else { "Restarted,accepted" };
            for kind in expected.split(',') {
                assert!(seen.contains(kind), "{order:?}, {outliers:?}: never {kind}");
            }
        }
    }
}
