use std::collections::BTreeMap;

use wayfix_encoded_image::compressed_message;
use wayfix_estimation_traits::{Pose2, Pose3};

use super::kind::{BagRoute, Kind};
use super::motion::{Odometer, planar};
use super::probe::ODOMETRY_FRAME;
use super::scan::Mount;
use super::transforms::{Transforms, is_body, last_part};
use super::{Choice, camera, measurement, scan};
use crate::fault::{Fault, finite, inconsistent, spatial, unreadable_image};
use crate::formats::format::shortened;
use crate::planar::heading_of;
use crate::ros::{self, Header, RosMessage, Twist};
use crate::{EncodedImage, LaserScan, Record, RecordData, RowProblemKind, Stamp, Velocity};

/// The fixed frame that localization places the robot in. [REP 105]
const MAP_FRAME: &str = "map";
const LASER: &str = "laser";
const CAMERA: &str = "camera";
const IMU: &str = "IMU";

/// Makes records of the messages of a bag, one after the other: some only mean something together.
#[derive(Debug, Default)]
pub(crate) struct BagRecords {
    choice: Choice,
    transforms: Transforms,
    odometer: Odometer,
    /// The robot's frame, as odometry calls it.
    body: Option<String>,
    camera_mount: Option<Pose3<f64>>,
    laser_mount: Option<Mount>,
    /// Number of changes of the laser's mount.
    n_laser_mounts: usize,
    /// Frames of scans and images without a transform to the robot so far.
    unplaced: BTreeMap<&'static str, String>,
    /// Whether a scan states no maximum range.
    lacks_range_limit: bool,
    /// Faults of parts of messages since the last call of `take_faults`.
    faults: Vec<Fault>,
}

impl BagRecords {
    pub(crate) fn new(choice: Choice) -> Self {
        Self { choice, ..Self::default() }
    }

    /// Kind that a message on this topic is read as.
    pub(crate) fn route(&self, topic: &str, schema: &str) -> Option<BagRoute> {
        self.choice.route(topic, schema)
    }

    /// The records in a message; one without a stamp gets its log time.
    pub(crate) fn take(
        &mut self,
        (schema, kind): BagRoute,
        bytes: &[u8],
        log_time: Stamp,
    ) -> Result<Vec<Record>, Fault> {
        let message =
            schema.decode(bytes).map_err(|error| (RowProblemKind::Undecodable, error.to_string()))?;
        let at = |header: &Header<'_>| stamp(header, log_time);
        match message {
            RosMessage::LaserScan(message) => self.scan(at(&message.header)?, &message),
            RosMessage::Image(image) => {
                let stamp = at(&image.header)?;
                Ok(self.image(
                    stamp,
                    image.header.frame_id,
                    image.pixels().uncompressed().map_err(|error| unreadable_image(&error))?,
                ))
            }
            RosMessage::CompressedImage(image) => {
                let stamp = at(&image.header)?;
                Ok(self.image(
                    stamp,
                    image.header.frame_id,
                    compressed_message(image.format, image.data).map_err(|error| unreadable_image(&error))?,
                ))
            }
            RosMessage::CameraInfo(message) => {
                let info = camera::pinhole(&message, self.choice.is_rectified)?;
                Ok(one(at(&message.header)?, RecordData::CameraInfo(info)))
            }
            RosMessage::Odometry(message) => self.odometry(at(&message.header)?, kind, &message),
            RosMessage::Pose(message) => {
                let (stamp, pose) = (at(&message.header)?, planar(&message.pose)?);
                if let (Kind::MeasuredPose, Some(covariance)) = (kind, &message.covariance) {
                    return Ok(one(stamp, measurement::pose(message.header.frame_id, pose, covariance)?));
                }
                Ok(one(
                    stamp,
                    if kind == Kind::TruePose { RecordData::TruePose } else { RecordData::EstimatedPose }(
                        pose,
                    ),
                ))
            }
            RosMessage::Twist(message) => {
                let stamp = message.header.as_ref().map_or(Ok(log_time), at)?;
                Ok(one(stamp, velocity(&message.twist)?))
            }
            RosMessage::NavSatFix(fix) => Ok(one(at(&fix.header)?, measurement::position(&fix)?)),
            RosMessage::Imu(imu) => {
                let mount = self.transforms.in_body(imu.header.frame_id, self.body.as_deref());
                self.note_place(IMU, imu.header.frame_id, mount.is_some());
                Ok(one(at(&imu.header)?, measurement::heading(&imu, mount.as_ref())?))
            }
            RosMessage::Transforms(transforms) => {
                let mut records = Vec::new();
                for transform in &transforms {
                    // As in tf2: a transform that cannot be used is ignored, and the others of its message are not.
                    match self.transform(at(&transform.header), transform) {
                        Ok(found) => records.extend(found),
                        Err(fault) => self.faults.push(fault),
                    }
                }
                Ok(records)
            }
        }
    }

