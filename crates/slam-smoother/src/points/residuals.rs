use nalgebra::{Const, Matrix1x3, Matrix2, Matrix2x1, Matrix2x3, Vector1, Vector2};
use wayfix_estimation_traits::{LieGroup, Pose2, wrap_angle};
use wayfix_smoother::Residual;

/// Range and bearing of a point, by a sensor on a robot whose ranges have a scale: $`r = (e^{λ} |q| - ρ,\; \operatorname{atan2}(q_y, q_x) - β)`$
/// with $`q`$ the point in the frame of the sensor. The variables are pose, point and $`λ`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountedRangeBearing {
    /// Pose of the sensor in the robot frame.
    pub mount: Pose2<f64>,
    /// $`ρ`$, m.
    pub range: f64,
    /// $`β`$, rad, 0 ahead, counter-clockwise.
    pub bearing: f64,
}

/// Nearer than this the bearing has no derivative, m.
const NEAREST: f64 = 1e-6;

impl Residual for MountedRangeBearing {
    type Dim = Const<2>;
    type Variables = (Pose2<f64>, Vector2<f64>, Vector1<f64>);

    fn value(&self, (robot, point, log_scale): (&Pose2<f64>, &Vector2<f64>, &Vector1<f64>)) -> Vector2<f64> {
        let seen = robot.compose(&self.mount).inverse_transform(point);
        let range = log_scale.x.exp() * seen.norm();
        Vector2::new(range - self.range, wrap_angle(seen.y.atan2(seen.x) - self.bearing))
    }

    fn jacobians(
        &self,
        (robot, point, log_scale): (&Pose2<f64>, &Vector2<f64>, &Vector1<f64>),
    ) -> (Matrix2x3<f64>, Matrix2<f64>, Matrix2x1<f64>) {
        let sensor = robot.compose(&self.mount);
        let seen = sensor.inverse_transform(point);
        let (distance, scale) = (seen.norm().max(NEAREST), log_scale.x.exp());
        let unit = seen / distance;
        let by_seen = Matrix2::new(unit.x * scale, unit.y * scale, -unit.y / distance, unit.x / distance);
        let seen_by_sensor = Matrix2x3::new(-1.0, 0.0, seen.y, 0.0, -1.0, -seen.x);
        let by_robot = by_seen * seen_by_sensor * self.mount.inverse().adjoint();
        let by_point = by_seen * sensor.rotation_matrix().transpose();
        (by_robot, by_point, Matrix2x1::new(scale * seen.norm(), 0.0))
    }
}

/// Position of an antenna: $`r = x ∘ m ∘ a - z`$, with a motion $`m`$ that the robot has made since the pose $`x`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AntennaPosition {
    /// The antenna in the frame of the pose: $`m ∘ a`$, m.
    pub antenna: Vector2<f64>,
    /// $`z`$, m.
    pub measured: Vector2<f64>,
}

impl Residual for AntennaPosition {
    type Dim = Const<2>;
    type Variables = (Pose2<f64>,);

    fn value(&self, (robot,): (&Pose2<f64>,)) -> Vector2<f64> {
        robot.transform(&self.antenna) - self.measured
    }
    fn jacobians(&self, (robot,): (&Pose2<f64>,)) -> (Matrix2x3<f64>,) {
        let axes = robot.rotation_matrix();
        let turned = axes * Vector2::new(-self.antenna.y, self.antenna.x);
        (Matrix2x3::from_columns(&[axes.column(0).into(), axes.column(1).into(), turned]),)
    }
}

/// A heading: $`r = θ - z`$, on the circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading {
    /// $`z`$, rad.
    pub measured: f64,
}

impl Residual for Heading {
    type Dim = Const<1>;
    type Variables = (Pose2<f64>,);

    fn value(&self, (robot,): (&Pose2<f64>,)) -> Vector1<f64> {
        Vector1::new(wrap_angle(robot.heading() - self.measured))
    }
    fn jacobians(&self, _: (&Pose2<f64>,)) -> (Matrix1x3<f64>,) {
        (Matrix1x3::new(0.0, 0.0, 1.0),)
    }
}

/// Two points that are one: $`r = a - b`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SamePoint;

impl Residual for SamePoint {
    type Dim = Const<2>;
    type Variables = (Vector2<f64>, Vector2<f64>);

    fn value(&self, (a, b): (&Vector2<f64>, &Vector2<f64>)) -> Vector2<f64> {
        a - b
    }
    fn jacobians(&self, _: (&Vector2<f64>, &Vector2<f64>)) -> (Matrix2<f64>, Matrix2<f64>) {
        (Matrix2::identity(), -Matrix2::identity())
    }
}
