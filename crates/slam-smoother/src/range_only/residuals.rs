use nalgebra::{Const, Matrix1x2, Matrix1x3, Vector1, Vector2};
use wayfix_estimation_traits::Pose2;
use wayfix_smoother::Residual;

use super::Calibration;

/// A range from a robot to a beacon: $`r = e^{λ} |b - p| + β - z`$, with calibration $`(β, λ)`$ as third variable.
///
/// At the beacon itself the direction is unknown: the derivatives by robot and beacon count as zero there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeaconRange {
    /// The measured range, m.
    pub range: f64,
}

impl Residual for BeaconRange {
    type Dim = Const<1>;
    type Variables = (Pose2<f64>, Vector2<f64>, Vector2<f64>);

    fn value(
        &self,
        (robot, beacon, calibration): (&Pose2<f64>, &Vector2<f64>, &Vector2<f64>),
    ) -> Vector1<f64> {
        let distance = (beacon - robot.translation).norm();
        Vector1::new(Calibration::from(*calibration).range_of(distance) - self.range)
    }

    fn jacobians(
        &self,
        (robot, beacon, calibration): (&Pose2<f64>, &Vector2<f64>, &Vector2<f64>),
    ) -> (Matrix1x3<f64>, Matrix1x2<f64>, Matrix1x2<f64>) {
        let (direction, distance) = direction(beacon - robot.translation);
        let scale = calibration.y.exp();
        let by_beacon = direction.transpose() * scale;
        let in_body = -(robot.rotation_matrix().transpose() * direction) * scale;
        let by_robot = Matrix1x3::new(in_body.x, in_body.y, 0.0);
        (by_robot, by_beacon, Matrix1x2::new(1.0, scale * distance))
    }
}

/// A range from a known position: [`BeaconRange`] without the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RangeFrom {
    pub(super) position: Vector2<f64>,
    pub(super) range: f64,
}

impl Residual for RangeFrom {
    type Dim = Const<1>;
    type Variables = (Vector2<f64>, Vector2<f64>);

    fn value(&self, (beacon, calibration): (&Vector2<f64>, &Vector2<f64>)) -> Vector1<f64> {
        let distance = (beacon - self.position).norm();
        Vector1::new(Calibration::from(*calibration).range_of(distance) - self.range)
    }

    fn jacobians(
        &self,
        (beacon, calibration): (&Vector2<f64>, &Vector2<f64>),
    ) -> (Matrix1x2<f64>, Matrix1x2<f64>) {
        let (direction, distance) = direction(beacon - self.position);
        let scale = calibration.y.exp();
        (direction.transpose() * scale, Matrix1x2::new(1.0, scale * distance))
    }
}

/// What is known of a vector beforehand: $`r = x - \bar x`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VectorPrior(pub(super) Vector2<f64>);

impl Residual for VectorPrior {
    type Dim = Const<2>;
    type Variables = (Vector2<f64>,);

    fn value(&self, (x,): (&Vector2<f64>,)) -> Vector2<f64> {
        x - self.0
    }
    fn jacobians(&self, _: (&Vector2<f64>,)) -> (nalgebra::Matrix2<f64>,) {
        (nalgebra::Matrix2::identity(),)
    }
}

fn direction(offset: Vector2<f64>) -> (Vector2<f64>, f64) {
    let distance = offset.norm();
    if distance > 0.0 { (offset / distance, distance) } else { (Vector2::zeros(), 0.0) }
}
