//! Writes a log with everything that viewers draw: path, transform, covariance ellipse, landmark with its number, points.
//!
//! `cargo run -p wayfix-sensor-log --example 03_draw_estimates -- OUT.mcap`

use std::error::Error;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{
    Detection, DetectionTarget, DrawingShape, McapWriter, Record, RecordData, Stamp, TrueLandmark, Velocity,
    ViewerDrawing, topics,
};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("give the path of the MCAP file to write")?;
    let mut writer = McapWriter::create(path)?;
    let landmark = TrueLandmark { id: 7, x: 4.0, y: 2.0 };
    let mut poses = Vec::new();
    for k in 0..50_u32 {
        let stamp = Stamp::from_nanoseconds(u64::from(k) * 100_000_000);
        let pose = Pose2::new(0.1 * f64::from(k), 0.0, 0.02 * f64::from(k));
        poses.push(pose);
        let seen = pose.inverse_transform(&[landmark.x, landmark.y].into());
        let (range, bearing) = (seen.norm(), seen.y.atan2(seen.x));
        let records = [
            RecordData::TrueLandmark(landmark),
            RecordData::TruePose(pose),
            RecordData::Velocity(Velocity { linear: 1.0, angular: 0.2 }),
            RecordData::OdometryIncrement(Pose2::new(0.1, 0.0, 0.02)),
            RecordData::Detections(vec![Detection { target: DetectionTarget::Landmark(7), range, bearing }]),
            RecordData::EstimatedPose(pose),
        ];
        for data in records {
            writer.record(&Record { stamp, data })?;
        }
        writer.frame_transform("/tf", stamp, topics::WORLD_FRAME, topics::BODY_FRAME, &pose)?;
        writer.poses_in_frame("/estimate/path", stamp, topics::WORLD_FRAME, &poses)?;
        writer.point_cloud("/estimate/landmarks", stamp, topics::WORLD_FRAME, &[[landmark.x, landmark.y]])?;
        let drawings = [
            ViewerDrawing {
                id: "covariance".to_owned(),
                color: [0.2, 0.4, 1.0, 1.0],
                shape: DrawingShape::Ellipse {
                    center: [pose.x(), pose.y()],
                    semi_axes: [0.3, 0.1],
                    angle: pose.heading(),
                },
            },
            ViewerDrawing {
                id: "landmark 7".to_owned(),
                color: [1.0, 0.6, 0.0, 1.0],
                shape: DrawingShape::Marker {
                    position: [landmark.x, landmark.y],
                    radius: 0.1,
                    text: "7".to_owned(),
                },
            },
        ];
        writer.scene_update("/estimate/scene", stamp, topics::WORLD_FRAME, &drawings)?;
    }
    writer.finish()?;
    Ok(())
}
