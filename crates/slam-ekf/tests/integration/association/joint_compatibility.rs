//! Joint compatibility against its definition: all pairings tried, each judged with the dense innovation covariance.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2, Vector3, linalg::Cholesky};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_gaussian_core::ChiSquaredGate;
use wayfix_slam_ekf::{
    Association, DataAssociation, EkfSlam, JointCompatibility, JointCompatibilityParams, KnownIdAssociation,
    LandmarkId, LandmarkModel, NearestNeighbour, NearestNeighbourParams, Observation, ObservationOutcome,
    RangeBearing, RangeBearingSensor, SlamError, SlamParams,
};

const N_LOOKS: u64 = 1500;
const PROBABILITY: f64 = 0.99;
const SEED: u64 = 7;

type Slam = EkfSlam<RangeBearingSensor>;
/// For every observation the landmark it is of, by its place in the map.
type Pairing = Vec<Option<usize>>;

fn gate(n_pairs: usize) -> f64 {
    ChiSquaredGate::from_probability(2 * n_pairs, PROBABILITY).unwrap().threshold()
}

fn rule(n_trials: usize) -> JointCompatibility {
    let params = JointCompatibilityParams {
        gate_probability: PROBABILITY,
        max_pairings: n_trials,
        ..JointCompatibilityParams::default()
    };
    JointCompatibility::new(params).unwrap()
}

fn unlabelled(measurement: RangeBearing) -> Observation<RangeBearing> {
    Observation { label: None, measurement }
}

/// A map of landmarks `0, 1, …` around a robot at the origin that knows its pose this badly.
fn map(landmarks: &[Vector2<f64>], landmark_sigma: f64, robot_sigmas: [f64; 3]) -> Slam {
    let start = Matrix3::from_diagonal(&Vector3::from(robot_sigmas.map(|sigma| sigma * sigma)));
    let origin = Pose2::new(0.0, 0.0, 0.0);
    let sensor = RangeBearingSensor::default();
    let mut slam = EkfSlam::with_start_covariance(sensor, SlamParams::default(), origin, start).unwrap();
    for (id, landmark) in (0..).map(LandmarkId).zip(landmarks) {
        slam.insert(id, *landmark, Matrix2::identity() * landmark_sigma.powi(2)).unwrap();
    }
    slam
}

/// What a robot at `pose` sees of a landmark, with noise.
fn see(pose: &Pose2<f64>, landmark: &Vector2<f64>, rng: &mut ChaCha8Rng) -> RangeBearing {
    let sensor = RangeBearingSensor::default();
    let noise = [sensor.range_sigma, sensor.bearing_sigma].map(|sigma| sigma * common::normal(rng));
    sensor.expected(pose, landmark).retract(&noise.into())
}

/// Joint NIS of some pairs with the dense $`H P H^T + R`$.
fn joint_nis(slam: &Slam, looks: &[Observation<RangeBearing>], pairs: &[(usize, usize)]) -> f64 {
    let (n, p) = (2 * pairs.len(), slam.covariance());
    let (mut jacobian, mut noise, mut residual) =
        (DMatrix::zeros(n, p.nrows()), DMatrix::zeros(n, n), DVector::zeros(n));
    for (row, (look, landmark)) in (0..).step_by(2).zip(pairs) {
        let mean = slam.landmark(LandmarkId(*landmark as u32)).unwrap().mean;
        let (model, robot, measured) = (slam.model(), slam.robot(), &looks[*look].measurement);
        jacobian.view_mut((row, 0), (2, 3)).copy_from(&model.robot_jacobian(robot, &mean));
        jacobian.view_mut((row, 3 + 2 * landmark), (2, 2)).copy_from(&model.landmark_jacobian(robot, &mean));
        noise.view_mut((row, row), (2, 2)).copy_from(&model.noise(measured));
        residual.rows_mut(row, 2).copy_from(&model.expected(robot, &mean).local(measured));
    }
    let covariance = &jacobian * p * jacobian.transpose() + noise;
    residual.dot(&Cholesky::new(covariance).unwrap().solve(&residual))
}

