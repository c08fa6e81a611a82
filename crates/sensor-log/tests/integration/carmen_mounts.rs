//! What the reader of CARMEN logs takes from the two poses of a scan and from the messages that hold one.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::assert_abs_diff_eq;
use std::fs;
use std::path::Path;

use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_sensor_log::{LogOpenOptions, ReadReport, Record, RecordData, open};

fn scan_line(n_beams: usize, range: &str, pose: &str, odometry: &str, seconds: f64) -> String {
    let ranges = format!("{range} ").repeat(n_beams);
    format!("FLASER {n_beams} {ranges}{pose} {odometry} {seconds} host {seconds}\n")
}

fn read(path: &Path, bytes: &[u8]) -> (Vec<Record>, ReadReport) {
    fs::write(path, bytes).unwrap();
    open(path, &LogOpenOptions::default()).unwrap().read_all()
}

fn n_scans(records: &[Record]) -> usize {
    records.iter().filter(|record| matches!(record.data, RecordData::Scan(_))).count()
}

/// The warnings of a log, by name.
fn warned(report: &ReadReport) -> Vec<&str> {
    report.warnings.iter().map(|warning| warning.name).collect()
}

/// A drive of ten scans through an arc: what the laser, which is at `mount`, and the robot's odometry say; `(pose, odometry)` of each line.
fn arc(mount: Pose2<f64>, pose: impl Fn(u32, &Pose2<f64>) -> Pose2<f64>) -> Vec<(String, String)> {
    let shown = |pose: &Pose2<f64>| format!("{:.6} {:.6} {:.6}", pose.x(), pose.y(), pose.heading());
    let line = |k: u32| {
        let (sin, cos) = (0.2 * f64::from(k)).sin_cos();
        let robot = Pose2::new(5.0 + 2.0 * sin, 3.0 - 2.0 * cos, 0.2 * f64::from(k));
        (shown(&pose(k, &robot).compose(&mount)), shown(&robot))
    };
    (0..10).map(line).collect()
}

fn log_of(poses: &[(String, String)]) -> String {
    let line = |(k, (pose, odometry)): (usize, &(String, String))| {
        scan_line(181, "1", pose, odometry, 100.0 + 0.1 * k as f64)
    };
    poses.iter().enumerate().map(line).collect()
}

/// Mounts and poses of a log; every increment must be that of the arc.
fn mounts_and_poses(records: &[Record]) -> (Vec<Pose2<f64>>, Vec<Pose2<f64>>) {
    let (mut mounts, mut poses) = (Vec::new(), Vec::new());
    for record in records {
        match &record.data {
            RecordData::LaserMount(mount) => mounts.push(*mount),
            RecordData::EstimatedPose(pose) => poses.push(*pose),
            RecordData::OdometryIncrement(step) => {
                assert_abs_diff_eq!(step.heading(), 0.2, epsilon = 1e-5);
                assert_abs_diff_eq!(step.x().hypot(step.y()), 4.0 * 0.1_f64.sin(), epsilon = 1e-5);
            }
            _ => {}
        }
    }
    (mounts, poses)
}

fn near(a: &Pose2<f64>, b: &Pose2<f64>) -> bool {
    a.local(b).norm() < 1e-5
}

#[test]
fn the_difference_of_both_poses_is_the_lasers_mount() {
    let folder = tempfile::tempdir().unwrap();
    for mount in [Pose2::new(0.4, 0.0, 0.0), Pose2::new(-0.2, 0.1, 3.1)] {
        let text = log_of(&arc(mount, |_, robot| *robot));
        let (records, report) = read(&folder.path().join("ahead.log"), text.as_bytes());
        let (mounts, poses) = mounts_and_poses(&records);
        assert!(mounts.len() == 1 && near(&mounts[0], &mount), "{mounts:?}");
        assert!(matches!(records[0].data, RecordData::LaserMount(_)));
        assert!(poses.is_empty(), "they are the odometry");
        assert_eq!(warned(&report), ["laser_mount_from_poses", "poses_are_odometry"]);
        assert_eq!((n_scans(&records), report.n_problems()), (10, 0));
    }
}

#[test]
fn poses_of_a_mapper_are_the_robots_and_their_drift_no_mount() {
    let folder = tempfile::tempdir().unwrap();
    let mount = Pose2::new(0.4, 0.0, 0.0);
    let corrected = |k: u32, robot: &Pose2<f64>| Pose2::new(0.05 * f64::from(k), 0.0, 0.0).compose(robot);
    let text = "PARAM robot_frontlaser_offset 0.4 nohost 0\n".to_owned() + &log_of(&arc(mount, corrected));
    let (records, report) = read(&folder.path().join("corrected.log"), text.as_bytes());
    let (mounts, poses) = mounts_and_poses(&records);
    assert_eq!(mounts, [mount]);
    assert_eq!(warned(&report), ["laser_mount_from_parameters"]);
    // At the start the mapper and the odometry are one: (5, 1, 0).
    assert!(poses.len() == 10 && near(&poses[0], &Pose2::new(5.0, 1.0, 0.0)), "{poses:?}");

    let (records, report) =
        read(&folder.path().join("no-mount.log"), log_of(&arc(mount, corrected)).as_bytes());
    assert!(mounts_and_poses(&records).0.is_empty() && report.is_clean());
}

