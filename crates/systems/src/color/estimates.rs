use nalgebra::Matrix2;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::CovarianceEllipse;
use wayfix_sensor_log::{Drawing, LogError, Record, Shape, topics};

use super::{ColorSystem, FrameResult};
use crate::system::{self, EstimateLog, EstimateWriter, write_pose};

/// Writes the camera's images, the path and the particles beside the records, for viewers.
pub type ColorEstimateLog = EstimateLog<ColorDrawing>;

/// State of the drawing of [`ColorEstimateLog`].
#[derive(Default)]
pub struct ColorDrawing {
    n_written: usize,
    path: Vec<Pose2<f64>>,
}

/// Number of frames between two writes of the whole path.
const PATH_PERIOD: usize = 20;
/// Ellipses are drawn at two standard deviations.
const SIGMAS: f64 = 2.0;
const ROBOT_COLOR: [f64; 4] = [0.12, 0.47, 0.71, 1.0];

impl system::Drawing for ColorDrawing {
    type System = ColorSystem;

    fn draw(
        &mut self,
        _: &Record,
        system: &ColorSystem,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError> {
        let Some(frame) = system.frames().get(self.n_written) else { return Ok(()) };
        self.n_written += 1;
        let (stamp, pose, world) = (frame.stamp, frame.pose.mean(), topics::WORLD_FRAME);
        self.path.push(*pose);
        write_pose(writer, stamp, pose)?;
        writer.scene_update("/estimate/robot", stamp, world, &robot(frame))?;
        if let Some(localizer) = system.localizer() {
            let points: Vec<[f64; 2]> = localizer.poses().map(|(pose, _)| [pose.x(), pose.y()]).collect();
            writer.point_cloud("/estimate/particles", stamp, world, &points)?;
        }
        if self.path.len() % PATH_PERIOD == 1 {
            writer.poses_in_frame("/estimate/path", stamp, world, &self.path)?;
        }
        Ok(())
    }
}

fn robot(frame: &FrameResult) -> Vec<Drawing> {
    let pose = frame.pose.mean();
    let rotation = pose.rotation_matrix();
    let covariance: Matrix2<f64> =
        rotation * frame.pose.covariance().fixed_view::<2, 2>(0, 0) * rotation.transpose();
    let Ok(ellipse) = CovarianceEllipse::at_sigmas(&covariance, SIGMAS) else { return Vec::new() };
    let shape = Shape::Ellipse {
        center: [pose.x(), pose.y()],
        semi_axes: [ellipse.semi_major, ellipse.semi_minor],
        angle: ellipse.angle,
    };
    vec![Drawing { id: "robot".to_owned(), color: ROBOT_COLOR, shape }]
}
