use nalgebra::{DefaultAllocator, Matrix3, Vector2};
use wayfix_estimation_traits::{Angle, LieGroup, Pose2, SensorModel};

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
    /// The same with the noise of [`MovedSensor`]: $`R + H Q H^T`$ after a `motion` from `pose`. $`Q`$ is the `covariance` of the motion.
    ///
    /// ```
    /// # use wayfix_estimation_traits::{Angle, Pose2, nalgebra::Matrix3};
    /// # use wayfix_slam_ekf::{HeadingSensor, MapMeasurement};
    /// let compass = MapMeasurement::Heading(HeadingSensor { variance: 0.01 }, Angle::new(0.5));
    /// let (pose, motion) = (Pose2::new(1.0, 2.0, 0.3), Pose2::new(0.4, 0.0, 0.2));
    /// let covariance = Matrix3::from_diagonal_element(0.03);
    /// let expected = MapMeasurement::Heading(HeadingSensor { variance: 0.04 }, Angle::new(0.5));
    /// assert_eq!(compass.with_motion_noise(&pose, motion, covariance), expected);
    /// ```
    pub fn with_motion_noise(self, pose: &Pose2<f64>, motion: Pose2<f64>, covariance: Matrix3<f64>) -> Self {
        match self {
            Self::Position(sensor, measured) => {
                let covariance = MovedSensor { sensor, motion, covariance }.noise(pose);
                Self::Position(PositionSensor { covariance, ..sensor }, measured)
            }
            Self::Heading(sensor, measured) => {
                let variance = MovedSensor { sensor, motion, covariance }.noise(pose).x;
                Self::Heading(HeadingSensor { variance }, measured)
            }
            Self::Pose(sensor, measured) => {
                let in_body = MovedSensor { sensor, motion, covariance }.noise(pose);
                let to_map = pose.compose(&motion).rotation_matrix().to_homogeneous();
                Self::Pose(PoseSensor { covariance: to_map * in_body * to_map.transpose() }, measured)
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
