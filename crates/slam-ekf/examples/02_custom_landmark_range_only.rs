//! A kind of landmark of your own: radio beacons that tell how far away they are, and nothing else.
//!
//! A single range leaves a circle, which no Gaussian describes. So the beacons come from a plan of the site, right to within a metre or
//! so, and the filter corrects the plan while it drives. `cargo run -p wayfix-slam-ekf --example 02_custom_landmark_range_only`

use nalgebra::{Matrix1, Matrix2, Matrix2x3, Vector1, Vector2};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkId, LandmarkModel, NewLandmark, Observation, ObservationOutcome,
    OdometryMotion, SlamError, SlamParams, laws,
};

/// Distances to beacons, with a standard deviation in metres. The Jacobians are left to the trait, which takes them numerically.
struct BeaconReceiver {
    sigma: f64,
}

impl LandmarkModel for BeaconReceiver {
    type Robot = Pose2<f64>;
    type Landmark = Vector2<f64>;
    type Measurement = Vector1<f64>;

    fn expected(&self, robot: &Pose2<f64>, beacon: &Vector2<f64>) -> Vector1<f64> {
        Vector1::new((beacon - robot.translation).norm())
    }

    fn noise(&self, _: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::new(self.sigma.powi(2))
    }

    fn is_usable(&self, range: &Vector1<f64>) -> bool {
        range.x > 0.0 && range.x.is_finite()
    }

    /// One range does not place a beacon: a beacon that is not on the plan is not mapped, and the filter counts the observation as unusable.
    fn initialize(&self, _: &Pose2<f64>, _: &Vector1<f64>) -> NewLandmark<Vector2<f64>, Pose2<f64>> {
        NewLandmark {
            landmark: Vector2::repeat(f64::NAN),
            robot_jacobian: Matrix2x3::repeat(f64::NAN),
            covariance: Matrix2::repeat(f64::NAN),
        }
    }
}

/// How far off the plan may be in each coordinate, standard deviation in metres.
const PLAN_SIGMA: f64 = 0.7;
/// Broadcasts like the others, but is not on the plan.
const UNPLANNED: LandmarkId = LandmarkId(99);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let receiver = BeaconReceiver { sigma: 0.1 };
    let beacons =
        [(9.0, 1.0), (2.0, 9.5), (-6.0, 5.0), (-5.0, -6.0), (4.0, -7.0)].map(|(x, y)| Vector2::new(x, y));
    let plan =
        beacons.map(|beacon| beacon + Vector2::new(error(&mut rng, PLAN_SIGMA), error(&mut rng, PLAN_SIGMA)));

    // The crate's own suite tells whether the model keeps the laws of the trait.
    let start = Pose2::new(3.0, 0.0, std::f64::consts::FRAC_PI_2);
    laws::landmark_model(&receiver, &[start, Pose2::new(-1.0, 2.0, 3.1)], &beacons)?;

    let mut slam = EkfSlam::new(receiver, SlamParams::default(), start)?;
    for (id, beacon) in plan.iter().enumerate() {
        slam.insert(LandmarkId(id as u32), *beacon, Matrix2::identity() * PLAN_SIGMA.powi(2))?;
    }

    let (mut truth, mut by_odometry) = (start, start);
    for _ in 0..150 {
        let increment = Pose2::new(0.2, 0.0, 0.2 / 3.0);
        truth = truth.compose(&increment);
        let measured = increment.compose(&Pose2::new(
            error(&mut rng, 0.02),
            error(&mut rng, 0.02),
            error(&mut rng, 0.01),
        ));
        by_odometry = by_odometry.compose(&measured);
        slam.predict(&OdometryMotion::default(), &measured)?;
        listen(&mut slam, &truth, &beacons, &mut rng)?;
    }

    let off = |pose: &Pose2<f64>| (pose.translation - truth.translation).norm();
    println!("robot: {:.2} m off, {:.2} m by odometry alone", off(slam.robot()), off(&by_odometry));
    assert!(off(slam.robot()) < 0.5 * off(&by_odometry));
    for landmark in slam.landmarks() {
        let i = landmark.id.0 as usize;
        let (before, after) = ((plan[i] - beacons[i]).norm(), (landmark.mean - beacons[i]).norm());
        println!("beacon {i}: {before:.2} m off on the plan, {after:.2} m now");
        assert!(after < 4.0 * landmark.covariance.trace().sqrt());
    }
    let mean_error = |of: &dyn Fn(usize) -> Vector2<f64>| {
        (0..beacons.len()).map(|i| (of(i) - beacons[i]).norm()).sum::<f64>() / beacons.len() as f64
    };
    let estimates: Vec<_> = slam.landmarks().map(|landmark| landmark.mean).collect();
    assert!(mean_error(&|i| estimates[i]) < 0.5 * mean_error(&|i| plan[i]));
    Ok(())
}

/// One range from every beacon, and one from a stranger.
fn listen(
    slam: &mut EkfSlam<BeaconReceiver>,
    truth: &Pose2<f64>,
    beacons: &[Vector2<f64>],
    rng: &mut ChaCha8Rng,
) -> Result<(), SlamError> {
    let mut range = |id, beacon: &Vector2<f64>| {
        let distance = (beacon - truth.translation).norm();
        Observation { label: Some(id), measurement: Vector1::new(distance + error(rng, 0.1)) }
    };
    let mut heard: Vec<_> =
        beacons.iter().enumerate().map(|(i, beacon)| range(LandmarkId(i as u32), beacon)).collect();
    heard.push(range(UNPLANNED, &Vector2::new(0.0, 12.0)));
    let report = slam.update(&heard, &mut KnownIdAssociation)?;
    assert_eq!(report.outcomes.last(), Some(&ObservationOutcome::Unusable));
    Ok(())
}

/// A uniform error of the given standard deviation.
fn error(rng: &mut ChaCha8Rng, sigma: f64) -> f64 {
    sigma * 3_f64.sqrt() * rng.random_range(-1.0..1.0)
}
