//! A run that knows the overview of a log.

use wayfix_sensor_log::{LogOpenOptions, Record, RecordData};
use wayfix_slam_system::points::{self, PointSlamParams, RobotProfile};
use wayfix_system_core::LogOverview;

fn overview(log: &str, head: usize) -> (Vec<Record>, LogOverview) {
    let path = format!("{}/../../fixtures/{log}", env!("CARGO_MANIFEST_DIR"));
    let open = || wayfix_sensor_log::open(&path, &LogOpenOptions::default()).expect("a stored log");
    (open().read_all().0, LogOverview::read_with_head(open(), 1, head))
}

#[test]
fn a_run_that_knows_the_overview_equals_one_that_knows_all() {
    for log in ["loop_known.mcap", "office_velocity.mcap"] {
        let (records, overview) = overview(log, 200);
        assert_eq!(overview.n_records, records.len());
        assert!(overview.records.len() < 3 * records.len() / 4, "{}", overview.records.len());
        let n_true = |records: &[Record]| {
            records.iter().filter(|record| matches!(record.data, RecordData::TruePose(_))).count()
        };
        assert!(n_true(&overview.records) < n_true(&records) / 2, "{}", n_true(&overview.records));
        let params = PointSlamParams::of(RobotProfile::Generic);
        let mut whole = points::run(&records, &params, |_| {}).unwrap();
        let mut streamed = points::run_streamed(&overview.records, &records, &params, |_| {}).unwrap();
        assert_eq!(streamed.system.save(), whole.system.save());
        assert_eq!(points::summarize(&mut streamed).metrics, points::summarize(&mut whole).metrics);
    }
}

#[test]
fn records_stay_in_order_and_one_image_has_pixels() {
    let (records, overview) = overview("store_area.mcap", 9);
    assert!(overview.records.is_sorted_by_key(|record| record.stamp));
    assert_eq!(overview.records.last().unwrap().stamp, records.last().unwrap().stamp);
    let images = overview.records.iter().filter_map(|record| match &record.data {
        RecordData::Image(image) => Some(image.bytes.is_empty()),
        _ => None,
    });
    let images: Vec<bool> = images.collect();
    assert!(!images[0] && images.len() < 10 && images[1..].iter().all(|empty| *empty), "{images:?}");
    assert_eq!(overview.n_images, 456);
}
