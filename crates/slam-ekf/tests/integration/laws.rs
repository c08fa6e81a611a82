//! Every model of the crate obeys its laws, and the suite catches one that does not.

#![allow(clippy::unwrap_used, reason = "a model that breaks a law fails the test")]

use std::f64::consts::PI;

use nalgebra::{DMatrix, Matrix2, Matrix2x3, Vector2};
use wayfix_estimation_traits::{Pose2, laws as general};
use wayfix_slam_ekf::{
    LandmarkModel, MotionWithRangeScale, MountedSensor, NewLandmark, OdometryMotion, PoseWithRangeScale,
    RangeBearing, RangeBearingSensor, RangeBearingSensorWithScale, RelativePositionSensor, VelocityControl,
    VelocityMotion, laws,
};

fn poses() -> Vec<Pose2<f64>> {
    let headings = [0.0, 0.5, -2.0, PI - 1e-4, -PI + 1e-4];
    headings
        .iter()
        .enumerate()
        .map(|(i, heading)| Pose2::new(i as f64 - 2.0, 0.3 * i as f64, *heading))
        .collect()
}

fn scaled(poses: &[Pose2<f64>]) -> Vec<PoseWithRangeScale> {
    let pair =
        |(pose, log_range_scale): (&Pose2<f64>, f64)| PoseWithRangeScale { pose: *pose, log_range_scale };
    poses.iter().zip([0.0, 0.05, -0.1, 0.3, 1e-8]).map(pair).collect()
}

/// None where a robot stands, and none straight behind one: the bearing jumps there.
fn landmarks() -> Vec<Vector2<f64>> {
    vec![Vector2::new(4.0, 1.0), Vector2::new(-3.3, 6.0), Vector2::new(0.1, -0.7)]
}

#[test]
fn of_every_landmark_model() {
    let sensor = RangeBearingSensor { range_sigma: 0.1, range_sigma_per_meter: 0.02, ..Default::default() };
    laws::landmark_model(&sensor, &poses(), &landmarks()).unwrap();
    laws::landmark_model(&RelativePositionSensor { sigma: 0.1 }, &poses(), &landmarks()).unwrap();
    laws::landmark_model(&RangeBearingSensorWithScale(sensor), &scaled(&poses()), &landmarks()).unwrap();
    let mounted = MountedSensor { sensor, mount: Pose2::new(0.3, -0.2, 2.0) };
    laws::landmark_model(&mounted, &poses(), &landmarks()).unwrap();
    laws::landmark_model(&RangeBearingSensorWithScale(mounted), &scaled(&poses()), &landmarks()).unwrap();
}

/// Near and far, on either side of the robots, through the origin, and with a normal across the wrap.
#[cfg(feature = "lines")]
#[test]
fn of_walls() {
    use approx::assert_abs_diff_eq;
    use wayfix_estimation_traits::Manifold;
    use wayfix_slam_ekf::{Wall, WallLine, WallSensor};
    let line = |(rho, alpha): (f64, f64)| WallLine::new(rho, alpha);
    let lines = [(4.0, 0.3), (-0.5, 2.0), (0.0, -1.5), (30.0, PI), (2.0, -PI + 1e-6)].map(line);
    // A line has turned into itself after half a turn, so tangents are unique up to a quarter only.
    for (line, delta) in lines.iter().flat_map(|line| [(line, 1.5), (line, -1.5), (line, 1e-8), (line, 0.0)])
    {
        let delta = Vector2::new(0.7, delta);
        assert_abs_diff_eq!(line.local(&line.retract(&delta)), delta, epsilon = 1e-12);
        let same = WallLine::new(-line.rho, line.alpha + PI);
        assert_abs_diff_eq!(same.local(&line.retract(&delta)).x, -0.7, epsilon = 1e-12);
        assert!(line.local(&same).norm() < 1e-12);
    }
    let ends = |line: WallLine| [line.point_at(-1.0), line.point_at(2.5)];
    let walls = lines.map(|line| Wall::between(line, ends(line)));
    let turned = walls[0].retract(&Vector2::new(0.2, 0.1));
    for (before, after) in walls[0].ends().iter().zip(turned.ends()) {
        assert!((before - after).norm() < 0.2 + 0.1 * before.norm()); // moved as far as the line, and not along it
    }
    laws::landmark_model(&WallSensor::default(), &poses(), &walls).unwrap();
}

#[test]
fn of_the_scaled_pose() {
    general::manifold(&scaled(&poses())).unwrap();
}

