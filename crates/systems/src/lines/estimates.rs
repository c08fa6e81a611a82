use wayfix_sensor_log::{DrawingShape, LogError, Record, RecordData, ViewerDrawing, topics};
use wayfix_system_core::{EstimateDrawer, EstimateRecorder, EstimateWriter};

use super::{LineExtractionSystem, ScanWalls};

/// Writes the walls of every scan beside the records, for viewers.
pub type LineEstimateRecorder = EstimateRecorder<LineDrawingState>;

/// State of the drawing of [`LineEstimateRecorder`].
pub struct LineDrawingState {
    n_written: usize,
    /// Number of walls of the scan before; surplus ones are overwritten with nothing.
    n_walls: usize,
    /// Frame of the walls: the laser's frame once the log has given its mounting, else the robot's.
    frame: &'static str,
}

impl Default for LineDrawingState {
    fn default() -> Self {
        Self { n_written: 0, n_walls: 0, frame: topics::BODY_FRAME }
    }
}

const WALL_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

impl EstimateDrawer for LineDrawingState {
    type System = LineExtractionSystem;

    const DRAWS_POSES: bool = false;

    fn draw(
        &mut self,
        record: &Record,
        system: &LineExtractionSystem,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError> {
        if let RecordData::TruePose(pose) | RecordData::EstimatedPose(pose) = &record.data {
            let (world, body) = (topics::WORLD_FRAME, topics::BODY_FRAME);
            writer.frame_transform("/tf", record.stamp, world, body, pose)?;
        }
        if let RecordData::LaserMount(_) = record.data {
            self.frame = topics::LASER_FRAME;
        }
        let Some(scan) = system.latest().filter(|_| system.totals.n_used > self.n_written) else {
            return Ok(());
        };
        self.n_written = system.totals.n_used;
        let drawings = drawings(scan, self.n_walls);
        self.n_walls = scan.segments.len();
        writer.scene_update("/walls", scan.stamp, self.frame, &drawings)
    }
}

fn drawings(scan: &ScanWalls, n_before: usize) -> Vec<ViewerDrawing> {
    let path = |wall: usize| match scan.segments.get(wall) {
        Some(segment) => vec![segment.start.into(), segment.end.into()],
        None => Vec::new(),
    };
    (0..n_before.max(scan.segments.len()))
        .map(|wall| ViewerDrawing {
            id: format!("wall {wall}"),
            color: WALL_COLOR,
            shape: DrawingShape::Path(path(wall)),
        })
        .collect()
}
