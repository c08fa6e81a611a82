use nalgebra::{Const, Matrix2, Matrix2x3, Vector1, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_slam_ekf::{LandmarkModel, MountedSensor, Wall, WallMeasurement, WallSensor};
use wayfix_smoother::Residual;

/// A motion of odometry with heading drift: $`r = x_j ⊟ (x_i ∘ (m ⊞ b (κ - κ_0)))`$. The variables are $`x_i`$, $`x_j`$
/// and $`κ`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DriftingMotion {
    /// $`m`$, corrected for the drift $`κ_0`$.
    pub(super) motion: Pose2<f64>,
    /// $`κ_0`$, rad/m.
    pub(super) heading_drift: f64,
    /// $`b`$: the derivative of the motion by the drift.
    pub(super) drift_jacobian: Vector3<f64>,
}

impl Residual for DriftingMotion {
    type Dim = Const<3>;
    type Variables = (Pose2<f64>, Pose2<f64>, Vector1<f64>);

    fn value(&self, (before, after, drift): (&Pose2<f64>, &Pose2<f64>, &Vector1<f64>)) -> Vector3<f64> {
        let motion = self.motion.retract(&(self.drift_jacobian * (drift.x - self.heading_drift)));
        before.compose(&motion).local(after)
    }
}

/// A wall seen from a pose: $`r = z ⊟ h(x, m)`$ as in the filter.
#[derive(Clone, Debug)]
pub(super) struct SeenWall {
    pub(super) sensor: MountedSensor<WallSensor>,
    pub(super) measurement: WallMeasurement,
}

impl Residual for SeenWall {
    type Dim = Const<2>;
    type Variables = (Pose2<f64>, Wall);

    fn value(&self, (robot, wall): (&Pose2<f64>, &Wall)) -> Vector2<f64> {
        self.sensor.expected(robot, wall).local(&self.measurement)
    }
    fn jacobians(&self, (robot, wall): (&Pose2<f64>, &Wall)) -> (Matrix2x3<f64>, Matrix2<f64>) {
        (-self.sensor.robot_jacobian(robot, wall), -self.sensor.landmark_jacobian(robot, wall))
    }
}

/// A wall that is known beforehand: $`r = m ⊟ m_0`$.
#[derive(Clone, Copy, Debug)]
pub(super) struct GivenWall(pub(super) Wall);

impl Residual for GivenWall {
    type Dim = Const<2>;
    type Variables = (Wall,);

    fn value(&self, (wall,): (&Wall,)) -> Vector2<f64> {
        self.0.local(wall)
    }
}

/// The heading drift as the matches of scans measure it: $`r = κ - z`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MeasuredDrift(pub(super) f64);

impl Residual for MeasuredDrift {
    type Dim = Const<1>;
    type Variables = (Vector1<f64>,);

    fn value(&self, (drift,): (&Vector1<f64>,)) -> Vector1<f64> {
        Vector1::new(drift.x - self.0)
    }
}

#[cfg(test)]
mod tests {
    use wayfix_slam_ekf::WallLine;
    use wayfix_smoother::laws;

    use super::*;

    #[test]
    fn residuals_keep_the_laws() {
        let (before, after) = (Pose2::new(1.0, 2.0, 0.5), Pose2::new(1.6, 2.1, 0.9));
        let drift_jacobian = Vector3::new(0.01, 0.2, 0.6);
        let motion =
            DriftingMotion { motion: Pose2::new(0.6, -0.1, 0.3), heading_drift: 0.02, drift_jacobian };
        laws::residual(&motion, (&before, &after, &Vector1::new(0.05))).unwrap();
        laws::residual(&MeasuredDrift(0.1), (&Vector1::new(0.05),)).unwrap();
    }

    /// The wall is seen from behind, in the other form of its line.
    #[test]
    fn a_wall_in_either_form_keeps_the_laws() {
        let ends = [Vector2::new(-1.0, 3.0), Vector2::new(2.0, 3.4)];
        let along: Vector2<f64> = ends[1] - ends[0];
        let normal = Vector2::new(along.y, -along.x) / along.norm();
        let wall = Wall::between(WallLine::new(normal.dot(&ends[0]), normal.y.atan2(normal.x)), ends);
        let sensor = MountedSensor { sensor: WallSensor::default(), mount: Pose2::new(0.2, 0.0, 0.1) };
        let robot = Pose2::new(0.3, -0.4, 0.7);
        let seen = sensor.expected(&robot, &wall);
        let other = WallMeasurement {
            line: WallLine::new(-seen.line.rho - 0.1, seen.line.alpha + std::f64::consts::PI + 0.05),
            ..seen
        };
        for measurement in [seen, other] {
            let residual = SeenWall { sensor, measurement };
            assert!(residual.value((&robot, &wall)).norm() < 0.2);
            laws::residual(&residual, (&robot, &wall)).unwrap();
            laws::residual(&GivenWall(wall), (&wall.retract(&Vector2::new(0.1, -0.05)),)).unwrap();
        }
    }
}
