//! An observer ends a drive.

use std::{ops::ControlFlow, time::Duration};

use wayfix_condensation::RgbImage;
use wayfix_line_extract::LineExtractionParams;
use wayfix_sensor_log::{LaserScan, Record, RecordData, Stamp};
use wayfix_system_core::{RunStep, drive};
use wayfix_systems::{
    lines::LineExtractionSystem,
    views::{DescriptorKind, LightNormalization, ViewSystem, ViewSystemConfig, ViewsParams, ViewsRun},
};

#[test]
fn an_observer_ends_the_drive() {
    let ranges = vec![2.0; 61];
    let scan = LaserScan { angle_min: -0.5, angle_increment: 0.01, range_max: 8.0, beam_period: 0.0, ranges };
    let record =
        |second| Record { stamp: Stamp::from_nanoseconds(second), data: RecordData::Scan(scan.clone()) };
    let records: Vec<Record> = (0..50).map(record).collect();
    let mut system = LineExtractionSystem::new(LineExtractionParams::default()).expect("the defaults");
    drive(&mut system, &records, |RunStep { record, stop, .. }| stop.set(record.stamp.nanoseconds() == 20));
    assert_eq!(system.n_scans(), 21);
}

#[test]
fn drives_through_a_scene_end_with_those_under_way() {
    let waves = |i: usize| [i % 251, i * i % 241, i / 160 % 239].map(|value| value as u8);
    let scene = RgbImage::from_raw(160, 120, (0..160 * 120).flat_map(waves).collect()).expect("a picture");
    let config = ViewSystemConfig {
        view: 64,
        step: 16,
        feature: DescriptorKind::MeanVar,
        normalization: LightNormalization::None,
    };
    let system = ViewSystem::learn(&scene, &scene, &config, &ViewsParams::default()).expect("a scene");
    let n_trials = |flow: ControlFlow<()>| {
        let run = ViewsRun::drive(system.clone(), Duration::ZERO, 500, 1, &|| flow).expect("a run");
        assert!(run.trials.is_sorted_by_key(|trial| trial.index));
        run.trials.len()
    };
    assert!((1..500).contains(&n_trials(ControlFlow::Break(()))));
    assert_eq!(n_trials(ControlFlow::Continue(())), 500);
}
