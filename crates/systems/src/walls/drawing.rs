use wayfix_sensor_log::{DrawingShape, LogError, Stamp, ViewerDrawing, topics};
use wayfix_slam_ekf::EkfSlam;

use super::WallModel;
use crate::system::EstimateWriter;

const WALL_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

/// The walls as lines between their ends.
pub(super) fn draw_map(
    filter: &EkfSlam<WallModel>,
    stamp: Stamp,
    writer: &mut EstimateWriter,
) -> Result<(), LogError> {
    let drawings: Vec<ViewerDrawing> = filter
        .landmarks()
        .map(|wall| ViewerDrawing {
            id: format!("wall {}", wall.id),
            color: WALL_COLOR,
            shape: DrawingShape::Path(wall.mean.ends().map(Into::into).to_vec()),
        })
        .collect();
    writer.scene_update("/estimate/walls", stamp, topics::WORLD_FRAME, &drawings)
}
