//! A robot that stands for 80 frames does not drift.

use std::path::PathBuf;

use wayfix_scene_sim::league::LightField;
use wayfix_sensor_log::{LogOpenOptions, Record, RecordData, Stamp};
use wayfix_systems::color::{priors, read_map};

use super::bad_input::standing;
use super::support::{Judged, drive, hall, localize, localize_with, n_wrongly_tracked, table};

/// Uncertainty of the true poses of the recorded field.
const TRUTH_M: f64 = 0.02;
const TRUTH_DEG: f64 = 1.0;

fn mean(frames: &[Judged], error: impl Fn(&Judged) -> f64) -> f64 {
    frames.iter().map(error).sum::<f64>() / frames.len() as f64
}

/// The last 16 of 80 frames are right, and on average as good as frames 16 to 32: what is within the uncertainty of the estimate and of the truth is no drift.
fn check(what: &str, frames: &[Judged]) {
    let table = table(frames);
    assert_eq!(frames.len(), 80);
    assert!(frames[64..].iter().all(Judged::is_right), "{what}: drifted\n{table}");
    assert!(n_wrongly_tracked(frames) <= 3, "{what}: sure of a wrong pose\n{table}");
    let [early, late] = [&frames[16..32], &frames[64..]];
    let position = [early, late].map(|frames| mean(frames, |frame| frame.position_error));
    let heading = [early, late].map(|frames| mean(frames, |frame| frame.heading_error_deg));
    let sigma = |at: usize| mean(late, |frame| frame.sigmas[at]);
    assert!(position[1] <= position[0] + sigma(0).hypot(TRUTH_M), "{what}: {position:?} m\n{table}");
    assert!(heading[1] <= heading[0] + sigma(1).hypot(TRUTH_DEG), "{what}: {heading:?}°\n{table}");
}

#[test]
fn simulated_robot_that_stands_does_not_drift() {
    let venue = hall(11);
    let light = |_| -> Box<dyn LightField> { Box::new(venue.bright.clone()) };
    check("simulated", &localize(&drive(&venue, 80, standing(), light, |_, _| {})));
}

/// A bag of the recorded field; `None`, and a word about it, where it is not at hand.
fn field(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(std::env::var_os("WAYFIX_DATA").unwrap_or_default()).join("nao_field");
    if !path.is_absolute() || !path.exists() {
        eprintln!("skipped: nao_field is not below an absolute WAYFIX_DATA");
        return None;
    }
    Some(path.join(name))
}

/// The frames of a bag again and again, with stamps that go on.
fn repeated(records: &[Record], n: u64) -> Vec<Record> {
    let images = || records.iter().filter(|record| matches!(record.data, RecordData::Image(_)));
    let (Some(first), Some(last)) = (images().next(), images().next_back()) else { return Vec::new() };
    let n_images = images().count() as u64;
    let length = (last.stamp.nanoseconds() - first.stamp.nanoseconds()) * n_images / (n_images - 1);
    let again = |round: u64| {
        records.iter().map(move |record| Record {
            stamp: Stamp::from_nanoseconds(record.stamp.nanoseconds() + round * length),
            data: record.data.clone(),
        })
    };
    (0..n).flat_map(again).collect()
}

#[test]
fn recorded_robot_that_stands_does_not_drift() {
    let Some(map) = field("field.toml") else { return };
    let map = read_map(&map).expect("a map");
    let priors = priors::read(&field("priors-red1.json").expect("as the map")).expect("priors");
    // The odometry of the one changes by a micrometre, that of the other never.
    for bag in ["bags/r1", "bags/r1_standing"] {
        let log = wayfix_sensor_log::open(field(bag).expect("as the map"), &LogOpenOptions::default());
        let (records, _) = log.expect("a bag").read_all();
        let records = repeated(&records, 5);
        check(bag, &localize_with(&records, map.clone(), &priors, None));
    }
}
