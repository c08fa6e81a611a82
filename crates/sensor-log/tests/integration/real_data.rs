//! Public recordings, when the environment variable `WAYFIX_DATA` names the folder that holds them.
//!
//! Expected counts are those of the files' rows, counted with `grep -vc '^#'` and `sort -u`.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use std::collections::BTreeMap;
use std::path::PathBuf;

use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{
    DetectionTarget, LogOpenOptions, PoseRelation, Record, RecordData, RowProblemKind, Stamp, open,
    read_relations,
};

fn data_folder() -> Option<PathBuf> {
    let folder = std::env::var_os("WAYFIX_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: WAYFIX_DATA is not set");
    }
    folder
}

fn count(records: &[Record], is_counted: impl Fn(&RecordData) -> bool) -> usize {
    records.iter().filter(|record| is_counted(&record.data)).count()
}

fn in_time_order(records: &[Record]) -> bool {
    records.is_sorted_by_key(|record| record.stamp)
}

#[test]
fn utias_set_7() {
    let Some(folder) = data_folder() else { return };
    // robot, truth rows, odometry rows, measurement rows, different measurement stamps
    for (robot, n_true, n_odometry, n_detections, n_looks) in UTIAS_ROWS {
        let options = LogOpenOptions { robot: Some(robot), ..Default::default() };
        let (records, report) =
            open(folder.join("utias_mrclam/MRCLAM_Dataset7"), &options).unwrap().read_all();
        assert_eq!(report.n_problems(), 0, "{report}");
        assert!(in_time_order(&records));
        assert_eq!(count(&records, |data| matches!(data, RecordData::TruePose(_))), n_true);
        assert_eq!(count(&records, |data| matches!(data, RecordData::Velocity(_))), n_odometry);
        assert_eq!(count(&records, |data| matches!(data, RecordData::TrueLandmark(_))), 15);
        let looks: Vec<_> = records
            .iter()
            .filter_map(|record| match &record.data {
                RecordData::Detections(look) => Some(look),
                _ => None,
            })
            .collect();
        assert_eq!(looks.len(), n_looks);
        assert_eq!(looks.iter().map(|look| look.len()).sum::<usize>(), n_detections);
        let landmark_ids = looks.iter().flat_map(|look| look.iter()).filter_map(|s| match s.target {
            DetectionTarget::Landmark(id) => Some(id),
            _ => None,
        });
        assert!(
            landmark_ids.clone().all(|id| (6..=20).contains(&id)) && landmark_ids.count() > n_detections / 2
        );
    }
}

#[test]
fn victoria_park() {
    let Some(folder) = data_folder() else { return };
    let (records, report) =
        open(folder.join("victoria_park"), &LogOpenOptions::default()).unwrap().read_all();
    // One fix is more than 30 m from both its neighbours, by a separate program.
    assert_eq!((report.rows_read, report.n_problems()), (61945 + 52974 + 4465, 1), "{report}");
    assert!(in_time_order(&records));
    assert_eq!(count(&records, |data| matches!(data, RecordData::Ackermann(_))), 61945);
    assert_eq!(count(&records, |data| matches!(data, RecordData::TruePosition(_))), 4465);
    let looks: Vec<_> = records
        .windows(2)
        .filter_map(|pair| match (&pair[0].data, &pair[1].data) {
            (RecordData::DetectionWidths(widths), RecordData::Detections(look)) => Some((widths, look)),
            _ => None,
        })
        .collect();
    assert_eq!(looks.len(), 7230);
    assert!(looks.iter().all(|(widths, look)| widths.len() == look.len()));
    assert_eq!(looks.iter().map(|(_, look)| look.len()).sum::<usize>(), 52974);
    let bearings = looks.iter().flat_map(|(_, look)| look.iter()).map(|detection| detection.bearing);
    assert!(
        bearings.clone().all(|bearing| bearing.abs() < std::f64::consts::FRAC_PI_2),
        "the laser looks ahead"
    );
}

#[test]
fn carmen_logs() {
    let Some(folder) = data_folder() else { return };
    for (name, n_scans, n_beams, n_not_later) in CARMEN_ROWS {
        let path = folder.join("carmen").join(format!("{name}-corrected.log.gz"));
        let (records, report) = open(path, &LogOpenOptions::default()).unwrap().read_all();
        assert!(in_time_order(&records));
        assert_eq!(
            count(&records, |data| matches!(data, RecordData::Scan(s) if s.ranges.len() == n_beams)),
            n_scans
        );
        assert_eq!(count(&records, |data| matches!(data, RecordData::EstimatedPose(_))), n_scans);
        assert_eq!(count(&records, |data| matches!(data, RecordData::OdometryIncrement(_))), n_scans - 1);
        assert_eq!(
            report.problems.get(&RowProblemKind::NotLater).copied().unwrap_or(0),
            n_not_later,
            "{name}"
        );
        assert_eq!(report.n_problems(), n_not_later, "{name}: {report}");
        assert_eq!(report.ignored["NEFF"], n_scans as u64);
    }
}

