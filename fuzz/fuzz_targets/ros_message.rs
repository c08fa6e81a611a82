//! One message: the first byte says of which type, the rest are its bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use wayfix_sensor_log::ros::{RosMessage, RosSchema};

const TYPES: [&str; 10] = [
    "sensor_msgs/msg/LaserScan",
    "nav_msgs/msg/Odometry",
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CompressedImage",
    "sensor_msgs/msg/CameraInfo",
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/Twist",
    "tf2_msgs/msg/TFMessage",
];

fuzz_target!(|input: &[u8]| {
    let Some((choice, bytes)) = input.split_first() else { return };
    let schema = RosSchema::named(TYPES[usize::from(*choice) % TYPES.len()]).expect("it is read");
    let held = match schema.decode(bytes) {
        Ok(RosMessage::LaserScan(scan)) => 4 * (scan.ranges.capacity() + scan.intensities.capacity()),
        Ok(RosMessage::CameraInfo(info)) => 8 * info.d.capacity(),
        Ok(RosMessage::Transforms(transforms)) => 72 * transforms.len(),
        _ => 0,
    };
    assert!(held <= bytes.len(), "{held} bytes held of {}", bytes.len());
});
