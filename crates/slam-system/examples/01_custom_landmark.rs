//! SLAM on a log with a kind of landmark of your own, here posts whose position a sensor gives in the robot frame: a [`LandmarkModel`] and a
//! [`FrontEnd`]. Association, observability, external sensors and the state to save come with [`SlamSystem`].
//! `cargo run -p wayfix-slam-system --example 01_custom_landmark`

use std::path::Path;

use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector2};
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Detection, DetectionTarget, LogError, LogOpenOptions, Record, RecordData, Stamp};
use wayfix_slam_ekf::{
    AnyAssociation, EkfSlam, ExternalParams, KnownIdAssociation, LandmarkId, LandmarkModel, NewLandmark,
    Observation, OdometryMotion, SlamParams, laws,
};
use wayfix_slam_system::slam::{FrontEnd, FrontEndState, MotionEstimate, SlamEstimator, SlamSystem, nis};
use wayfix_system_core::{EstimateWriter, drive};

/// Positions of posts in the robot frame, m; the error grows with the distance.
#[derive(Clone)]
struct PostSensor {
    /// Standard deviation at 1 m.
    sigma: f64,
}

impl LandmarkModel for PostSensor {
    type Robot = Pose2<f64>;
    type Landmark = Vector2<f64>;
    type Measurement = Vector2<f64>;

    fn expected(&self, robot: &Pose2<f64>, post: &Vector2<f64>) -> Vector2<f64> {
        robot.inverse_transform(post)
    }
    fn noise(&self, seen: &Vector2<f64>) -> Matrix2<f64> {
        Matrix2::identity() * self.sigma.powi(2) * seen.norm_squared()
    }
    fn is_usable(&self, seen: &Vector2<f64>) -> bool {
        seen.norm() > 0.0 && seen.norm().is_finite()
    }
    fn initialize(&self, robot: &Pose2<f64>, seen: &Vector2<f64>) -> NewLandmark<Vector2<f64>, Pose2<f64>> {
        let axes = robot.rotation_matrix();
        let by_turn = axes * Vector2::new(-seen.y, seen.x);
        NewLandmark {
            landmark: robot.transform(seen),
            robot_jacobian: Matrix2x3::from_columns(&[axes.column(0).into(), axes.column(1).into(), by_turn]),
            covariance: axes * self.noise(seen) * axes.transpose(),
        }
    }
}

/// Odometry increments, and detections of posts.
#[derive(Default)]
struct PostFrontEnd {
    odometry: OdometryMotion,
    external: ExternalParams,
}

/// This front end keeps nothing between two records.
#[derive(Serialize, Deserialize)]
struct NoState;

impl FrontEndState for NoState {
    const ROBOT: (&str, usize) = ("pose", 3);
    const LANDMARK: (&str, usize) = ("post", 2);
}

type Posts = SlamEstimator<PostSensor>;

impl FrontEnd for PostFrontEnd {
    type Model = PostSensor;
    type State = NoState;

    fn take(&mut self, record: &Record, estimator: &mut Posts) -> Result<(), String> {
        match &record.data {
            RecordData::OdometryIncrement(increment) => {
                estimator.predict(&self.odometry, increment)?;
                estimator.move_dead_reckoning(increment);
                Ok(())
            }
            RecordData::Detections(detections) => {
                let observations: Vec<_> = detections.iter().filter_map(observation).collect();
                let report = estimator.update(&observations, |seen| format!("a post at {seen}"))?;
                let (pose, covariance) = (*estimator.filter().robot(), estimator.filter().robot_covariance());
                estimator.add_stamped_estimate(record.stamp, pose, covariance, nis(&report));
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn external(&self) -> (&ExternalParams, Vector2<f64>) {
        (&self.external, Vector2::zeros())
    }

    /// The filter makes every motion at once.
    fn motion_to(&mut self, _: Stamp, _: &mut Posts) -> Result<Option<MotionEstimate>, String> {
        Ok(Some((Pose2::new(0.0, 0.0, 0.0), Matrix3::zeros())))
    }

    /// Nothing: this example has no viewer.
    fn draw_map(_: &EkfSlam<PostSensor>, _: Stamp, _: &mut EstimateWriter) -> Result<(), LogError> {
        Ok(())
    }

    fn state(&self) -> NoState {
        NoState
    }
}

fn observation(detection: &Detection) -> Option<Observation<Vector2<f64>>> {
    let DetectionTarget::Landmark(id) = detection.target else { return None };
    let (sin, cos) = detection.bearing.sin_cos();
    let measurement = Vector2::new(cos, sin) * detection.range;
    Some(Observation { label: Some(LandmarkId(id)), measurement })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/loop_known.mcap");
    let (records, _) = wayfix_sensor_log::open(log, &LogOpenOptions::default())?.read_all();
    let true_poses: Vec<_> = records
        .iter()
        .filter_map(|record| match record.data {
            RecordData::TruePose(pose) => Some((record.stamp, pose)),
            _ => None,
        })
        .collect();
    let start = true_poses.first().ok_or("the log has true poses")?.1;
    let sensor = PostSensor { sigma: 0.05 };
    laws::landmark_model(&sensor, &[start], &[Vector2::new(3.0, 1.0), Vector2::new(-2.0, 4.0)])?;

    let filter = EkfSlam::new(sensor, SlamParams::default(), start)?;
    let estimator = SlamEstimator::new(filter, AnyAssociation::Known(KnownIdAssociation), false, start);
    let mut system = SlamSystem::new(PostFrontEnd::default(), estimator);
    drive(&mut system, &records, |_| {});

    let (_, end) = true_poses.last().ok_or("the log has true poses")?;
    let off = |pose: &Pose2<f64>| (pose.translation - end.translation).norm();
    let (by_slam, by_odometry) = (off(system.filter().robot()), off(system.dead_reckoning()));
    println!(
        "{} posts; the robot is off by {by_slam:.2} m, by odometry alone {by_odometry:.2} m",
        system.filter().n_landmarks()
    );
    assert!(by_slam < 0.5 * by_odometry);
    Ok(())
}
