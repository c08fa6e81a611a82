use nalgebra::{DMatrix, DefaultAllocator, Vector1, Vector2};
use wayfix_estimation_traits::Pose2;

use crate::{
    LandmarkDim, LandmarkModel, MeasurementDim, MonobotSensor, RangeBearingSensor, RelativePositionSensor,
    RobotDim, ScaledPose, ScaledRangeBearingSensor, SlamAlloc,
};

/// How robot and landmarks move when the whole world is moved: what no relative measurement can see.
///
/// **Law**: with $`N_r`$ and $`N_m`$ the two derivatives, $`H_r N_r + H_m N_m = 0`$ at every robot and landmark;
/// [`laws::symmetry`](crate::laws::symmetry) checks it. [Andrade-Cetto 2005, Eq. 18]
pub trait Symmetry: LandmarkModel
where
    DefaultAllocator: SlamAlloc<RobotDim<Self>, LandmarkDim<Self>, MeasurementDim<Self>>,
{
    /// Names of the directions, one a column of the derivatives.
    fn directions(&self) -> &'static [&'static str];
    /// $`N_r`$: how the robot moves, in its tangent space; as many rows as that has dimensions.
    fn robot_motion(&self, robot: &Self::Robot) -> DMatrix<f64>;
    /// $`N_m`$: how a landmark moves, in its tangent space.
    fn landmark_motion(&self, landmark: &Self::Landmark) -> DMatrix<f64>;
}

const LINE: [&str; 1] = ["common translation"];
const PLANE: [&str; 3] = ["common translation in x", "common translation in y", "rotation about the origin"];

impl Symmetry for MonobotSensor {
    fn directions(&self) -> &'static [&'static str] {
        &LINE
    }
    fn robot_motion(&self, _: &Vector1<f64>) -> DMatrix<f64> {
        DMatrix::identity(1, 1)
    }
    fn landmark_motion(&self, _: &Vector1<f64>) -> DMatrix<f64> {
        DMatrix::identity(1, 1)
    }
}

impl Symmetry for RangeBearingSensor {
    fn directions(&self) -> &'static [&'static str] {
        &PLANE
    }
    fn robot_motion(&self, robot: &Pose2<f64>) -> DMatrix<f64> {
        pose_motion(robot)
    }
    fn landmark_motion(&self, landmark: &Vector2<f64>) -> DMatrix<f64> {
        point_motion(landmark)
    }
}

impl Symmetry for RelativePositionSensor {
    fn directions(&self) -> &'static [&'static str] {
        &PLANE
    }
    fn robot_motion(&self, robot: &Pose2<f64>) -> DMatrix<f64> {
        pose_motion(robot)
    }
    fn landmark_motion(&self, landmark: &Vector2<f64>) -> DMatrix<f64> {
        point_motion(landmark)
    }
}

/// Every single bearing fixes the scale as the range does not, so the scale is no symmetry.
impl Symmetry for ScaledRangeBearingSensor {
    fn directions(&self) -> &'static [&'static str] {
        &PLANE
    }
    fn robot_motion(&self, robot: &ScaledPose) -> DMatrix<f64> {
        pose_motion(&robot.pose).insert_row(3, 0.0)
    }
    fn landmark_motion(&self, landmark: &Vector2<f64>) -> DMatrix<f64> {
        point_motion(landmark)
    }
}

/// A point of the world under two translations and a rotation about the origin.
fn point_motion(point: &Vector2<f64>) -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 3, &[1.0, 0.0, -point.y, 0.0, 1.0, point.x])
}

/// A pose in its body frame.
fn pose_motion(pose: &Pose2<f64>) -> DMatrix<f64> {
    let moved = pose.rotation_matrix().transpose() * point_motion(&pose.translation);
    let mut motion = DMatrix::zeros(3, 3);
    motion.rows_mut(0, 2).copy_from(&moved);
    motion[(2, 2)] = 1.0;
    motion
}