    /// Faults of parts of messages since the last call.
    pub(crate) fn take_faults(&mut self) -> Vec<Fault> {
        std::mem::take(&mut self.faults)
    }

    /// Assumptions made, available after the last message.
    pub(crate) fn warnings(&self) -> Vec<(&'static str, String)> {
        let mut warnings = Vec::new();
        let assumed = [
            (
                LASER,
                "laser_mount_unknown",
                "the laser is taken to be at the robot's centre (the parameter `laser = [x, y, heading]` places it)",
            ),
            (CAMERA, "camera_mount_unknown", "images have no camera mount"),
            (IMU, "imu_mount_unknown", "its axes are taken to be those of the robot"),
        ];
        for (sensor, name, assumption) in assumed {
            if let Some(frame) = self.unplaced.get(sensor) {
                let frame = shortened(frame);
                let text = format!(
                    "no transform leads from the robot to the {sensor}'s frame {frame:?}: {assumption}"
                );
                warnings.push((name, text));
            }
        }
        if self.lacks_range_limit {
            let text = "scans state no largest range (range_max): every finite range counts as an echo";
            warnings.push(("range_limit_unknown", text.to_owned()));
        }
        if self.n_laser_mounts > 1 {
            let text =
                format!("the laser moves on the robot: its mount changes {} times", self.n_laser_mounts - 1);
            warnings.push(("laser_mount_moves", text));
        }
        warnings
    }

    /// Notes whether a scan states its maximum range.
    pub(crate) fn note_range_limit(&mut self, scan: &LaserScan) {
        self.lacks_range_limit |= scan.range_max == f64::INFINITY;
    }

    fn scan(&mut self, stamp: Stamp, message: &ros::LaserScan<'_>) -> Result<Vec<Record>, Fault> {
        let laser = self.transforms.in_body(message.header.frame_id, self.body.as_deref());
        self.note_place(LASER, message.header.frame_id, laser.is_some());
        let mount = laser.as_ref().map(Mount::of).transpose()?;
        let scan = scan::scan(message, mount.as_ref())?;
        let mut records = Vec::new();
        if let Some(mount) = mount
            && self.laser_mount.replace(mount) != Some(mount)
        {
            self.n_laser_mounts += 1;
            records.extend(one(stamp, RecordData::LaserMount(mount.pose)));
        }
        records.extend(one(stamp, RecordData::Scan(scan)));
        Ok(records)
    }

    fn image(&mut self, stamp: Stamp, frame: &str, image: EncodedImage) -> Vec<Record> {
        let mut records = Vec::new();
        let placed = self.transforms.in_body(frame, self.body.as_deref());
        self.note_place(CAMERA, frame, placed.is_some());
        if let Some(frame_in_body) = placed {
            let mount = camera::mount(frame, &frame_in_body);
            if self.camera_mount.replace(mount) != Some(mount) {
                records.extend(one(stamp, RecordData::CameraMount(mount)));
            }
        }
        records.extend(one(stamp, RecordData::Image(image)));
        records
    }

