use wayfix_sensor_log::{LogError, Record, RecordData, topics};
use wayfix_system_core::{EstimateDrawer, EstimateRecorder, EstimateWriter, PathSegmentWriter, write_pose};

use super::CmlSystem;

/// Writes the views, the path and the references of an appearance map beside the records, for viewers.
pub type CmlEstimateRecorder = EstimateRecorder<CmlDrawingState>;

/// State of the drawing of [`CmlEstimateRecorder`].
#[derive(Default)]
pub struct CmlDrawingState {
    n_written: usize,
    path: PathSegmentWriter,
    /// Number of views at which the references are written next.
    next_map: usize,
}

/// Least number of views between two writes of the references.
const PERIOD: usize = 20;
/// In a long log the period is this part of the views so far, so that the references do not outgrow the log.
const PERIOD_SHARE: usize = 100;

impl EstimateDrawer for CmlDrawingState {
    type System = CmlSystem;

    fn draw(&mut self, _: &Record, system: &CmlSystem, writer: &mut EstimateWriter) -> Result<(), LogError> {
        let n_views = system.sample().n_seen();
        let Some(frame) = system.latest().filter(|_| self.n_written < n_views) else { return Ok(()) };
        self.n_written = n_views;
        let (stamp, world) = (frame.stamp, topics::WORLD_FRAME);
        if let Some(pose) = frame.pose.as_ref().map(|pose| *pose.mean()) {
            self.path.push(stamp, &pose, writer)?;
            write_pose(writer, stamp, &pose)?;
        }
        if let Some(measured) = frame.pose_measurement() {
            writer.record(&Record { stamp, data: RecordData::PoseMeasurement(measured) })?;
        }
        if self.n_written >= self.next_map {
            self.next_map = self.n_written + PERIOD.max(self.n_written / PERIOD_SHARE);
            let references = system.localizer().map().references().values();
            let places = references.flat_map(|reference| &reference.places);
            let points: Vec<[f64; 2]> =
                places.map(|place| [place.gaussian.mean().x(), place.gaussian.mean().y()]).collect();
            writer.point_cloud("/estimate/references", stamp, world, &points)?;
        }
        Ok(())
    }
}
