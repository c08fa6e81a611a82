use nalgebra::{DMatrix, Matrix2x3, Vector2};
use wayfix_estimation_traits::Pose2;

/// Motions that no sensor on a planar robot can measure, in the order of the columns of the symmetries.
pub const PLANAR_SYMMETRIES: &[&str] =
    &["translation of everything along x", "translation of everything along y", "rotation of everything"];

/// Motion of a pose in its body frame when the world moves along x, along y, and turns about the origin.
pub fn pose_symmetry(pose: &Pose2<f64>) -> DMatrix<f64> {
    let to_body = pose.rotation_matrix().transpose();
    let turned = to_body * Vector2::new(-pose.y(), pose.x());
    DMatrix::from_row_slice(
        3,
        3,
        &[
            to_body.m11,
            to_body.m12,
            turned.x, //
            to_body.m21,
            to_body.m22,
            turned.y, //
            0.0,
            0.0,
            1.0,
        ],
    )
}

/// Motion of a point of the plane when the world moves along x, along y, and turns about the origin.
pub fn point_symmetry(point: &Vector2<f64>) -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 3, &[1.0, 0.0, -point.y, 0.0, 1.0, point.x])
}

/// Derivative by the robot of a point that it carries: the axes of its frame, and `turned`, the motion of the point when it turns.
pub(super) fn carried_point_jacobian(robot: &Pose2<f64>, turned: Vector2<f64>) -> Matrix2x3<f64> {
    let axes = robot.rotation_matrix();
    Matrix2x3::from_columns(&[axes.column(0).into_owned(), axes.column(1).into_owned(), turned])
}
