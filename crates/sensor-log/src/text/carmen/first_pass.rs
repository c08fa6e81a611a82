use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use wayfix_estimation_traits::{LieGroup, Pose2};

use super::agreement::{common, is_same, is_shifted, lasts};
use super::row::{CarmenRow, ScanMessage, ScanPoses, ScanRow, parse};
use super::trajectory::Trajectory;
use crate::text::Lines;
use crate::text::clock_faults::{ClockFault, clock_faults};
use crate::text::half_circle::warn_of_assumed_field_of_view;
use crate::text::row::stamp_of;
use crate::text::scan_odometry::ScanOdometry;
use crate::{LogError, ReadReport, Stamp};

/// Parameters of the front laser's pose on the robot: ahead, to the left, m, and its heading, rad.
const MOUNT_PARAMETERS: [&str; 3] =
    ["robot_frontlaser_offset", "robot_frontlaser_side_offset", "robot_frontlaser_angular_offset"];

/// Properties that require the whole log, found in a first pass.
#[derive(Default)]
pub(super) struct FirstPass {
    /// Pose of the laser on the robot; the default is the centre.
    pub(super) mount: Option<Pose2<f64>>,
    /// Reference of the laser's poses in the robot frame: the mount, or the centre.
    pub(super) pose_mount: Option<Pose2<f64>>,
    /// Whether the laser's poses differ from those of odometry.
    pub(super) poses_are_estimates: bool,
    /// Stamp faults by line.
    pub(super) faults: BTreeMap<u64, ClockFault>,
    /// First angle and step of the scans that state them, by their number of beams.
    pub(super) angles: BTreeMap<usize, (f64, f64)>,
    /// The `ODOM` lines, where the scans of the log have no poses.
    pub(super) odometry: Option<Trajectory>,
}

/// Data collected from the scans.
#[derive(Default)]
struct Scans {
    /// Lines and stamps.
    stamps: Vec<(u64, Stamp)>,
    poses: Vec<ScanPoses>,
    /// Whether the `ODOM` line at the scan disagrees with the scan's odometry.
    is_corrected: Vec<bool>,
    /// Numbers of beams of scans that do not state their angles.
    unstated: BTreeSet<usize>,
}

/// Data collected from the other lines.
#[derive(Default)]
struct Others {
    trajectory: Trajectory,
    mount: [Option<f64>; 3],
    /// Scans of other lasers.
    lasers: BTreeMap<String, u64>,
}

impl FirstPass {
    /// Reads the log once and reports the assumptions.
    pub(super) fn of(path: &Path, report: &mut ReadReport) -> Result<Self, LogError> {
        let mut first_pass = Self::default();
        let (mut scans, mut raw, mut others) = (Scans::default(), Scans::default(), Others::default());
        let mut odometry = ScanOdometry::default();
        let mut lines = Lines::open(path)?;
        // Errors of lines and of the file are reported in the second pass.
        while let Ok(Some(row)) = lines.next_row() {
            let line = row.number;
            match row.text.and_then(parse) {
                Ok(CarmenRow::Scan(scan)) if scan.message == ScanMessage::Raw => {
                    first_pass.take_angles(&scan);
                    raw.take(line, &scan, &mut odometry);
                }
                Ok(CarmenRow::Scan(scan)) => {
                    first_pass.take_angles(&scan);
                    scans.take(line, &scan, &mut odometry);
                }
                Ok(CarmenRow::Odometry { seconds, pose }) => {
                    odometry.line(seconds, pose);
                    others.trajectory.push(seconds, pose);
                }
                Ok(CarmenRow::Parameter { name, value }) => others.take_parameter(&name, &value),
                Ok(CarmenRow::Other(word)) if word.contains("LASER") => {
                    *others.lasers.entry(word).or_default() += 1;
                }
                Ok(CarmenRow::Other(_)) | Err(_) => {}
            }
        }
        for (word, count) in &others.lasers {
            report.warn(
                "other_laser_ignored",
                format!("{count} {word} scans are not read: only the first laser's are"),
            );
        }
        let stated = others.stated_mount();
        if scans.stamps.is_empty() && !raw.stamps.is_empty() {
            first_pass.odometry = Some(others.trajectory);
            scans = raw;
        }
        first_pass.judge_stamps(&scans);
        first_pass.judge_poses(&scans, stated, report);
        for n_beams in scans.unstated.iter().filter(|n_beams| !first_pass.angles.contains_key(n_beams)) {
            warn_of_assumed_field_of_view(*n_beams, report);
        }
        Ok(first_pass)
    }

