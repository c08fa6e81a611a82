use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{LogError, Record, topics};

use super::ColorSystem;
use crate::system::{self, EstimateRecorder, EstimateWriter, write_robot};

/// Writes the camera's images, the path and the particles beside the records, for viewers.
pub type ColorEstimateRecorder = EstimateRecorder<ColorDrawingState>;

/// State of the drawing of [`ColorEstimateRecorder`].
#[derive(Default)]
pub struct ColorDrawingState {
    n_written: usize,
    path: Vec<Pose2<f64>>,
}

/// Number of frames between two writes of the whole path.
const PATH_PERIOD: usize = 20;

impl system::EstimateDrawer for ColorDrawingState {
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
        write_robot(writer, stamp, pose, frame.pose.covariance())?;
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
