use wayfix_sensor_log::{DrawingShape, LogError, Stamp, ViewerDrawing, topics};
use wayfix_slam_ekf::EkfSlam;
use wayfix_system_core::{EstimateWriter, ellipse_drawing};

use super::PointSensor;

const LANDMARK_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

/// The landmarks as points, and with identities and ellipses.
pub(super) fn draw_map(
    filter: &EkfSlam<PointSensor>,
    stamp: Stamp,
    writer: &mut EstimateWriter,
) -> Result<(), LogError> {
    let (points, drawings) = map(filter);
    writer.point_cloud("/estimate/landmarks", stamp, topics::WORLD_FRAME, &points)?;
    writer.scene_update("/estimate/map", stamp, topics::WORLD_FRAME, &drawings)
}

fn map(filter: &EkfSlam<PointSensor>) -> (Vec<[f64; 2]>, Vec<ViewerDrawing>) {
    let (mut points, mut drawings) = (Vec::new(), Vec::new());
    for landmark in filter.landmarks() {
        let position = [landmark.mean.x, landmark.mean.y];
        points.push(position);
        let shape = DrawingShape::Marker { position, radius: 0.05, text: landmark.id.to_string() };
        drawings.push(ViewerDrawing {
            id: format!("landmark {}", landmark.id),
            color: LANDMARK_COLOR,
            shape,
        });
        let id = format!("ellipse {}", landmark.id);
        drawings.extend(ellipse_drawing(id, LANDMARK_COLOR, position, landmark.covariance));
    }
    (points, drawings)
}