/// The largest set of pairs that is jointly compatible at every step of being put together, and of those the one of smallest joint NIS.
///
/// Observations with fewer candidates come first: the order is a part of the rule.
fn by_trying_all(slam: &Slam, looks: &[Observation<RangeBearing>]) -> Pairing {
    let n_landmarks = slam.landmarks().count();
    let candidates = |look: usize| -> Vec<usize> {
        (0..n_landmarks).filter(|landmark| joint_nis(slam, looks, &[(look, *landmark)]) <= gate(1)).collect()
    };
    let candidates: Vec<Vec<usize>> = (0..looks.len()).map(candidates).collect();
    let mut order: Vec<usize> = (0..looks.len()).filter(|look| !candidates[*look].is_empty()).collect();
    order.sort_by_key(|look| candidates[*look].len());

    let mut sets: Vec<(Vec<(usize, usize)>, f64)> = vec![(Vec::new(), 0.0)];
    for look in order {
        for (set, _) in sets.clone() {
            for landmark in &candidates[look] {
                let is_free = set.iter().all(|(_, taken)| taken != landmark);
                let set: Vec<_> = set.iter().copied().chain([(look, *landmark)]).collect();
                let nis = joint_nis(slam, looks, &set);
                if is_free && nis <= gate(set.len()) {
                    sets.push((set, nis));
                }
            }
        }
    }
    let (best, _) =
        sets.into_iter().min_by(|a, b| (b.0.len(), a.1).partial_cmp(&(a.0.len(), b.1)).unwrap()).unwrap();
    let of_look = |look: usize| best.iter().find(|pair| pair.0 == look).map(|pair| pair.1);
    (0..looks.len()).map(of_look).collect()
}

fn pairing(associations: &[Association]) -> Pairing {
    let landmark = |association: &Association| match association {
        Association::Matched(id) => Some(id.0 as usize),
        _ => None,
    };
    associations.iter().map(landmark).collect()
}

#[test]
fn small_looks_are_paired_as_by_trying_everything() {
    let (mut n_unlike_nearest, mut n_left_over, mut n_pairs) = (0, 0, 0);
    for seed in 0..N_LOOKS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let place =
            |rng: &mut ChaCha8Rng| Vector2::new(rng.random_range(2.0..4.0), rng.random_range(-1.0..1.0));
        let landmarks: Vec<_> = (0..6).map(|_| place(&mut rng)).collect();
        let mut slam = map(&landmarks, 0.1, [0.2, 0.2, 0.1]);
        let true_pose =
            slam.robot().retract(&Vector3::from([0.2, 0.2, 0.1].map(|s| s * common::normal(&mut rng))));
        // A look at two that are told apart makes everything hang together.
        let first: Vec<_> = (0..2)
            .map(|k| Observation {
                label: Some(LandmarkId(k)),
                measurement: see(&true_pose, &landmarks[k as usize], &mut rng),
            })
            .collect();
        slam.update(&first, &mut KnownIdAssociation).unwrap();
        let looks: Vec<_> = (0..rng.random_range(1..5))
            .map(|_| {
                let target =
                    if rng.random_bool(0.8) { landmarks[rng.random_range(0..6)] } else { place(&mut rng) };
                unlabelled(see(&true_pose, &target, &mut rng))
            })
            .collect();
        let mut joint = rule(usize::MAX);
        let found = pairing(&joint.associate(&slam, &looks));
        assert_eq!(found, by_trying_all(&slam, &looks), "seed {seed}");
        assert_eq!(joint.n_cut_short(), 0);

        let mut nearest = NearestNeighbour::new(NearestNeighbourParams {
            gate_nis: gate(1),
            ..NearestNeighbourParams::default()
        })
        .unwrap();
        n_unlike_nearest += usize::from(found != pairing(&nearest.associate(&slam, &looks)));
        n_left_over += found.iter().filter(|pair| pair.is_none()).count();
        n_pairs += found.iter().flatten().count();
    }
    // The test means something only where the rules differ, and where there is something to pair and something to leave.
    let least = [n_unlike_nearest, n_left_over, n_pairs].into_iter().min();
    assert!(least > Some(N_LOOKS as usize / 10), "{n_unlike_nearest} {n_left_over} {n_pairs}");
}

/// Landmarks on an arc of 10 m, every 0.1 rad, and a robot whose heading is off by 0.07 rad of a deviation of 0.05: what it sees of each
/// looks like the next.
#[test]
fn wrong_heading_misleads_nearest_neighbour_and_not_jcbb() {
    let bearings: Vec<f64> = (0..6).map(|k| 0.1 * f64::from(k)).collect();
    let landmarks: Vec<_> =
        bearings.iter().map(|bearing| RangeBearing::new(10.0, *bearing).point()).collect();
    let slam = map(&landmarks, 0.02, [0.02, 0.02, 0.05]);
    let looks: Vec<_> =
        bearings.iter().map(|bearing| unlabelled(RangeBearing::new(10.0, bearing + 0.07))).collect();

    let truth: Pairing = (0..6).map(Some).collect();
    assert_eq!(pairing(&rule(2000).associate(&slam, &looks)), truth);
    let mut nearest = NearestNeighbour::new(NearestNeighbourParams::default()).unwrap();
    let shifted: Pairing = (1..6).map(Some).chain([None]).collect();
    assert_eq!(pairing(&nearest.associate(&slam, &looks)), shifted);
}

