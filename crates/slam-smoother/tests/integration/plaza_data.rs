//! Ranges of the Plaza 1 set [Djugash et al. 2009], when the folder of data is there (`WAYFIX_DATA`).

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use std::{collections::BTreeMap, path::Path};

use nalgebra::{Matrix2, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_smoother::range_only::{Range, RangeOnlyInput, RangeOnlyParams, estimate};

/// A batch in GTSAM with four places and one bias reaches 0.20 m; a quarter more is allowed.
const ALIGNED_RMSE: f64 = 0.25;

#[test]
fn plaza_path_without_any_start_for_the_beacons() {
    let Some(recording) = Recording::read() else { return };
    let every_range = recording.path_error();
    assert!(every_range <= ALIGNED_RMSE);

    let mut late = recording.clone();
    let half = f64::midpoint(late.odometry[0][0], late.odometry[late.odometry.len() - 1][0]);
    late.odometry.retain(|row| row[0] >= half);
    assert!(late.path_error() <= ALIGNED_RMSE);

    // A quarter of the measurements has at most twice the error, and each eighth of these is an outlier.
    let mut few = recording;
    few.ranges = few.ranges.into_iter().step_by(4).collect();
    few.ranges.iter_mut().step_by(8).for_each(|row| row[2] += 15.0);
    assert!(few.path_error() <= 2.0 * ALIGNED_RMSE);
}

#[derive(Clone)]
struct Recording {
    odometry: Vec<Vec<f64>>,
    ranges: Vec<Vec<f64>>,
    truth: Vec<Vec<f64>>,
    beacons: BTreeMap<u32, Vector2<f64>>,
}

impl Recording {
    fn read() -> Option<Self> {
        let folder = std::env::var_os("WAYFIX_DATA").map(|data| Path::new(&data).join("plaza"))?;
        let table = |name: &str| rows(&folder.join(name));
        folder.is_dir().then(|| Self {
            odometry: table("odometry.csv"),
            ranges: table("ranges.csv"),
            truth: table("truth.csv"),
            beacons: table("beacons.csv")
                .iter()
                .map(|row| (row[0] as u32, Vector2::new(row[1], row[2])))
                .collect(),
        })
    }

    /// After the best rigid motion, m. Every beacon is placed.
    fn path_error(&self) -> f64 {
        let Self { odometry, truth, beacons, .. } = self;
        let mut ranges = self.ranges.clone();
        ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
        // A pose for each row of odometry before which there are ranges; they count as taken at it.
        let (begin, end) = (odometry[0][0], odometry.last().unwrap()[0]);
        ranges.retain(|row| row[0] >= begin && row[0] <= end);
        let row_of = |t: f64| odometry.partition_point(|row| row[0] < t);
        let mut rows_of_poses: Vec<usize> =
            std::iter::once(0).chain(ranges.iter().map(|row| row_of(row[0]))).collect();
        rows_of_poses.dedup();
        let arc = |row: &Vec<f64>| Pose2::exp(&Vector3::new(row[1], 0.0, row[2]));
        let motion = |pair: &[usize]| {
            odometry[pair[0] + 1..=pair[1]].iter().fold(Pose2::identity(), |sum, row| sum.compose(&arc(row)))
        };
        let motions = rows_of_poses.windows(2).map(motion).collect();
        let pose_of = |row: &Vec<f64>| rows_of_poses.binary_search(&row_of(row[0])).unwrap();
        let ranges = ranges
            .iter()
            .map(|row| Range { pose: pose_of(row), beacon: row[1] as u32, range: row[2] })
            .collect();
        let input = RangeOnlyInput { start: Pose2::identity(), motions, ranges };
        let found = estimate(&input, &RangeOnlyParams::default()).unwrap();

        let true_at = |t: f64| {
            let after = truth.partition_point(|row| row[0] < t).clamp(1, truth.len() - 1);
            let (early, late) = (&truth[after - 1], &truth[after]);
            let share = (t - early[0]) / (late[0] - early[0]);
            Vector2::new(early[1] + share * (late[1] - early[1]), early[2] + share * (late[2] - early[2]))
        };
        let path: Vec<_> = found
            .poses
            .iter()
            .zip(&rows_of_poses)
            .map(|(pose, row)| (pose.translation, true_at(odometry[*row][0])))
            .collect();
        let places: Vec<_> = found.beacons.iter().map(|(id, (place, _))| (*place, beacons[id])).collect();
        println!(
            "path {:.4} m, beacons {:.4} m, {:?} {:?}, {} outliers of {}",
            aligned_rmse(&path),
            aligned_rmse(&places),
            found.noise,
            found.calibration,
            found.n_outliers,
            found.n_ranges
        );
        assert!(found.unplaced.is_empty() && found.beacons.len() == 4);
        aligned_rmse(&path)
    }
}

/// Error of `(estimate, truth)` after the best rigid motion, m. [Umeyama 1991]
fn aligned_rmse(pairs: &[(Vector2<f64>, Vector2<f64>)]) -> f64 {
    let n = pairs.len() as f64;
    let a = pairs.iter().map(|pair| pair.0).sum::<Vector2<f64>>() / n;
    let b = pairs.iter().map(|pair| pair.1).sum::<Vector2<f64>>() / n;
    let h: Matrix2<f64> = pairs.iter().map(|(x, y)| (x - a) * (y - b).transpose()).sum();
    let (sin, cos) = (h.m12 - h.m21).atan2(h.trace()).sin_cos();
    let rotation = Matrix2::new(cos, -sin, sin, cos);
    (pairs.iter().map(|(x, y)| (rotation * (x - a) + b - y).norm_squared()).sum::<f64>() / n).sqrt()
}

fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}