    fn take_angles(&mut self, row: &ScanRow) {
        if row.message != ScanMessage::Front {
            let angles = (row.scan.angle_min, row.scan.angle_increment);
            self.angles.entry(row.scan.ranges.len()).or_insert(angles);
        }
    }

    fn judge_stamps(&mut self, scans: &Scans) {
        let stamps: Vec<Stamp> = scans.stamps.iter().map(|(_, stamp)| *stamp).collect();
        let faults = clock_faults(&stamps).into_iter();
        self.faults = faults.filter_map(|(index, fault)| Some((scans.stamps.get(index)?.0, fault))).collect();
    }

    /// The laser's mount is the difference of the two poses if constant, else that of the parameters.
    fn judge_poses(&mut self, scans: &Scans, stated: Option<Pose2<f64>>, report: &mut ReadReport) {
        let apart = scans.poses.iter().map(|poses| poses.odometry.inverse().compose(&poses.laser));
        let difference = common(&apart.collect::<Vec<_>>());
        let is_corrected = lasts(scans.is_corrected.iter().copied());
        let are_odometry = !is_corrected && (difference.is_some() || is_shifted(&scans.poses));
        self.poses_are_estimates = !scans.poses.is_empty() && !are_odometry;
        let are_one = difference.is_some_and(|difference| is_same(&difference, &centre()));
        (self.mount, self.pose_mount) = match (difference, stated) {
            (Some(difference), _) if !are_one => {
                let text = format!(
                    "the two poses of each scan differ by {}: this is taken as the laser's mount; the parameter `laser_pose` sets another",
                    shown(&difference)
                );
                report.warn("laser_mount_from_poses", text);
                (Some(difference), Some(difference))
            }
            (_, Some(stated)) if are_one && is_corrected => {
                let text = format!(
                    "PARAM lines put the laser at {}, but both poses of each corrected scan are the same: no mount is used; the parameter `laser_pose` sets one",
                    shown(&stated)
                );
                report.warn("laser_mount_contradicted", text);
                (None, None)
            }
            (_, Some(stated)) => {
                let text = format!(
                    "PARAM lines put the laser at {}: this is taken as its mount; the parameter `laser_pose` sets another",
                    shown(&stated)
                );
                report.warn("laser_mount_from_parameters", text);
                (Some(stated), Some(stated).filter(|_| !are_one))
            }
            (_, None) => (None, None),
        };
        if !scans.poses.is_empty() && are_odometry {
            report.warn(
                "poses_are_odometry",
                "the poses of the scans are the robot's odometry once more: they are no reference for the path (the option --truth gives one)",
            );
        }
    }
}

impl Scans {
    fn take(&mut self, line: u64, row: &ScanRow, odometry: &mut ScanOdometry) {
        let Ok(stamp) = stamp_of(row.seconds) else { return };
        self.stamps.push((line, stamp));
        if row.message == ScanMessage::Front {
            self.unstated.insert(row.scan.ranges.len());
        }
        if let Some(poses) = row.poses {
            let reached = odometry.reached(row.seconds, poses.odometry);
            self.is_corrected.push(!is_same(&reached, &poses.odometry));
            self.poses.push(poses);
        }
    }
}

impl Others {
    fn take_parameter(&mut self, name: &str, value: &str) {
        let known = MOUNT_PARAMETERS.iter().position(|known| *known == name);
        if let Some(slot) = known.and_then(|index| self.mount.get_mut(index)) {
            *slot = value.parse().ok().filter(|value: &f64| value.is_finite());
        }
    }

    /// The mount in the parameters, unless it is the centre.
    fn stated_mount(&self) -> Option<Pose2<f64>> {
        let [x, y, heading] = self.mount.map(Option::unwrap_or_default);
        Some(Pose2::new(x, y, heading)).filter(|mount| !is_same(mount, &centre()))
    }
}

fn centre() -> Pose2<f64> {
    Pose2::new(0.0, 0.0, 0.0)
}

fn shown(mount: &Pose2<f64>) -> String {
    format!("[{:.3} m, {:.3} m, {:.3} rad]", mount.x(), mount.y(), mount.heading())
}
