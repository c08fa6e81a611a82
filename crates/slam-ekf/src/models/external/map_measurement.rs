use nalgebra::{DefaultAllocator, Matrix3, Vector2};
use wayfix_estimation_traits::{Angle, Pose2, SensorModel};

use super::{HeadingSensor, MovedSensor, PlanarRobot, PoseSensor, PositionSensor};
use crate::{
    EkfSlam, LandmarkDim, LandmarkModel, MeasurementDim, RobotDim, RobotInnovation, SlamAlloc, SlamError,
};

/// A measurement of the pose in the frame of the map, with its sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MapMeasurement {
    /// A position, m.
    Position(PositionSensor, Vector2<f64>),
    /// A heading.
    Heading(HeadingSensor, Angle<f64>),
    /// A pose.
    Pose(PoseSensor, Pose2<f64>),
}

impl MapMeasurement {
    /// The same with noise $`R + H Q H^T`$, at a `pose` in the map that a motion led to. $`Q`$ is the covariance of the motion in the body frame at its end: see [`MovedSensor`].
    pub fn with_motion_noise(self, pose: &Pose2<f64>, covariance: &Matrix3<f64>) -> Self {
        match self {
            Self::Position(sensor, measured) => {
                let jacobian = sensor.jacobian(pose);
                let added = jacobian * covariance * jacobian.transpose();
                Self::Position(PositionSensor { covariance: sensor.covariance + added, ..sensor }, measured)
            }
            Self::Heading(sensor, measured) => {
                Self::Heading(HeadingSensor { variance: sensor.variance + covariance.m33 }, measured)
            }
            Self::Pose(sensor, measured) => {
                let to_map = pose.rotation_matrix().to_homogeneous();
                let added = to_map * covariance * to_map.transpose();
                Self::Pose(PoseSensor { covariance: sensor.covariance + added }, measured)
            }
        }
    }
}

impl<M: LandmarkModel<Robot: PlanarRobot>> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Corrects robot and map by a measurement made after a motion from the state, with the covariance of the motion: see [`MovedSensor`] and
    /// [`update_pose`](Self::update_pose).
    ///
    /// # Errors
    /// Returns the errors of [`update_pose`](Self::update_pose); the filter is then unchanged.
    pub fn update_moved(
        &mut self,
        measurement: &MapMeasurement,
        motion: Pose2<f64>,
        covariance: Matrix3<f64>,
    ) -> Result<RobotInnovation, SlamError> {
        match *measurement {
            MapMeasurement::Position(sensor, position) => {
                self.update_pose(&MovedSensor { sensor, motion, covariance }, &position)
            }
            MapMeasurement::Heading(sensor, heading) => {
                self.update_pose(&MovedSensor { sensor, motion, covariance }, &heading)
            }
            MapMeasurement::Pose(sensor, pose) => {
                self.update_pose(&MovedSensor { sensor, motion, covariance }, &pose)
            }
        }
    }
}
