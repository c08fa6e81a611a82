//! Writes a log in which a camera on a robot pans over stripes; Foxglove and Rerun draw its frames and where it looks.
//!
//!     cargo run -p wayfix-sensor-log --example 04_write_a_camera -- OUT.mcap

use nalgebra::{UnitQuaternion, Vector3};
use wayfix_estimation_traits::Pose3;
use wayfix_sensor_log::{CameraInfo, EncodedImage, LogFormat, Record, RecordData, Stamp, write};

const CAMERA: CameraInfo = CameraInfo { width: 208, height: 160, fx: 197.5, fy: 197.5, cx: 104.0, cy: 80.0 };

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("usage: write_a_camera OUT.mcap")?;
    let mut records = vec![Record { stamp: Stamp::default(), data: RecordData::CameraInfo(CAMERA) }];
    for frame in 0..24_u32 {
        let stamp = Stamp::from_nanoseconds(u64::from(frame) * 83_333_333);
        let pan = 0.05 * f64::from(frame);
        let rotation = UnitQuaternion::from_euler_angles(0.0, 0.3, pan);
        let mount = Pose3 { translation: Vector3::new(0.1, 0.0, 0.2), rotation };
        let labels = stripes(pan);
        let rgb: Vec<u8> =
            labels.iter().flat_map(|&k| [[20, 120, 30], [230, 230, 230]][usize::from(k) - 1]).collect();
        let (width, height) = (CAMERA.width, CAMERA.height);
        records.extend([
            Record { stamp, data: RecordData::CameraMount(mount) },
            Record { stamp, data: RecordData::TrueLabels(EncodedImage::png_gray(width, height, &labels)?) },
            Record { stamp, data: RecordData::Image(EncodedImage::jpeg(width, height, &rgb, 85)?) },
        ]);
    }
    print!("{}", write(path, LogFormat::Mcap, records)?);
    Ok(())
}

/// Upright stripes, 0.1 rad wide, that stand still while the camera pans: labels 1 and 2.
fn stripes(pan: f64) -> Vec<u8> {
    let column = |u: u32| {
        let direction = pan + ((CAMERA.cx - f64::from(u) - 0.5) / CAMERA.fx).atan();
        1 + ((direction / 0.1).floor() as i64).rem_euclid(2) as u8
    };
    let row: Vec<u8> = (0..CAMERA.width).map(column).collect();
    row.repeat(CAMERA.height as usize)
}
