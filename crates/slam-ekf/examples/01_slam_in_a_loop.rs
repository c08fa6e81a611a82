//! From nothing to a map in six steps to copy.
//!
//! A robot drives two laps among ten posts; its camera reads the posts' numbers. Everything below `main` only plays the robot.
//! `cargo run -p wayfix-slam-ekf --example 01_slam_in_a_loop`

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkId, Observation, OdometryMotion, RangeBearing, RangeBearingSensor,
    SlamError, SlamParams,
};

fn main() -> Result<(), SlamError> {
    let mut robot = Robot::new();

    // 1. Say how good the sensor is, and how good the odometry.
    let sensor = RangeBearingSensor { range_sigma: 0.05, bearing_sigma: 0.01, ..Default::default() };
    let motion = OdometryMotion::default();

    // 2. Start where the robot stands; that is the origin of the map.
    let mut slam = EkfSlam::new(sensor, SlamParams::default(), Pose2::new(0.0, 0.0, 0.0))?;

    // 3. Say how sightings find their landmark: by their numbers here, by `NearestNeighbour` when there are none.
    let mut association = KnownIdAssociation;

    let mut by_odometry = Pose2::new(0.0, 0.0, 0.0);
    for _ in 0..160 {
        // 4. Tell the filter what the wheels say,
        let increment = robot.drive();
        slam.predict(&motion, &increment)?;
        by_odometry = by_odometry.compose(&increment);

        // 5. and what the camera sees. The report tells what became of each sighting.
        let report = slam.update(&robot.look(), &mut association)?;
        assert_eq!(report.n_rejected(), 0);
    }

    // 6. Ask where the robot is, where the posts are, and how sure that is.
    let error = (slam.robot().translation - robot.pose.translation).norm();
    let drift = (by_odometry.translation - robot.pose.translation).norm();
    println!("robot: {error:.3} m off, {drift:.3} m by odometry alone");
    assert!(error < 0.1 && error < 0.5 * drift);
    for landmark in slam.landmarks() {
        let error = (landmark.mean - robot.posts[landmark.id.0 as usize]).norm();
        let sigma = landmark.covariance.trace().sqrt();
        println!("post {}: {error:.3} m off, σ {sigma:.3} m", landmark.id);
        assert!(error < 4.0 * sigma);
    }
    assert_eq!(slam.n_landmarks(), robot.posts.len());
    Ok(())
}

/// Where the robot really is, which the filter never sees.
struct Robot {
    pose: Pose2<f64>,
    posts: Vec<Vector2<f64>>,
    rng: ChaCha8Rng,
}

impl Robot {
    fn new() -> Self {
        let post = |i: usize| {
            let (sin, cos) = (0.2 * std::f64::consts::PI * i as f64).sin_cos();
            Vector2::new(0.0, 3.2) + Vector2::new(cos, sin) * if i.is_multiple_of(2) { 4.5 } else { 6.0 }
        };
        let posts = (0..10).map(post).collect();
        Self { pose: Pose2::new(0.0, 0.0, 0.0), posts, rng: ChaCha8Rng::seed_from_u64(1) }
    }

    /// A quarter of a metre along a circle of 3.2 m; what the wheels make of it.
    fn drive(&mut self) -> Pose2<f64> {
        self.pose = self.pose.compose(&Pose2::new(0.25, 0.0, 0.25 / 3.2));
        let (x, y, turn) = (self.error(0.02), self.error(0.02), self.error(0.005));
        Pose2::new(0.25 + x, y, 0.25 / 3.2 + turn)
    }

    /// The posts within six metres.
    fn look(&mut self) -> Vec<Observation<RangeBearing>> {
        let mut sightings = Vec::new();
        for (i, post) in self.posts.clone().iter().enumerate() {
            let seen = self.pose.inverse_transform(post);
            if seen.norm() < 6.0 {
                let (range, bearing) = (self.error(0.05), self.error(0.01));
                let measurement = RangeBearing::new(seen.norm() + range, seen.y.atan2(seen.x) + bearing);
                sightings.push(Observation { label: Some(LandmarkId(i as u32)), measurement });
            }
        }
        sightings
    }

    /// A uniform error of the given standard deviation.
    fn error(&mut self, sigma: f64) -> f64 {
        sigma * 3_f64.sqrt() * self.rng.random_range(-1.0..1.0)
    }
}
