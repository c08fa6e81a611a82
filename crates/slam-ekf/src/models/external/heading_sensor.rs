use nalgebra::{Matrix1, RowVector3};
use wayfix_estimation_traits::{Angle, Pose2, SensorModel};

/// Measures the heading in the frame of the map: a compass, or the orientation of an IMU that has one. Radians, counter-clockwise from x.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HeadingSensor {
    /// Variance, rad².
    pub variance: f64,
}

impl SensorModel for HeadingSensor {
    type State = Pose2<f64>;
    type Measurement = Angle<f64>;

    fn expected(&self, pose: &Pose2<f64>) -> Angle<f64> {
        pose.rotation
    }
    fn jacobian(&self, _: &Pose2<f64>) -> RowVector3<f64> {
        RowVector3::new(0.0, 0.0, 1.0)
    }
    fn noise(&self, _: &Pose2<f64>) -> Matrix1<f64> {
        Matrix1::new(self.variance)
    }
}