#[test]
fn of_every_motion() {
    let increments = [Pose2::new(0.3, -0.1, 0.2), Pose2::new(0.0, 0.0, -3.0), Pose2::new(0.0, 0.0, 0.0)];
    let cases: Vec<_> =
        poses().into_iter().flat_map(|pose| increments.iter().map(move |u| (pose, u))).collect();
    let with_steps = OdometryMotion {
        translation_variance_per_step: 1e-4,
        heading_variance_per_step: 1e-5,
        ..Default::default()
    };
    general::motion(&OdometryMotion::default(), &cases).unwrap();
    general::motion(&with_steps, &cases).unwrap();

    let control = |linear, angular| VelocityControl { linear, angular, duration: 0.4 };
    let controls = [control(0.5, 0.0), control(0.3, -0.7), control(0.0, 0.0), control(-0.2, 2.0)];
    let cases: Vec<_> =
        poses().into_iter().flat_map(|pose| controls.iter().map(move |u| (pose, u))).collect();
    let lossy = VelocityMotion {
        speed_loss_in_turns: 0.8,
        linear_sigma_per_meter: 0.1,
        angular_sigma_per_meter: 0.02,
        ..VelocityMotion::default()
    };
    general::motion(&lossy, &cases).unwrap();
    let cases: Vec<_> =
        scaled(&poses()).into_iter().flat_map(|state| controls.iter().map(move |u| (state, u))).collect();
    general::motion(&MotionWithRangeScale(lossy), &cases).unwrap();
}

/// A range-bearing sensor with one mistake.
#[derive(Clone, Copy)]
enum Wrong {
    /// Turning left moves what is seen to the left.
    Turn,
    /// The landmark moves the other way.
    Push,
    /// New landmarks appear on the other side.
    Mirrored,
    /// New landmarks do not know that they turn with the robot.
    Unturned,
    /// New landmarks are twice as sure as the measurement.
    Sure,
    /// The noise is indefinite.
    Noise,
    /// Landmarks turn the other way when the world turns.
    Twisted,
}

const GOOD: RangeBearingSensor = RangeBearingSensor {
    range_sigma: 0.1,
    range_sigma_per_meter: 0.02,
    bearing_sigma: 0.01,
    sensor_range: f64::INFINITY,
    half_field_of_view: PI,
    correlated_noise: None,
};

impl LandmarkModel for Wrong {
    type Robot = Pose2<f64>;
    type Landmark = Vector2<f64>;
    type Measurement = RangeBearing;

    fn expected(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> RangeBearing {
        GOOD.expected(robot, landmark)
    }
    fn robot_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> Matrix2x3<f64> {
        let mut jacobian = GOOD.robot_jacobian(robot, landmark);
        jacobian.m23 = if matches!(self, Self::Turn) { 1.0 } else { jacobian.m23 };
        jacobian
    }
    fn landmark_jacobian(&self, robot: &Pose2<f64>, landmark: &Vector2<f64>) -> Matrix2<f64> {
        GOOD.landmark_jacobian(robot, landmark) * if matches!(self, Self::Push) { -1.0 } else { 1.0 }
    }
    fn noise(&self, measurement: &RangeBearing) -> Matrix2<f64> {
        GOOD.noise(measurement) * if matches!(self, Self::Noise) { -1.0 } else { 1.0 }
    }
    fn symmetries(&self) -> &'static [&'static str] {
        GOOD.symmetries()
    }
    fn robot_symmetry(&self, robot: &Pose2<f64>) -> DMatrix<f64> {
        GOOD.robot_symmetry(robot)
    }
    fn landmark_symmetry(&self, landmark: &Vector2<f64>) -> DMatrix<f64> {
        let mut symmetry = GOOD.landmark_symmetry(landmark);
        symmetry.column_mut(2).scale_mut(if matches!(self, Self::Twisted) { -1.0 } else { 1.0 });
        symmetry
    }
    fn initialize(&self, robot: &Pose2<f64>, seen: &RangeBearing) -> NewLandmark<Vector2<f64>, Pose2<f64>> {
        let seen = match self {
            Self::Mirrored => RangeBearing::new(seen.range, -seen.bearing.radians()),
            _ => *seen,
        };
        let mut new = GOOD.initialize(robot, &seen);
        match self {
            Self::Unturned => new.robot_jacobian.set_column(2, &Vector2::zeros()),
            Self::Sure => new.covariance *= 0.25,
            _ => {}
        }
        new
    }
}

#[test]
fn mistakes_are_caught_by_the_law_they_break() {
    let law = |wrong: Wrong| {
        let violation = laws::landmark_model(&wrong, &poses(), &landmarks()).unwrap_err();
        (violation.law, violation.case)
    };
    assert!(law(Wrong::Turn).1.contains("by the robot") && law(Wrong::Turn).0.contains("derivative"));
    assert!(law(Wrong::Push).1.contains("by the landmark") && law(Wrong::Push).0.contains("derivative"));
    assert!(law(Wrong::Mirrored).0.contains("law 2"));
    assert!(law(Wrong::Unturned).1.contains("initialize") && law(Wrong::Unturned).0.contains("derivative"));
    assert!(law(Wrong::Sure).0.contains("law 4"));
    assert!(law(Wrong::Twisted).0.contains("law 5"));
    assert!(law(Wrong::Noise).0.contains("positive definite"));
}
