//! The picture of a scan with the search bands of expected walls.

use wayfix_sensor_log::{LogOpenOptions, open};
use wayfix_slam_system::walls::{self, WallSlamParams};

/// Titles of the pictures of a short drive through the office.
fn titles(params: &WallSlamParams) -> Vec<String> {
    let log = format!("{}/../../fixtures/office_laser.mcap", env!("CARGO_MANIFEST_DIR"));
    let (mut records, _) =
        open(std::path::Path::new(&log), &LogOpenOptions::default()).expect("a log").read_all();
    records.truncate(600);
    let run = walls::run(&records, params, |_| {}).expect("a usable log");
    walls::plots(&run).expect("pictures").into_iter().map(|plot| plot.title).collect()
}

#[test]
fn expected_walls_are_drawn_with_their_search_bands() {
    let params = WallSlamParams { expected_walls: true, ..WallSlamParams::default() };
    let with_bands = titles(&params);
    let last = with_bands.last().expect("pictures");
    let counts: Vec<usize> = last.split(' ').filter_map(|word| word.parse().ok()).collect();
    assert!(last.contains("predicted walls") && counts[0] >= counts[1] && counts[1] > 0, "{last}");
    assert_eq!(titles(&WallSlamParams::default()), with_bands[..with_bands.len() - 1]);
}
