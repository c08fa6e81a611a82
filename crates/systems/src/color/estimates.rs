use wayfix_sensor_log::{LogError, Record, topics};
use wayfix_system_core::{EstimateDrawer, EstimateRecorder, EstimateWriter, PathSegmentWriter, write_robot};

use super::ColorSystem;

/// Writes the camera's images, the path and the particles beside the records, for viewers.
pub type ColorEstimateRecorder = EstimateRecorder<ColorDrawingState>;

/// State of the drawing of [`ColorEstimateRecorder`].
#[derive(Default)]
pub struct ColorDrawingState {
    n_written: usize,
    path: PathSegmentWriter,
}

/// Particles that are written: with all of them the file would be larger than twice the log.
const MOST_PARTICLES: usize = 200;

impl EstimateDrawer for ColorDrawingState {
    type System = ColorSystem;

    fn draw(
        &mut self,
        _: &Record,
        system: &ColorSystem,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError> {
        let n_frames = system.sample().n_seen();
        let Some(frame) = system.latest().filter(|_| self.n_written < n_frames) else { return Ok(()) };
        self.n_written = n_frames;
        let (stamp, pose, world) = (frame.stamp, frame.pose.mean(), topics::WORLD_FRAME);
        self.path.push(stamp, pose, writer)?;
        write_robot(writer, stamp, pose, frame.pose.covariance())?;
        if let Some(localizer) = system.localizer() {
            let every = localizer.poses().count().div_ceil(MOST_PARTICLES).max(1);
            let poses = localizer.poses().step_by(every);
            let points: Vec<[f64; 2]> = poses.map(|(pose, _)| [pose.x(), pose.y()]).collect();
            writer.point_cloud("/estimate/particles", stamp, world, &points)?;
        }
        Ok(())
    }
}
