//! A run that stopped and went on is the run that never stopped; a damaged file is refused; a killed process leaves a whole file.
#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_sensor_log::{LogOpenOptions, Record};
use wayfix_slam_system::points::{PointSlamParams, RobotProfile, SavedPointMap, run, run_on};
use wayfix_slam_system::slam::{AssociationRule, SavedMapError, Smoothing};
use wayfix_system_core::RunStep;

use crate::common::{Outcome, Scratch, run_slam, utias_walk, walk};

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");
const KILL_SEED: u64 = 9;

fn records(log: &Path) -> Vec<Record> {
    wayfix_sensor_log::open(log, &LogOpenOptions::default()).unwrap().read_all().0
}

fn nearest_neighbour() -> PointSlamParams {
    let association = Some(AssociationRule::Nn);
    PointSlamParams { association, ..PointSlamParams::of(RobotProfile::RangeBearing) }
}

/// The bytes that a run without a break saves after each stamp of its log.
fn saved_after_each_stamp(records: &[Record], params: &PointSlamParams) -> BTreeMap<u64, Vec<u8>> {
    let mut saved = BTreeMap::new();
    run(records, params, |RunStep { system, .. }| {
        let map = system.save();
        saved.insert(map.taken_until, map.to_bytes().unwrap());
    })
    .unwrap();
    saved
}

#[test]
fn a_resumed_run_goes_on_bit_for_bit_through_a_file() {
    let scratch = Scratch::new();
    let (path, utias) = (scratch.path("floor.map"), utias_walk(&scratch, "utias", 1, 300));
    let stored = |name: &str| Path::new(FIXTURES).join(name);
    for (log, params) in [
        (stored("loop_unlabelled.mcap"), nearest_neighbour()),
        (stored("loop_known.mcap"), PointSlamParams::of(RobotProfile::RangeBearing)),
        (utias, PointSlamParams::of(RobotProfile::Utias)), // commands and looks that act late
    ] {
        let records = records(&log);
        let mut halves = Vec::new();
        let stop = records[records.len() / 2].stamp;
        let whole = run(&records, &params, |RunStep { system, .. }| {
            let map = system.save();
            if map.taken_until <= stop.nanoseconds() {
                halves = vec![map];
            }
        })
        .unwrap();
        halves[0].write(&path).unwrap();
        let resumed =
            run_on(SavedPointMap::read(&path).unwrap(), &records, &records, &params, |_| {}).unwrap();
        assert!(halves[0].filter.n_updates > 10 && resumed.system.stamped_estimates().len() > 10, "{log:?}");
        let (whole, resumed) = (whole.system.save(), resumed.system.save());
        assert_eq!(resumed.to_bytes().unwrap(), whole.to_bytes().unwrap(), "{log:?}");
    }
}

#[test]
fn the_command_saves_and_goes_on() {
    let scratch = Scratch::new();
    let (first, both) = (scratch.file("first.txt", walk(40)), scratch.file("both.txt", walk(80)));
    let (map, all) = (scratch.path("floor.map"), scratch.path("all.map"));
    let text = |path: &PathBuf| path.to_str().unwrap().to_owned();
    run_slam(&first, &["--save", &text(&map)]).json();
    let resumed = run_slam(&both, &["--resume", &text(&map), "--save", &text(&map), "--save-every", "1"]);
    run_slam(&both, &["--save", &text(&all)]).json();
    assert!(resumed.event("record_before_resume") > 0);
    assert_eq!(fs::read(&map).unwrap(), fs::read(&all).unwrap());

    let refused = |outcome: Outcome, why: &str| {
        assert!(outcome.code == 1 && outcome.stderr.contains(why), "{}", outcome.stderr);
    };
    refused(run_slam(&both, &["--resume", &text(&map)]), "record_before_resume");
    refused(
        run_slam(&both, &["--resume", &text(&map), "--association", "nn"]),
        "association is known, here it is nn",
    );
    refused(run_slam(&both, &["--resume", &text(&both)]), "not a saved map");
    refused(run_slam(&both, &["--resume", &text(&scratch.path("missing"))]), "cannot go on from");
    refused(run_slam(&both, &["--save", "/no/such/folder/x.map"]), "cannot save the map");
    for period in ["-1", "NaN", "soon"] {
        assert_eq!(run_slam(&both, &["--save", &text(&all), &format!("--save-every={period}")]).code, 2);
    }
    assert_eq!(run_slam(&both, &["--save-every", "1"]).code, 2, "nowhere to save to");
}

