//! Whatever comes, the filter keeps a covariance: noises of the moment, landmarks put in and taken out, models that lie.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use std::{cell::Cell, rc::Rc};

use nalgebra::{DMatrix, Matrix2, Matrix3, Vector2, linalg::Cholesky};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Manifold, MotionModel, Pose2};
use wayfix_slam_ekf::{
    CovarianceUpdate, DataAssociation, EkfSlam, KnownIdAssociation, LandmarkConfirmationParams, LandmarkId,
    LandmarkModel, NearestNeighbour, NearestNeighbourParams, NewLandmark, Observation, ObservationOutcome,
    OdometryMotion, OutlierRule, RangeBearing, RangeBearingSensor, SlamError, SlamParams, UpdateOrder,
};

/// Eight filters take turns: a million steps together. Four more have a compressed map.
const STEPS: usize = 125_000;
/// After so many steps a filter starts anew, so that one which huge numbers have stranded does not spend the rest of the test refusing.
const LIFE: usize = 100;
const N_IDS: u32 = 4;
/// Enough landmarks that looks at some of them leave the others out of the area.
const N_IDS_COMPRESSED: u32 = 12;
/// Part of each variance that makes the covariance definite where it is singular: some thousand ε.
const SLACK: f64 = 1e-12;

/// A number that is usually ordinary and sometimes anything.
fn number<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    match rng.random_range(0..40) {
        0 => f64::NAN,
        1 => f64::INFINITY,
        2 => f64::NEG_INFINITY,
        3 => 1e300 * rng.random_range(-1.0..1.0),
        4 => 1e-300 * rng.random_range(-1.0..1.0),
        5 => 0.0,
        6 => 10f64.powi(rng.random_range(-160..160)),
        7 => 10f64.powi(rng.random_range(-12..12)),
        _ => rng.random_range(-3.0..3.0),
    }
}

/// A noise of the moment: usually good, sometimes indefinite, lopsided, singular, tiny, huge or not a number.
fn noise<R: Rng + ?Sized>(rng: &mut R) -> Matrix2<f64> {
    match rng.random_range(0..20) {
        0 => Matrix2::new(1.0, 2.0, 2.0, 1.0),
        1 => Matrix2::new(1.0, 0.5, -0.5, 1.0),
        2 => Matrix2::zeros(),
        3 => Matrix2::identity() * number(rng),
        4 => Matrix2::from_fn(|_, _| number(rng)),
        5 => -Matrix2::identity(),
        6 => Matrix2::identity() * 1e-12,
        7 => Matrix2::identity() * 10f64.powi(rng.random_range(-24..24)),
        _ => Matrix2::new(0.02, 0.005, 0.005, 0.03),
    }
}

/// A motion whose control brings its own noise.
struct Pushed;

impl MotionModel for Pushed {
    type State = Pose2<f64>;
    type Control = (Pose2<f64>, Matrix3<f64>);

    fn propagate(&self, pose: &Pose2<f64>, (increment, _): &Self::Control) -> Pose2<f64> {
        OdometryMotion::default().propagate(pose, increment)
    }
    fn jacobian(&self, pose: &Pose2<f64>, (increment, _): &Self::Control) -> Matrix3<f64> {
        OdometryMotion::default().jacobian(pose, increment)
    }
    fn noise(&self, _: &Pose2<f64>, (_, noise): &Self::Control) -> Matrix3<f64> {
        *noise
    }
}

/// A range-bearing sensor whose noise changes from step to step, and that may call everything usable that comes.
#[derive(Clone, Debug)]
struct Whimsical {
    noise: Rc<Cell<Matrix2<f64>>>,
    is_careful: bool,
    n_ids: u32,
}

impl LandmarkModel for Whimsical {
    type Robot = Pose2<f64>;
    type Landmark = Vector2<f64>;
    type Measurement = RangeBearing;

