//! Bags made up for tests, message by message.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;

use mcap::WriteOptions;
use mcap::records::MessageHeader;
use wayfix_sensor_log::{LogError, LogOpenOptions, ReadReport, Record, open};

use super::cdr::Encoder;

pub(crate) const ODOMETRY: &str = "nav_msgs/msg/Odometry";
pub(crate) const SCAN: &str = "sensor_msgs/msg/LaserScan";
pub(crate) const TRANSFORMS: &str = "tf2_msgs/msg/TFMessage";
pub(crate) const POSE: &str = "geometry_msgs/msg/PoseStamped";

/// Messages of a made-up bag, written in the order of the calls.
pub(crate) struct Bag {
    writer: mcap::Writer<Cursor<Vec<u8>>>,
    channels: BTreeMap<&'static str, u16>,
}

impl Bag {
    pub(crate) fn new() -> Self {
        Self::with(WriteOptions::new())
    }

    pub(crate) fn with(options: WriteOptions) -> Self {
        Self { writer: options.create(Cursor::new(Vec::new())).unwrap(), channels: BTreeMap::new() }
    }

    pub(crate) fn put(&mut self, topic: &'static str, schema: &str, log_time: u64, message: Encoder) {
        self.put_bytes(topic, schema, log_time, &message.finish());
    }

    pub(crate) fn put_bytes(&mut self, topic: &'static str, schema: &str, log_time: u64, bytes: &[u8]) {
        let writer = &mut self.writer;
        let channel_id = *self.channels.entry(topic).or_insert_with(|| {
            let schema = writer.add_schema(schema, "ros2msg", b"").unwrap();
            writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).unwrap()
        });
        let header = MessageHeader { channel_id, sequence: 0, log_time, publish_time: log_time };
        self.writer.write_to_known_channel(&header, bytes).unwrap();
    }

    pub(crate) fn finish(mut self) -> Vec<u8> {
        self.writer.finish().unwrap();
        self.writer.into_inner().into_inner()
    }

    pub(crate) fn read(self) -> (Vec<Record>, ReadReport) {
        read(&self.finish(), &[]).unwrap()
    }
}

pub(crate) fn read(bytes: &[u8], topics: &[&str]) -> Result<(Vec<Record>, ReadReport), LogError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag.mcap");
    fs::write(&path, bytes).unwrap();
    let topics = topics.iter().map(|&topic| topic.to_owned()).collect();
    open(&path, &LogOpenOptions { topics, ..Default::default() }).map(|log| log.read_all())
}

/// A message that begins with a header of so many seconds.
pub(crate) fn at(seconds: i32, frame: &str) -> Encoder {
    let mut cdr = Encoder::new(true);
    cdr.header(seconds, 0, frame);
    cdr
}

pub(crate) fn quaternion(heading: f64) -> [f64; 4] {
    [0.0, 0.0, (0.5 * heading).sin(), (0.5 * heading).cos()]
}

pub(crate) fn odometry(seconds: i32, pose: [f64; 3], speed: f64) -> Encoder {
    odometry_with(seconds, pose, [speed, 0.5])
}

/// Odometry with a speed and a turn rate.
pub(crate) fn odometry_with(seconds: i32, pose: [f64; 3], [speed, turn]: [f64; 2]) -> Encoder {
    let mut cdr = at(seconds, "odom");
    cdr.string("base_link");
    cdr.f64s(&[pose[0], pose[1], 0.0]);
    cdr.f64s(&quaternion(pose[2]));
    cdr.f64s(&[0.0; 36]);
    cdr.f64s(&[speed, 0.0, 0.0, 0.0, 0.0, turn]);
    cdr.f64s(&[0.0; 36]);
    cdr
}

pub(crate) fn scan(seconds: i32, ranges: &[f32]) -> Encoder {
    let mut cdr = at(seconds, "laser");
    [-0.5, 0.5, 0.25, 0.0, 0.1, 0.1, 10.0].iter().for_each(|number| cdr.f32(*number));
    cdr.f32s(ranges);
    cdr.f32s(&[]);
    cdr
}

pub(crate) fn transforms(frames: &[(i32, &str, &str, [f64; 3])]) -> Encoder {
    let mut cdr = Encoder::new(true);
    cdr.u32(frames.len() as u32);
    for (seconds, parent, child, [x, y, heading]) in frames {
        cdr.header(*seconds, 0, parent);
        cdr.string(child);
        cdr.f64s(&[*x, *y, 0.5]);
        cdr.f64s(&quaternion(*heading));
    }
    cdr
}

pub(crate) fn pose(seconds: i32, [x, y, heading]: [f64; 3]) -> Encoder {
    let mut cdr = at(seconds, "map");
    cdr.f64s(&[x, y, 0.0]);
    cdr.f64s(&quaternion(heading));
    cdr
}

pub(crate) fn twist(linear: f64) -> Encoder {
    let mut cdr = Encoder::new(true);
    cdr.f64s(&[linear, 0.0, 0.0, 0.0, 0.0, 0.25]);
    cdr
}