    /// Notes whether a sensor's frame has a transform to the robot; a transform may come later.
    fn note_place(&mut self, sensor: &'static str, frame: &str, is_placed: bool) {
        if is_placed {
            self.unplaced.remove(sensor);
        } else {
            self.unplaced.entry(sensor).or_insert_with(|| frame.to_owned());
        }
    }

    fn odometry(
        &mut self,
        stamp: Stamp,
        kind: Kind,
        message: &ros::Odometry<'_>,
    ) -> Result<Vec<Record>, Fault> {
        if kind == Kind::TruePose {
            return Ok(one(stamp, RecordData::TruePose(planar(&message.pose)?)));
        }
        if self.body.as_deref() != Some(message.child_frame_id) {
            self.body = Some(message.child_frame_id.to_owned());
        }
        if self.choice.moves_by_twist {
            return Ok(one(stamp, velocity(&message.twist)?));
        }
        let increment = self.odometer.increment(stamp, planar(&message.pose)?)?;
        Ok(increment.map_or_else(Vec::new, |increment| one(stamp, RecordData::OdometryIncrement(increment))))
    }

    /// The stamp matters only for motions: a static transform holds at any time.
    fn transform(
        &mut self,
        stamp: Result<Stamp, Fault>,
        message: &ros::TransformStamped<'_>,
    ) -> Result<Vec<Record>, Fault> {
        let (parent, child) = (message.header.frame_id, message.child_frame_id);
        if parent.is_empty() || child.is_empty() || parent == child {
            let [parent, child] = [parent, child].map(shortened);
            return Err(inconsistent(&format!("transform from {parent:?} to {child:?}")));
        }
        let pose = spatial(message.transform.position, message.transform.orientation)?;
        self.transforms.insert(parent, child, pose);
        let mut records = Vec::new();
        if !is_body(child) {
            return Ok(records);
        }
        let stamp = stamp?;
        let is_odometry = last_part(parent) == ODOMETRY_FRAME;
        if is_odometry && self.choice.moves_by_transforms {
            let increment = self.odometer.increment(stamp, on_the_ground(&pose))?;
            records.extend(increment.map(|step| Record { stamp, data: RecordData::OdometryIncrement(step) }));
        }
        if (is_odometry || last_part(parent) == MAP_FRAME)
            && self.choice.estimates_by_transforms
            && let Some(on_map) = self.transforms.in_ancestor(child, MAP_FRAME)
        {
            records.extend(one(stamp, RecordData::EstimatedPose(on_the_ground(&on_map))));
        }
        Ok(records)
    }
}

fn one(stamp: Stamp, data: RecordData) -> Vec<Record> {
    vec![Record { stamp, data }]
}

/// A header without a time was not filled in.
fn stamp(header: &Header<'_>, log_time: Stamp) -> Result<Stamp, Fault> {
    const NANOSECONDS: u64 = 1_000_000_000;
    let (sec, nanosec) = (header.sec, header.nanosec);
    match u64::try_from(sec) {
        Ok(0) if nanosec == 0 => Ok(log_time),
        Ok(seconds) if u64::from(nanosec) < NANOSECONDS => {
            Ok(Stamp::from_nanoseconds(seconds * NANOSECONDS + u64::from(nanosec)))
        }
        _ => Err((RowProblemKind::BadStamp, format!("time stamp of {sec} s and {nanosec} ns"))),
    }
}

fn velocity(twist: &Twist) -> Result<RecordData, Fault> {
    let (linear, angular) = (twist.linear[0], twist.angular[2]);
    finite([linear, angular])?;
    Ok(RecordData::Velocity(Velocity { linear, angular }))
}

fn on_the_ground(pose: &Pose3<f64>) -> Pose2<f64> {
    let (t, q) = (pose.translation, pose.rotation);
    Pose2::new(t.x, t.y, heading_of([q.i, q.j, q.k, q.w]))
}