    fn expected(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> RangeBearing {
        RangeBearingSensor::default().expected(robot, landmark)
    }
    fn robot_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> nalgebra::Matrix2x3<f64> {
        RangeBearingSensor::default().robot_jacobian(robot, landmark)
    }
    fn landmark_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> Matrix2<f64> {
        RangeBearingSensor::default().landmark_jacobian(robot, landmark)
    }
    fn noise(&self, _: &RangeBearing) -> Matrix2<f64> {
        self.noise.get()
    }
    fn is_usable(&self, seen: &RangeBearing) -> bool {
        !self.is_careful || RangeBearingSensor::default().is_usable(seen)
    }
    fn initialize(&self, robot: &Pose2<f64>, seen: &RangeBearing) -> NewLandmark<Vector2<f64>, Pose2<f64>> {
        let new = RangeBearingSensor::default().initialize(robot, seen);
        NewLandmark { covariance: self.noise.get(), ..new }
    }
}

/// Everything of a filter that can be seen, as bits, so that even the sign of a zero counts.
fn bits(slam: &EkfSlam<Whimsical>) -> Vec<u64> {
    let robot = slam.robot();
    let mut numbers = vec![robot.x(), robot.y(), robot.heading()];
    numbers.extend(slam.covariance().iter());
    for landmark in ids(slam).filter_map(|id| slam.landmark(id)) {
        numbers.extend(landmark.mean.iter());
    }
    let counts = [slam.n_landmarks() as u64, slam.n_tentative() as u64];
    numbers.into_iter().map(f64::to_bits).chain(counts).collect()
}

/// Finite, exactly symmetric, and positive definite after [`SLACK`] of each variance is added: it is singular when the start is known exactly.
fn check_covariance(p: &DMatrix<f64>, when: impl Fn() -> String) {
    assert!(p.iter().all(|entry| entry.is_finite()), "{}: {p}", when());
    assert_eq!(*p, p.transpose(), "{}: asymmetric", when());
    let mut lifted = p.clone();
    for i in 0..p.nrows() {
        assert!(p[(i, i)] > 0.0 || p.row(i).amax() == 0.0, "{}: variance {i} is {:e}", when(), p[(i, i)]);
        lifted[(i, i)] += if p[(i, i)] > 0.0 { SLACK * p[(i, i)] } else { 1.0 };
    }
    assert!(Cholesky::new(lifted).is_some(), "{}: indefinite: {p:e}", when());
}

/// What happened to the steps and observations of one filter.
#[derive(Default, Debug)]
struct Tally {
    refused: usize,
    unusable: usize,
    accepted: usize,
    started: usize,
}

fn ill_treat<A: DataAssociation<Whimsical>>(
    params: SlamParams,
    mut association: impl FnMut() -> A,
    seed: u64,
) -> Tally {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let sensor_noise = Rc::new(Cell::new(Matrix2::identity()));
    let mut tally = Tally::default();
    let n_ids = if params.covariance_update == CovarianceUpdate::Full { N_IDS } else { N_IDS_COMPRESSED };
    for life in 0..STEPS / LIFE {
        let sensor = Whimsical { noise: sensor_noise.clone(), is_careful: life % 4 < 2, n_ids };
        // Half of the starts are known exactly: the covariance is singular then.
        let uncertainty = Matrix3::identity() * if life % 2 == 0 { 0.0 } else { 0.04 };
        let start = Pose2::new(1.0, -2.0, 3.1);
        let mut slam = EkfSlam::with_start_covariance(sensor, params, start, uncertainty).unwrap();
        let mut rule = association();
        for step in 0..LIFE {
            sensor_noise.set(noise(&mut rng));
            let before = slam.clone();
            let when = || format!("seed {seed}, life {life}, step {step}");
            let result = match rng.random_range(0..20) {
                0 => change_map(&mut slam, &mut rng),
                1..8 => predict(&mut slam, &mut rng),
                _ => update(&mut slam, &mut rule, &mut rng, &mut tally, when),
            };
            if result.is_err() {
                tally.refused += 1;
                assert_eq!(bits(&before), bits(&slam), "{}: a refused call left a trace", when());
                if tally.refused % 64 == 0 {
                    assert_eq!(format!("{before:?}"), format!("{slam:?}"), "{}: a trace deep inside", when());
                }
                continue;
            }
            check_covariance(&slam.covariance().into_owned(), when);
            assert!(slam.robot().is_finite(), "{}: {:?}", when(), slam.robot());
            let means = ids(&slam).filter_map(|id| Some(slam.landmark(id)?.mean));
            assert!(means.flat_map(|mean| [mean.x, mean.y]).all(f64::is_finite), "{}", when());
        }
    }
    tally
}

/// All that may be in the map: nearest neighbour goes on counting.
fn ids(slam: &EkfSlam<Whimsical>) -> impl Iterator<Item = LandmarkId> + use<> {
    (0..10 * slam.model().n_ids).map(LandmarkId)
}

fn predict(slam: &mut EkfSlam<Whimsical>, rng: &mut ChaCha8Rng) -> Result<(), SlamError> {
    let increment = Pose2::new(0.1 * number(rng), 0.1 * number(rng), 0.1 * number(rng));
    let mut motion_noise = (noise(rng) * 0.1).to_homogeneous();
    motion_noise.m33 = if rng.random_bool(0.1) { number(rng) } else { 1e-4 };
    slam.predict(&Pushed, &(increment, motion_noise))
}

/// Puts landmarks and anchors in and takes them out, at good and bad places: exactly where the robot is, for one.
fn change_map(slam: &mut EkfSlam<Whimsical>, rng: &mut ChaCha8Rng) -> Result<(), SlamError> {
    let id = LandmarkId(rng.random_range(0..slam.model().n_ids));
    let place =
        if rng.random_bool(0.3) { slam.robot().translation } else { Vector2::new(number(rng), number(rng)) };
    match rng.random_range(0..4) {
        0 => slam.insert(id, place, noise(rng)),
        1 => slam.add_anchor(id, place),
        _ => {
            slam.remove(id);
            Ok(())
        }
    }
}

fn update<A: DataAssociation<Whimsical>>(
    slam: &mut EkfSlam<Whimsical>,
    rule: &mut A,
    rng: &mut ChaCha8Rng,
    tally: &mut Tally,
    when: impl Fn() -> String,
) -> Result<(), SlamError> {
    let n = rng.random_range(0..5);
    let observations: Vec<_> = (0..n).map(|_| observation(slam, rng)).collect();
    let report = slam.update(&observations, rule)?;
    assert_eq!(report.outcomes.len(), observations.len(), "{}", when());
    for (outcome, observation) in report.outcomes.iter().zip(&observations) {
        let RangeBearing { range, bearing } = observation.measurement;
        let taken = match outcome {
            ObservationOutcome::Accepted { innovation, noise_scale, .. } => {
                assert!(innovation.nis.is_finite() && *noise_scale >= 1.0, "{}: {outcome:?}", when());
                tally.accepted += 1;
                true
            }
            ObservationOutcome::Initialized { .. } | ObservationOutcome::Restarted { .. } => {
                tally.started += 1;
                true
            }
            ObservationOutcome::Unusable => {
                tally.unusable += 1;
                false
            }
            _ => false,
        };
        if !slam.model().is_usable(&observation.measurement) {
            assert_eq!(*outcome, ObservationOutcome::Unusable, "{}: {observation:?}", when());
        }
        let is_finite = range.is_finite() && bearing.radians().is_finite();
        assert!(is_finite || !taken, "{}: {observation:?}: {outcome:?}", when());
    }
    Ok(())
}

/// Mostly near what is expected, so that corrections happen; otherwise anything.
fn observation(slam: &EkfSlam<Whimsical>, rng: &mut ChaCha8Rng) -> Observation<RangeBearing> {
    let id = LandmarkId(rng.random_range(0..slam.model().n_ids));
    let expected = slam.predicted_measurement(id).map(|sighting| sighting.expected);
    let measurement = match expected {
        Some(expected) if rng.random_bool(0.7) => {
            expected.retract(&Vector2::new(rng.random_range(-0.1..0.1), rng.random_range(-0.1..0.1)))
        }
        _ => RangeBearing::new(number(rng), number(rng)),
    };
    Observation { label: rng.random_bool(0.95).then_some(id), measurement }
}

fn is_never_poisoned(map: CovarianceUpdate, rules: &[OutlierRule], mut seed: u64) {
    let mut tallies = Vec::new();
    for order in [UpdateOrder::Joint, UpdateOrder::Sequential] {
        for &outliers in rules {
            let confirmation = LandmarkConfirmationParams {
                max_consecutive_misses: Some(5),
                ..LandmarkConfirmationParams::default()
            };
            let params = SlamParams {
                update_order: order,
                outlier_rule: outliers,
                confirmation,
                covariance_update: map,
                ..SlamParams::default()
            };
            tallies.push(ill_treat(params, || KnownIdAssociation, seed));
            let nearest = || NearestNeighbour::new(NearestNeighbourParams::default()).unwrap();
            tallies.push(ill_treat(params, nearest, seed + 1));
            seed += 2;
        }
    }
    // The test means something only if everything occurs often.
    for tally in &tallies {
        let least = [tally.refused, tally.unusable, tally.accepted, tally.started].into_iter().min();
        assert!(least > Some(STEPS / 100), "{tally:?}");
    }
}

#[test]
fn an_ill_treated_filter_keeps_a_covariance() {
    is_never_poisoned(CovarianceUpdate::Full, &[OutlierRule::Downweight, OutlierRule::Reject], 0);
}

#[test]
fn hostile_steps_keep_the_compressed_covariance_valid() {
    is_never_poisoned(CovarianceUpdate::Compressed, &[OutlierRule::Downweight], 8);
}