#[test]
fn either_estimator_goes_on_from_a_map_of_either() {
    let scratch = Scratch::new();
    let (first, both) = (scratch.file("first.txt", walk(40)), scratch.file("both.txt", walk(80)));
    for (from, to) in [("smoother", "smoother"), ("smoother", "ekf"), ("ekf", "smoother")] {
        let map = scratch.path(&format!("{from}-{to}.map")).to_str().unwrap().to_owned();
        run_slam(&first, &["--estimator", from, "--save", &map, "--save-every", "1"]).json();
        let resumed = run_slam(&both, &["--estimator", to, "--resume", &map, "--save", &map]);
        assert!(resumed.event("record_before_resume") > 0 && resumed.event("observation_accepted") > 0);
        assert_eq!(resumed.event("smoother_starts_from_filter"), u64::from(from == "ekf"));
        let saved = SavedPointMap::read(Path::new(&map)).unwrap();
        assert_eq!(saved.smoothed.is_some(), to == "smoother");
        if to == "ekf" {
            let whole = scratch.path("whole.map").to_str().unwrap().to_owned();
            run_slam(&both, &["--save", &whole]).json();
            assert_eq!(SavedPointMap::read(Path::new(&whole)).unwrap(), saved, "the filter is as without");
        }
    }
}

#[test]
fn a_damaged_file_is_refused_with_its_reason() {
    let scratch = Scratch::new();
    let params = PointSlamParams::of(RobotProfile::RangeBearing);
    let system = run(&records(&scratch.file("walk.txt", walk(12))), &params, |_| {}).unwrap().system;
    let bytes = system.save().to_bytes().unwrap();
    assert_eq!(SavedPointMap::from_bytes(&bytes).unwrap(), system.save());
    for length in 0..bytes.len() {
        let error = SavedPointMap::from_bytes(&bytes[..length]).unwrap_err();
        assert!(
            matches!(error, SavedMapError::NotASavedMap | SavedMapError::Length { .. }),
            "{length}: {error}"
        );
    }
    for place in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[place] ^= flip;
            let error = SavedPointMap::from_bytes(&damaged).unwrap_err();
            let expected = match place {
                0..8 => matches!(error, SavedMapError::NotASavedMap),
                8..12 => matches!(error, SavedMapError::Version { known: 5, .. }),
                12..20 => matches!(error, SavedMapError::Length { .. }),
                _ => matches!(error, SavedMapError::Checksum { .. }),
            };
            assert!(expected, "byte {place}: {error}");
        }
    }
}

/// With a recomputed checksum, the filter's own checks decide: an error or a filter, never a panic.
#[test]
fn a_forged_state_never_panics() {
    let scratch = Scratch::new();
    for smoothing in [Smoothing::Off, Smoothing::FixedLag] {
        let params = PointSlamParams { smoothing, ..PointSlamParams::of(RobotProfile::RangeBearing) };
        let log = records(&scratch.file("walk.txt", walk(12)));
        let bytes = run(&log, &params, |_| {}).unwrap().system.save().to_bytes().unwrap();
        let later = records(&scratch.file("later.txt", walk(20)));
        let mut n_refused = 0;
        for place in 24..bytes.len() {
            let mut forged = bytes.clone();
            forged[place] ^= 0x80;
            let checksum = crc32fast::hash(&[&forged[8..20], &forged[24..]].concat());
            forged[20..24].copy_from_slice(&checksum.to_le_bytes());
            let resumed = SavedPointMap::from_bytes(&forged)
                .map_err(anyhow::Error::from)
                .and_then(|map| run_on(map, &later, &later, &params, |_| {}));
            n_refused += usize::from(resumed.is_err());
        }
        assert!(n_refused > 0, "some forgeries must be found");
    }
}