#[test]
fn poses_that_are_odometry_are_left_out_even_beside_a_bad_row() {
    let folder = tempfile::tempdir().unwrap();
    let centre = Pose2::new(0.0, 0.0, 0.0);
    let other_frame = Pose2::new(-7.0, 2.0, 1.5);
    for frame in [centre, other_frame] {
        let mut drive = arc(centre, |_, robot| frame.compose(robot));
        drive[4].0 = "1e9 0 0".to_owned();
        let (records, report) = read(&folder.path().join("raw.log"), log_of(&drive).as_bytes());
        let (mounts, poses) = mounts_and_poses(&records);
        assert!(mounts.is_empty() && poses.is_empty(), "{mounts:?} {poses:?}");
        assert_eq!(warned(&report), ["poses_are_odometry"]);
    }
}

#[test]
fn parameters_tell_the_mount_of_a_raw_log_with_equal_poses() {
    let folder = tempfile::tempdir().unwrap();
    let drive = log_of(&arc(Pose2::new(0.0, 0.0, 0.0), |_, robot| *robot));
    let parameters =
        "PARAM robot_frontlaser_offset 0.3 nohost 0\nPARAM robot_frontlaser_side_offset -0.1 h 0\n";
    let (records, report) = read(&folder.path().join("raw.log"), (parameters.to_owned() + &drive).as_bytes());
    assert_eq!(mounts_and_poses(&records).0, [Pose2::new(0.3, -0.1, 0.0)]);
    assert_eq!(warned(&report), ["laser_mount_from_parameters", "poses_are_odometry"]);
}

/// The line of another program for the same scan.
fn robot_laser(line: &str) -> String {
    let columns: Vec<&str> = line.split_whitespace().collect();
    let (ranges, rest) = columns[1..].split_at(182);
    let poses = rest[..6].join(" ");
    let times = rest[6..].join(" ");
    let stated = "0 -1.570796 3.141593 0.017453 80.0 0.01 0";
    format!("ROBOTLASER1 {stated} {} 0 {poses} 0.1 0 0.5 0.3 0 {times}\n", ranges.join(" "))
}

#[test]
fn scans_of_either_message_are_read_and_none_twice() {
    let folder = tempfile::tempdir().unwrap();
    let mount = Pose2::new(0.4, 0.0, 0.0);
    let front = log_of(&arc(mount, |_, robot| *robot));
    let (of_front, _) = read(&folder.path().join("front.log"), front.as_bytes());
    let lines: Vec<&str> = front.lines().collect();
    let either = |(k, line): (usize, &&str)| {
        if k % 2 == 0 { robot_laser(line) } else { format!("{line}\n") }
    };
    let mixed: String = lines.iter().enumerate().map(either).collect();
    let both: String = lines.iter().map(|line| format!("{line}\n{}", robot_laser(line))).collect();
    let second = lines[0].replacen("FLASER", "RLASER", 1)
        + "\nROBOTLASER2 0\nRAWLASER1 0 -1 2 1 8 0.01 0 3 1 1 1 0 100 h 1\n";
    for (name, text, n_again) in [("mixed", mixed, 0), ("both", both, 10)] {
        let (records, report) = read(&folder.path().join(name), (second.clone() + &text).as_bytes());
        let bare = |records: &[Record]| {
            let is_scan = |record: &&Record| matches!(record.data, RecordData::Scan(_));
            let (scans, others): (Vec<_>, Vec<_>) = records.iter().partition(is_scan);
            (
                scans.iter().map(|record| record.stamp).collect::<Vec<_>>(),
                others.into_iter().cloned().collect::<Vec<_>>(),
            )
        };
        assert_eq!(bare(&records), bare(&of_front), "{name}");
        assert_eq!((n_scans(&records), report.n_problems()), (10, 0), "{name}");
        let again: u64 =
            report.ignored.iter().filter(|(word, _)| word.contains("again")).map(|(_, n)| n).sum();
        assert_eq!((again, report.ignored["RLASER"], report.ignored["RAWLASER1"]), (n_again, 1, 1), "{name}");
        assert!(warned(&report).contains(&"other_laser_ignored"), "{name}");
    }
}

#[test]
fn robotlaser_alone_has_the_field_of_view_that_it_states() {
    let folder = tempfile::tempdir().unwrap();
    let line = |t: f64| {
        format!(
            "ROBOTLASER1 0 -2.094395 4.188790 0.00615094 4.0 0.01 0 682 {}0 0.145 0 0 0 0 0 0 0 0 0 0 {t} host {t}\n",
            "5.6 ".repeat(682)
        )
    };
    let (records, report) = read(&folder.path().join("robot.log"), (line(0.0) + &line(0.1)).as_bytes());
    assert_eq!(mounts_of(&records), [Pose2::new(0.145, 0.0, 0.0)]);
    let RecordData::Scan(scan) = &records[1].data else { panic!("{records:?}") };
    assert_abs_diff_eq!(scan.bearing(681), 2.094395, epsilon = 1e-4);
    assert_eq!((scan.range_max, scan.echoes().count(), report.n_problems()), (4.0, 0, 0));
}

fn mounts_of(records: &[Record]) -> Vec<Pose2<f64>> {
    let mount = |record: &Record| match record.data {
        RecordData::LaserMount(mount) => Some(mount),
        _ => None,
    };
    records.iter().filter_map(mount).collect()
}
