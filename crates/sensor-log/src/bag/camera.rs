use nalgebra::{Quaternion, UnitQuaternion};
use wayfix_estimation_traits::Pose3;

use super::transforms::last_part;
use crate::CameraInfo;
use crate::fault::{Fault, finite, inconsistent};
use crate::formats::format::shortened;
use crate::ros;

/// The pinhole camera of a message.
///
/// If the images are rectified (`is_rectified`), their projection is `P`, else `K`. In ROS the centre of the first pixel is at (0, 0), here at (1/2, 1/2).
pub(super) fn pinhole(message: &ros::CameraInfo<'_>, is_rectified: bool) -> Result<CameraInfo, Fault> {
    let [kx, skew, cx, _, ky, cy, ..] = message.k;
    let [px, _, pcx, _, _, py, pcy, ..] = message.p;
    let [fx, fy, cx, cy] = if is_rectified { [px, py, pcx, pcy] } else { [kx, ky, cx, cy] };
    finite([fx, fy, cx, cy])?;
    if !is_rectified && (skew != 0.0 || message.d.iter().any(|coefficient| *coefficient != 0.0)) {
        let (model, d) = (shortened(message.distortion_model), &message.d[..message.d.len().min(8)]);
        let reason =
            format!("not a pinhole camera: skew {skew}, distortion {model:?} {d:?}; rectify the images");
        return Err(inconsistent(&reason));
    }
    let [x_offset, y_offset, columns, rows] = message.region;
    let (columns, rows) =
        if columns == 0 || rows == 0 { (message.width, message.height) } else { (columns, rows) };
    let [bin_x, bin_y] = message.binning.map(|n_pixels| n_pixels.max(1));
    let (bin_width, bin_height) = (f64::from(bin_x), f64::from(bin_y));
    let info = CameraInfo {
        width: columns / bin_x,
        height: rows / bin_y,
        fx: fx / bin_width,
        fy: fy / bin_height,
        cx: (cx + 0.5 - f64::from(x_offset)) / bin_width,
        cy: (cy + 0.5 - f64::from(y_offset)) / bin_height,
    };
    if info.sees() {
        Ok(info)
    } else {
        let CameraInfo { width, height, fx, fy, .. } = info;
        Err(inconsistent(&format!("{width} x {height} pixels, focal lengths {fx} and {fy}")))
    }
}

/// The pose of a camera with x along its axis, y left and z up, from the frame of its images.
///
/// Image frames have z along the axis, x right, y down; REP 103 names them `…_optical`. Simulators and some configurations use the camera's
/// body frame instead, whose name lacks this suffix.
pub(super) fn mount(frame: &str, in_body: &Pose3<f64>) -> Pose3<f64> {
    if !last_part(frame).contains("optical") {
        return *in_body;
    }
    let camera_in_optical = UnitQuaternion::new_unchecked(Quaternion::new(0.5, 0.5, -0.5, 0.5));
    Pose3 { rotation: in_body.rotation * camera_in_optical, ..*in_body }
}

/// Whether a topic's name indicates rectified images.
pub(super) fn is_rectified(topic: &str) -> bool {
    last_part(image_base(topic)).contains("rect")
}

/// Topic of a camera's calibration, by the convention of `image_transport`: beside its images.
pub(super) fn info_topic(image_topic: &str) -> String {
    let base = image_base(image_topic);
    let namespace = base.rsplit_once('/').map_or("", |(namespace, _)| namespace);
    format!("{namespace}/camera_info")
}

fn image_base(topic: &str) -> &str {
    topic.strip_suffix("/compressed").unwrap_or(topic)
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use nalgebra::Vector3;

    use super::*;

    fn message() -> ros::CameraInfo<'static> {
        ros::CameraInfo {
            header: ros::Header::default(),
            height: 480,
            width: 640,
            distortion_model: "plumb_bob",
            d: vec![0.0; 5],
            k: [500.0, 0.0, 319.5, 0.0, 510.0, 239.5, 0.0, 0.0, 1.0],
            r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            p: [400.0, 0.0, 300.0, 0.0, 0.0, 410.0, 200.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            binning: [0, 0],
            region: [0; 4],
        }
    }

    #[test]
    fn a_pixel_counts_from_its_corner() {
        let info = pinhole(&message(), false).unwrap();
        assert_eq!(info, CameraInfo { width: 640, height: 480, fx: 500.0, fy: 510.0, cx: 320.0, cy: 240.0 });
    }

    #[test]
    fn a_part_of_the_sensor_in_coarser_pixels_sees_the_same_ray() {
        let part = ros::CameraInfo { binning: [2, 2], region: [100, 40, 400, 320], ..message() };
        let info = pinhole(&part, false).unwrap();
        assert_eq!((info.width, info.height), (200, 160));
        // The corner at column 300 of the sensor is the corner at column (300 - 100) / 2 of the image.
        let whole = pinhole(&message(), false).unwrap();
        assert_abs_diff_eq!((100.0 - info.cx) / info.fx, (300.0 - whole.cx) / whole.fx, epsilon = 1e-15);
        assert_abs_diff_eq!((80.0 - info.cy) / info.fy, (200.0 - whole.cy) / whole.fy, epsilon = 1e-15);
    }

    #[test]
    fn distortion_is_refused_unless_the_images_are_free_of_it() {
        let distorted = ros::CameraInfo { d: vec![0.1, 0.0], ..message() };
        assert!(pinhole(&distorted, false).unwrap_err().1.contains("rectify"));
        assert_eq!(pinhole(&distorted, true).unwrap().fx, 400.0);
        assert!(is_rectified("/front/image_rect_color/compressed") && !is_rectified("/rectifier/image_raw"));
        let blind = ros::CameraInfo { k: [0.0; 9], ..message() };
        assert!(pinhole(&blind, false).is_err());
    }

    #[test]
    fn an_optical_frame_is_turned_so_that_x_looks_ahead() {
        // The standard joint from a camera to its optical frame: roll -90°, yaw -90°.
        let optical = UnitQuaternion::new_normalize(Quaternion::new(0.5, -0.5, 0.5, -0.5));
        let in_body = Pose3 { translation: Vector3::new(0.1, 0.0, 0.2), rotation: optical };
        let turned = mount("front_optical_frame", &in_body);
        assert!(turned.rotation.angle() < 1e-12, "{turned:?}");
        assert_eq!(mount("camera_link", &in_body), in_body);
    }

    #[test]
    fn the_calibration_is_beside_the_images() {
        assert_eq!(info_topic("/front/image_raw/compressed"), "/front/camera_info");
        assert_eq!(info_topic("/image_raw"), "/camera_info");
    }
}
