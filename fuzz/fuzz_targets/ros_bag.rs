//! A bag: messages of arbitrary bytes on topics of every type, opened as a user would.
//!
//! Each message of the input is a byte for its topic, a byte for its length and as many bytes.
#![no_main]

use std::collections::BTreeMap;
use std::io::Cursor;

use libfuzzer_sys::fuzz_target;
use mcap::WriteOptions;
use mcap::records::MessageHeader;
use wayfix_sensor_log::{LogOpenOptions, open};

const TOPICS: [(&str, &str); 14] = [
    ("/scan", "sensor_msgs/msg/LaserScan"),
    ("/rear", "sensor_msgs/LaserScan"),
    ("/odom", "nav_msgs/msg/Odometry"),
    ("/ground_truth", "nav_msgs/msg/Odometry"),
    ("/tf", "tf2_msgs/msg/TFMessage"),
    ("/tf_static", "tf2_msgs/msg/TFMessage"),
    ("/left/image_raw", "sensor_msgs/msg/Image"),
    ("/right/image_rect", "sensor_msgs/msg/Image"),
    ("/left/camera_info", "sensor_msgs/msg/CameraInfo"),
    ("/left/image_raw/compressed", "sensor_msgs/msg/CompressedImage"),
    ("/mocap", "geometry_msgs/msg/PoseStamped"),
    ("/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped"),
    ("/cmd_vel", "geometry_msgs/msg/Twist"),
    ("/twist", "geometry_msgs/msg/TwistStamped"),
];

fuzz_target!(|input: &[u8]| {
    let bag = bag(input);
    let mut file = tempfile::Builder::new().suffix(".mcap").tempfile().expect("a place for the bag");
    std::io::Write::write_all(&mut file, &bag).expect("room for the bag");
    if let Ok(log) = open(file.path(), &LogOpenOptions::default()) {
        let (records, _) = log.read_all();
        assert!(records.is_sorted_by_key(|record| record.stamp));
    }
});

fn bag(mut input: &[u8]) -> Vec<u8> {
    let mut writer = WriteOptions::new()
        .compression(None)
        .create(Cursor::new(Vec::new()))
        .expect("an empty bag");
    let mut channels = BTreeMap::new();
    while let [topic, n_bytes, rest @ ..] = input {
        let (topic, schema) = TOPICS[usize::from(*topic) % TOPICS.len()];
        let (bytes, after) = rest.split_at(usize::from(*n_bytes).min(rest.len()));
        input = after;
        let channel_id = *channels.entry(topic).or_insert_with(|| {
            let schema = writer.add_schema(schema, "ros2msg", b"").expect("a schema");
            writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).expect("a channel")
        });
        let header = MessageHeader { channel_id, sequence: 0, log_time: 0, publish_time: 0 };
        writer.write_to_known_channel(&header, bytes).expect("a message");
    }
    writer.finish().expect("an index");
    writer.into_inner().into_inner()
}