/// Three hundred landmarks so close together, for a robot this unsure, that everything may be everything.
#[test]
fn jcbb_ends_with_compatible_pairs_for_hundreds_of_observations() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let place = |rng: &mut ChaCha8Rng| Vector2::new(rng.random_range(9.0..11.0), rng.random_range(-1.0..1.0));
    let landmarks: Vec<_> = (0..300).map(|_| place(&mut rng)).collect();
    let slam = map(&landmarks, 0.05, [1.0, 1.0, 0.1]);
    let looks: Vec<_> =
        landmarks.iter().map(|landmark| unlabelled(see(slam.robot(), landmark, &mut rng))).collect();
    for n_trials in [0, 1, 100, 2000] {
        let mut joint = rule(n_trials);
        let found = pairing(&joint.associate(&slam, &looks));
        assert_eq!((found.len(), joint.n_cut_short()), (300, 1), "{n_trials} trials");
        let pairs: Vec<_> =
            found.iter().enumerate().filter_map(|(look, landmark)| Some((look, (*landmark)?))).collect();
        let distinct: std::collections::BTreeSet<_> = pairs.iter().map(|pair| pair.1).collect();
        assert_eq!(distinct.len(), pairs.len(), "a landmark takes one observation");
        assert!((1..=n_trials.max(1)).contains(&pairs.len()), "{} pairs of {n_trials} trials", pairs.len());
        assert!(joint_nis(&slam, &looks, &pairs) <= gate(pairs.len()), "{n_trials} trials");
    }
}

#[test]
fn looks_without_anything_usable_leave_the_map_as_it_is() {
    let mut slam = map(&[Vector2::new(3.0, 0.0)], 0.1, [0.1, 0.1, 0.1]);
    let before = (*slam.robot(), slam.covariance().into_owned());
    let mut joint = rule(2000);
    assert!(joint.associate(&slam, &[]).is_empty());
    let nan = [(f64::NAN, 0.0), (3.0, f64::NAN), (f64::INFINITY, 0.0), (-3.0, 0.0)];
    let nan = nan.map(|(range, bearing)| unlabelled(RangeBearing::new(range, bearing)));
    for looks in [&nan[..], &[]] {
        let report = slam.update(looks, &mut joint).unwrap();
        assert_eq!(report.outcomes, vec![ObservationOutcome::Unusable; looks.len()]);
        assert_eq!((*slam.robot(), slam.covariance().into_owned()), before);
    }
    let mixed = [nan[0], unlabelled(RangeBearing::new(3.0, 0.0))];
    let report = slam.update(&mixed, &mut joint).unwrap();
    assert!(
        matches!(report.outcomes[..], [ObservationOutcome::Unusable, ObservationOutcome::Accepted { .. }]),
        "{report:?}"
    );
}

#[test]
fn invalid_thresholds_are_refused() {
    for (probability, certainly_new, name) in [
        (0.0, 40.0, "gate_probability"),
        (1.0, 40.0, "gate_probability"),
        (f64::NAN, 40.0, "gate_probability"),
        (0.99, 6.0, "new_landmark_nis"), // below the 6.63 of one degree of freedom
        (0.99, f64::NAN, "new_landmark_nis"),
    ] {
        let params = JointCompatibilityParams {
            gate_probability: probability,
            new_landmark_nis: certainly_new,
            ..JointCompatibilityParams::default()
        };
        let refused = JointCompatibility::new(params);
        assert!(
            matches!(&refused, Err(SlamError::Parameter { name: told, .. }) if *told == name),
            "{params:?}: {refused:?}"
        );
    }
}

#[test]
fn pairing_with_a_free_rival_is_ambiguous() {
    // Two landmarks of 0.1 m deviation, 0.4 m apart across the line of sight; what is seen is half a deviation nearer to the first.
    let landmarks = [Vector2::new(5.0, 0.2), Vector2::new(5.0, -0.2)];
    let slam = map(&landmarks, 0.1, [1e-3; 3]);
    let between = unlabelled(RangeBearing::new(5.0, 0.005));
    let second = unlabelled(RangeBearing::new(5.0, -0.04));
    let with_margin = |ambiguity_margin: f64, looks: &[Observation<RangeBearing>]| {
        let params = JointCompatibilityParams { ambiguity_margin, ..JointCompatibilityParams::default() };
        JointCompatibility::new(params).unwrap().associate(&slam, looks)
    };
    assert_eq!(with_margin(0.0, &[between]), [Association::Matched(LandmarkId(0))]);
    assert_eq!(with_margin(9.0, &[between]), [Association::Ambiguous]);
    assert_eq!(with_margin(9.0, &[between, second]), [0, 1].map(|id| Association::Matched(LandmarkId(id))));
    assert!(
        JointCompatibility::new(JointCompatibilityParams { ambiguity_margin: -1.0, ..Default::default() })
            .is_err()
    );
}