#[test]
fn a_window_is_saved_without_landmarks_that_it_has_not() {
    let scratch = Scratch::new();
    let of_filter = PointSlamParams::of(RobotProfile::RangeBearing);
    let params = PointSlamParams { smoothing: Smoothing::FixedLag, ..of_filter };
    let log = records(&scratch.file("walk.txt", walk(12)));
    let mut state = run(&log, &params, |_| {}).unwrap().system.save();
    let n_landmarks = state.filter.landmarks.len();
    assert_eq!(state.smoothed.as_ref().unwrap().landmarks.len(), n_landmarks);
    // A landmark that the filter has, the window has not, and no robot sees again.
    state.filter.landmarks.last_mut().unwrap().id.0 = 9_999;
    let later = records(&scratch.file("later.txt", walk(40)));
    let saved = run_on(state, &later, &later, &params, |_| {}).unwrap().system.save();
    let has = |ids: Vec<u32>| ids.contains(&9_999);
    assert!(has(saved.filter.landmarks.iter().map(|landmark| landmark.id.0).collect()));
    let smoothed = saved.smoothed.as_ref().expect("a solved window");
    assert!(smoothed.landmarks.len() >= n_landmarks - 1);
    assert!(!has(smoothed.landmarks.iter().map(|landmark| landmark.id.0).collect()));
    let longer = records(&scratch.file("longer.txt", walk(60)));
    assert!(run_on(saved, &longer, &longer, &params, |_| {}).unwrap().smoothed.is_some());
}

/// The process is ended by SIGKILL at a random moment of saving without a pause.
#[cfg(unix)]
#[test]
fn a_killed_process_leaves_the_old_or_the_new_file_whole() {
    let log = Path::new(FIXTURES).join("loop_unlabelled.mcap");
    let expected = saved_after_each_stamp(&records(&log), &nearest_neighbour());
    let scratch = Scratch::new();
    let map = scratch.path("floor.map");
    let mut rng = ChaCha8Rng::seed_from_u64(KILL_SEED);
    let (mut n_killed, mut n_cut) = (0, 0);
    for _ in 0..40 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_wayfix"));
        command.args([
            "run",
            "slam",
            "--json",
            "--profile",
            "range-bearing",
            "--association",
            "nn",
            "--save-every",
            "0",
        ]);
        command.arg("--log").arg(&log).arg("--save").arg(&map);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        thread::sleep(Duration::from_micros(rng.random_range(3_000..300_000)));
        child.kill().unwrap();
        n_killed += usize::from(child.wait().unwrap().code().is_none());
        n_cut += remove_unfinished(&map);
        let Ok(bytes) = fs::read(&map) else { continue }; // killed before the first save
        let taken_until = SavedPointMap::from_bytes(&bytes).unwrap().taken_until;
        assert_eq!(bytes, expected[&taken_until], "as an undisturbed run saves it at {taken_until} ns");
    }
    assert!(n_killed >= 20 && map.exists(), "{n_killed} of 40 were killed while they ran");
    println!("{n_killed} killed while they ran, {n_cut} of them in the middle of a save");
}

/// Takes away what a killed process could not finish; how many files that were.
#[cfg(unix)]
fn remove_unfinished(map: &Path) -> usize {
    let others = fs::read_dir(map.parent().unwrap()).unwrap().map(|entry| entry.unwrap().path());
    let unfinished: Vec<PathBuf> = others.filter(|path| path != map).collect();
    unfinished.iter().for_each(|path| fs::remove_file(path).unwrap());
    unfinished.len()
}
