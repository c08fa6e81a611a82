//! A map of walls that was saved goes on as if it had never stopped.
#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::path::PathBuf;

use wayfix_sensor_log::{LaserScan, LogOpenOptions, Record, RecordData};
use wayfix_slam_system::{
    points::SavedPointMap,
    slam::{AssociationRule, SavedMapError},
    walls::{SavedWallMap, WallSlamParams, run, run_on, run_streamed},
};

/// The office floor, up to a stamp that both halves of a run have in common.
fn office(n_records: usize) -> Vec<Record> {
    let log = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/office_laser.mcap");
    let mut records = wayfix_sensor_log::open(&log, &LogOpenOptions::default()).unwrap().read_all().0;
    records.truncate(n_records);
    records
}

/// The bytes that a run saves at its end.
fn saved(records: &[Record]) -> Vec<u8> {
    run(records, &WallSlamParams::default(), |_| {}).unwrap().system.save().to_bytes().unwrap()
}

#[test]
fn a_resumed_run_goes_on_bit_for_bit() {
    let (records, params) = (office(1200), WallSlamParams::default());
    // One half ends at a look, the other between two looks, with a way that only a scan knows well.
    let ends: Vec<usize> = (600..620).filter(|end| records[*end].stamp > records[end - 1].stamp).collect();
    assert!(ends.len() >= 4);
    for end in ends {
        let half = SavedWallMap::from_bytes(&saved(&records[..end])).unwrap();
        assert!(half.filter.landmarks.len() > 3 && half.front_end.last_keyframe.is_some());
        let resumed = run_on(half, &records, &records, &params, None, |_| {}).unwrap();
        assert_eq!(resumed.system.save().to_bytes().unwrap(), saved(&records), "{end}");
    }
}

#[test]
fn a_streamed_run_is_that_of_the_kept_log_bit_for_bit() {
    let records = office(600);
    let without_ranges = |record: &Record| match &record.data {
        RecordData::Scan(scan) => {
            let data = RecordData::Scan(LaserScan { ranges: Vec::new(), ..scan.clone() });
            Record { data, ..record.clone() }
        }
        _ => record.clone(),
    };
    let overview: Vec<Record> = records.iter().map(without_ranges).collect();
    let streamed = run_streamed(&overview, records.clone(), &WallSlamParams::default(), |_| {}).unwrap();
    assert_eq!(streamed.system.save().to_bytes().unwrap(), saved(&records));
}

#[test]
fn maps_of_points_and_other_rules_are_refused() {
    let records = office(300);
    let bytes = saved(&records);
    let error = SavedPointMap::from_bytes(&bytes).unwrap_err().to_string();
    assert!(error.contains("planar pose with heading drift"), "{error}");
    let saved = SavedWallMap::from_bytes(&bytes).unwrap();
    let asked = Some(AssociationRule::Nn);
    let error = run_on(saved, &records, &records, &WallSlamParams::default(), asked, |_| {}).err().unwrap();
    assert!(matches!(error.downcast_ref(), Some(SavedMapError::Kind { what: "association", .. })), "{error}");
}

/// With a recomputed checksum, the filter's own checks decide: an error or a filter, never a panic.
#[test]
fn a_forged_state_never_panics() {
    let (bytes, later) = (saved(&office(260)), office(280));
    let mut n_refused = 0;
    for place in (24..bytes.len()).step_by(11) {
        let mut forged = bytes.clone();
        forged[place] ^= 0x80;
        let checksum = crc32fast::hash(&[&forged[8..20], &forged[24..]].concat());
        forged[20..24].copy_from_slice(&checksum.to_le_bytes());
        let map = SavedWallMap::from_bytes(&forged).map_err(anyhow::Error::from);
        let resumed =
            map.and_then(|map| run_on(map, &later, &later, &WallSlamParams::default(), None, |_| {}));
        n_refused += usize::from(resumed.is_err());
    }
    assert!(n_refused > 0, "some forgeries must be found");
}
