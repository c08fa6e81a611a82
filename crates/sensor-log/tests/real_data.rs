//! Public recordings, when the environment variable `WAYFIX_DATA` names the folder that holds them.
//!
//! Expected counts are those of the files' rows, counted with `grep -vc '^#'` and `sort -u`.

use std::path::PathBuf;

use wayfix_sensor_log::{Data, OpenOptions, Record, Target, open};

fn data_folder() -> Option<PathBuf> {
    let folder = std::env::var_os("WAYFIX_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: WAYFIX_DATA is not set");
    }
    folder
}

fn count(records: &[Record], is_counted: impl Fn(&Data) -> bool) -> usize {
    records.iter().filter(|record| is_counted(&record.data)).count()
}

fn in_time_order(records: &[Record]) -> bool {
    records.is_sorted_by_key(|record| record.stamp)
}

#[test]
fn utias_set_7() {
    let Some(folder) = data_folder() else { return };
    // robot, truth rows, odometry rows, measurement rows, different measurement stamps
    for (robot, n_true, n_odometry, n_sightings, n_looks) in UTIAS_ROWS {
        let options = OpenOptions { robot: Some(robot), ..Default::default() };
        let (records, report) =
            open(folder.join("utias_mrclam/MRCLAM_Dataset7"), &options).unwrap().read_all();
        assert_eq!(report.n_problems(), 0, "{report}");
        assert!(in_time_order(&records));
        assert_eq!(count(&records, |data| matches!(data, Data::TruePose(_))), n_true);
        assert_eq!(count(&records, |data| matches!(data, Data::Velocity(_))), n_odometry);
        assert_eq!(count(&records, |data| matches!(data, Data::TrueLandmark(_))), 15);
        let looks: Vec<_> = records
            .iter()
            .filter_map(|record| match &record.data {
                Data::Sightings(look) => Some(look),
                _ => None,
            })
            .collect();
        assert_eq!(looks.len(), n_looks);
        assert_eq!(looks.iter().map(|look| look.len()).sum::<usize>(), n_sightings);
        let landmark_ids = looks.iter().flat_map(|look| look.iter()).filter_map(|s| match s.target {
            Target::Landmark(id) => Some(id),
            _ => None,
        });
        assert!(
            landmark_ids.clone().all(|id| (6..=20).contains(&id)) && landmark_ids.count() > n_sightings / 2
        );
    }
}

#[test]
fn victoria_park() {
    let Some(folder) = data_folder() else { return };
    let (records, report) = open(folder.join("victoria_park"), &OpenOptions::default()).unwrap().read_all();
    // One fix is more than 30 m from both its neighbours, by a separate program.
    assert_eq!((report.rows_read, report.n_problems()), (61945 + 52974 + 4465, 1), "{report}");
    assert!(in_time_order(&records));
    assert_eq!(count(&records, |data| matches!(data, Data::Ackermann(_))), 61945);
    assert_eq!(count(&records, |data| matches!(data, Data::TruePosition(_))), 4465);
    let looks: Vec<_> = records
        .windows(2)
        .filter_map(|pair| match (&pair[0].data, &pair[1].data) {
            (Data::SightedWidths(widths), Data::Sightings(look)) => Some((widths, look)),
            _ => None,
        })
        .collect();
    assert_eq!(looks.len(), 7230);
    assert!(looks.iter().all(|(widths, look)| widths.len() == look.len()));
    assert_eq!(looks.iter().map(|(_, look)| look.len()).sum::<usize>(), 52974);
    let bearings = looks.iter().flat_map(|(_, look)| look.iter()).map(|sighting| sighting.bearing);
    assert!(
        bearings.clone().all(|bearing| bearing.abs() < std::f64::consts::FRAC_PI_2),
        "the laser looks ahead"
    );
}

#[test]
fn simulated_range_bearing_logs() {
    let Some(folder) = data_folder() else { return };
    for (name, n_landmarks) in [("slam_100", 100), ("slam_200", 200), ("slam_400", 400)] {
        let path = folder.join("range_bearing").join(name).with_extension("txt");
        let (records, report) = open(path, &OpenOptions::default()).unwrap().read_all();
        assert_eq!(report.n_problems(), 0, "{report}");
        assert!(in_time_order(&records));
        assert_eq!(count(&records, |data| matches!(data, Data::TrueLandmark(_))), n_landmarks);
        assert_eq!(count(&records, |data| matches!(data, Data::OdometryIncrement(_))), 500);
        assert_eq!(count(&records, |data| matches!(data, Data::TruePose(_))), 500);
        assert!((records.last().unwrap().stamp.seconds() - 49.9).abs() < 1e-9, "500 steps of 0.1 s");
    }
}

const UTIAS_ROWS: [(u32, usize, usize, usize, usize); 3] =
    [(1, 58389, 58598, 3228, 2032), (2, 56529, 60936, 4518, 2585), (3, 53545, 55085, 5399, 2719)];
