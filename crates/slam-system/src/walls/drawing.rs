use wayfix_sensor_log::{DrawingShape, LogError, Stamp, ViewerDrawing, topics};
use wayfix_slam_ekf::EkfSlam;
use wayfix_system_core::EstimateWriter;

use super::WallModel;

const WALL_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

/// Height of a drawn wall, m: that of a low storey. The map is planar.
const WALL_HEIGHT: f64 = 2.5;

/// The walls as a scene of three dimensions. [Andrade-Cetto 2005, Fig. 1c]
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
            shape: DrawingShape::Wall { ends: wall.mean.ends().map(Into::into), height: WALL_HEIGHT },
        })
        .collect();
    writer.scene_update("/estimate/walls", stamp, topics::WORLD_FRAME, &drawings)
}
