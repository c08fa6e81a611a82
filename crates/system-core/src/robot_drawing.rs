use nalgebra::{Matrix2, Matrix3};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::CovarianceEllipse;
use wayfix_sensor_log::{DrawingShape, LogError, Stamp, ViewerDrawing, topics};

use crate::EstimateWriter;

/// Ellipses are drawn at two standard deviations.
const SIGMAS: f64 = 2.0;
const ROBOT_COLOR: [f64; 4] = [0.12, 0.47, 0.71, 1.0];

/// Writes the estimated pose of the robot, as a pose and as the place of its frame.
pub fn write_pose(writer: &mut EstimateWriter, stamp: Stamp, pose: &Pose2<f64>) -> Result<(), LogError> {
    writer.pose_in_frame(topics::ESTIMATED_POSE, stamp, topics::WORLD_FRAME, pose)?;
    writer.frame_transform("/tf", stamp, topics::WORLD_FRAME, topics::BODY_FRAME, pose)
}

/// As [`write_pose`], with the ellipse of its position; `covariance` is in the body frame.
pub fn write_robot(
    writer: &mut EstimateWriter,
    stamp: Stamp,
    pose: &Pose2<f64>,
    covariance: &Matrix3<f64>,
) -> Result<(), LogError> {
    write_pose(writer, stamp, pose)?;
    let rotation = pose.rotation_matrix();
    let covariance = rotation * covariance.fixed_view::<2, 2>(0, 0) * rotation.transpose();
    let robot = ellipse_drawing("robot".to_owned(), ROBOT_COLOR, [pose.x(), pose.y()], covariance);
    writer.scene_update("/estimate/robot", stamp, topics::WORLD_FRAME, robot.as_slice())
}

/// Nothing while the covariance is singular (a start pose known exactly).
pub fn ellipse_drawing(
    id: String,
    color: [f64; 4],
    center: [f64; 2],
    covariance: Matrix2<f64>,
) -> Option<ViewerDrawing> {
    let ellipse = CovarianceEllipse::at_sigmas(&covariance, SIGMAS).ok()?;
    let semi_axes = [ellipse.semi_major, ellipse.semi_minor];
    Some(ViewerDrawing {
        id,
        color,
        shape: DrawingShape::Ellipse { center, semi_axes, angle: ellipse.angle },
    })
}

/// The path in pieces: a message holds the poses since the last one, so that the path of a long log is written once.
#[derive(Default)]
pub struct PathSegmentWriter {
    /// Begins with the end of the last piece.
    piece: Vec<[f64; 2]>,
    n_pieces: usize,
}

/// Poses in a piece; the first ones are shorter, so that a path begins soon.
const PIECE: usize = 20;

impl PathSegmentWriter {
    /// Takes the next pose, and writes the piece when it is full. Viewers keep the earlier pieces, which have other names.
    pub fn push(
        &mut self,
        stamp: Stamp,
        pose: &Pose2<f64>,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError> {
        self.piece.push([pose.x(), pose.y()]);
        if self.piece.len() <= PIECE.min(self.n_pieces + 1) {
            return Ok(());
        }
        let (id, end) = (format!("path {}", self.n_pieces), [pose.x(), pose.y()]);
        let shape = DrawingShape::Path(std::mem::replace(&mut self.piece, vec![end]));
        self.n_pieces += 1;
        let piece = ViewerDrawing { id, color: ROBOT_COLOR, shape };
        writer.scene_update("/estimate/path", stamp, topics::WORLD_FRAME, &[piece])
    }
}