/// Median and ninth decile of the distances between the translations of two rows of increments.
fn distances(a: &[Pose2<f64>], b: &[Pose2<f64>]) -> (f64, f64) {
    let distance = |(a, b): (&Pose2<f64>, &Pose2<f64>)| (a.x() - b.x()).hypot(a.y() - b.y());
    let mut distances: Vec<f64> = a.iter().zip(b).map(distance).collect();
    distances.sort_by(f64::total_cmp);
    (distances[distances.len() / 2], distances[distances.len() * 9 / 10])
}

fn increments(records: &[Record]) -> Vec<Pose2<f64>> {
    let increment = |record: &Record| match record.data {
        RecordData::OdometryIncrement(step) => Some(step),
        _ => None,
    };
    records.iter().filter_map(increment).collect()
}

#[test]
fn corrected_carmen_log_has_the_odometry_of_the_raw_log() {
    let Some(folder) = data_folder() else { return };
    let read = |name: &str| open(folder.join(name), &LogOpenOptions::default()).unwrap().read_all().0;
    let carmen = increments(&read("carmen/intel-corrected.log.gz"));
    let raw = increments(&read("intel_raw/intel_gfs.json.gz"));
    let corrected = increments(&read("intel_raw/intel_corrected.json.gz"));
    assert_eq!((carmen.len(), raw.len(), corrected.len()), (909, 909, 909));
    // Both files print some six digits of metres, rounded once more in each; a few scans are in another order.
    let (median, ninth) = distances(&carmen, &raw);
    assert!(median < 1e-4 && ninth < 1e-3, "{median} {ninth}");
    let (median, _) = distances(&carmen, &corrected);
    assert!(median > 1e-2, "corrections are centimetres a scan: {median}");
}

#[test]
fn intel_relations_fit_the_corrected_poses() {
    let Some(folder) = data_folder() else { return };
    let (relations, report) = read_relations(folder.join("intel_raw/intel.relations")).unwrap();
    assert_eq!(report.n_problems(), 0);
    let mean_error = |name: &str| {
        let log = open(folder.join("intel_raw").join(name), &LogOpenOptions::default()).unwrap();
        let poses: BTreeMap<Stamp, Pose2<f64>> = log
            .filter_map(|record| match record.data {
                RecordData::EstimatedPose(pose) => Some((record.stamp, pose)),
                _ => None,
            })
            .collect();
        // The nearest pose, at most 10 ms away.
        let pose_at = |stamp: Stamp| {
            let near = [poses.range(..=stamp).next_back(), poses.range(stamp..).next()];
            let away = |at: &Stamp| at.seconds_since(stamp).abs();
            let nearest = near.into_iter().flatten().min_by(|a, b| away(a.0).total_cmp(&away(b.0)));
            nearest.filter(|(at, _)| away(at) <= 0.01).map(|(_, pose)| *pose)
        };
        let error = |relation: &PoseRelation| {
            let moved = pose_at(relation.from)?.inverse().compose(&pose_at(relation.to)?);
            let error = relation.pose.inverse().compose(&moved);
            Some(error.x().hypot(error.y()))
        };
        let errors: Vec<f64> = relations.iter().filter_map(error).collect();
        (errors.len(), errors.iter().sum::<f64>() / errors.len() as f64)
    };
    // 148 relations whose stamps match, 0.109 m and 4.48 m, by a separate program.
    let (n_corrected, corrected) = mean_error("intel_corrected.json.gz");
    let (n_raw, raw) = mean_error("intel_gfs.json.gz");
    assert_eq!((n_corrected, n_raw), (148, 148));
    assert_abs_diff_eq!(corrected, 0.109, epsilon = 1e-3);
    assert_abs_diff_eq!(raw, 4.48, epsilon = 1e-2);
}

#[test]
fn simulated_range_bearing_logs() {
    let Some(folder) = data_folder() else { return };
    for (name, n_landmarks) in [("slam_100", 100), ("slam_200", 200), ("slam_400", 400)] {
        let path = folder.join("range_bearing").join(name).with_extension("txt");
        let (records, report) = open(path, &LogOpenOptions::default()).unwrap().read_all();
        assert_eq!(report.n_problems(), 0, "{report}");
        assert!(in_time_order(&records));
        assert_eq!(count(&records, |data| matches!(data, RecordData::TrueLandmark(_))), n_landmarks);
        assert_eq!(count(&records, |data| matches!(data, RecordData::OdometryIncrement(_))), 500);
        assert_eq!(count(&records, |data| matches!(data, RecordData::TruePose(_))), 500);
        assert!(
            abs_diff_eq!(records.last().unwrap().stamp.seconds(), 49.9, epsilon = 1e-9),
            "500 steps of 0.1 s"
        );
    }
}

const UTIAS_ROWS: [(u32, usize, usize, usize, usize); 3] =
    [(1, 58389, 58598, 3228, 2032), (2, 56529, 60936, 4518, 2585), (3, 53545, 55085, 5399, 2719)];

/// Log, scans, beams, and stamps that are not later than the one before, counted by a separate program.
const CARMEN_ROWS: [(&str, usize, usize, u64); 5] = [
    ("intel", 910, 180, 4),
    ("freiburg-079", 4791, 360, 0),
    ("csail", 406, 361, 404),
    ("belgioioso", 395, 361, 394),
    ("edmonton", 340, 180, 0),
];
