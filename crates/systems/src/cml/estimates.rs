use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{LogError, Record, topics};

use super::CmlSystem;
use crate::system::{self, EstimateRecorder, EstimateWriter, write_pose};

/// Writes the views, the path and the references of an appearance map beside the records, for viewers.
pub type CmlEstimateRecorder = EstimateRecorder<CmlDrawingState>;

/// State of the drawing of [`CmlEstimateRecorder`].
#[derive(Default)]
pub struct CmlDrawingState {
    n_written: usize,
    path: Vec<Pose2<f64>>,
}

/// Number of views between two writes of the whole path and the references.
const PERIOD: usize = 20;

impl system::EstimateDrawer for CmlDrawingState {
    type System = CmlSystem;

    fn draw(&mut self, _: &Record, system: &CmlSystem, writer: &mut EstimateWriter) -> Result<(), LogError> {
        let Some(frame) = system.frames().get(self.n_written) else { return Ok(()) };
        self.n_written += 1;
        let (stamp, world) = (frame.stamp, topics::WORLD_FRAME);
        if let Some(pose) = frame.pose.as_ref().map(|pose| *pose.mean()) {
            self.path.push(pose);
            write_pose(writer, stamp, &pose)?;
        }
        if self.n_written % PERIOD == 1 {
            writer.poses_in_frame("/estimate/path", stamp, world, &self.path)?;
            let references = system.localizer().map().references().values();
            let places = references.flat_map(|reference| &reference.places);
            let points: Vec<[f64; 2]> =
                places.map(|place| [place.gaussian.mean().x(), place.gaussian.mean().y()]).collect();
            writer.point_cloud("/estimate/references", stamp, world, &points)?;
        }
        Ok(())
    }
}
