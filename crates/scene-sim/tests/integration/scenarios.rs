//! Each named scenario holds what its name promises, and little enough of it to be stored.

use std::collections::BTreeSet;

use wayfix_scene_sim::Scenario;
use wayfix_sensor_log::{Detection, DetectionTarget, Record, RecordData};

use crate::support::run;

fn detections(records: &[Record]) -> Vec<Detection> {
    let of = |record: &Record| match &record.data {
        RecordData::Detections(detections) => detections.clone(),
        _ => vec![],
    };
    records.iter().flat_map(of).collect()
}

fn count(records: &[Record], is: fn(&RecordData) -> bool) -> usize {
    records.iter().filter(|record| is(&record.data)).count()
}

fn seen_landmarks(records: &[Record]) -> usize {
    let landmark = |s: &Detection| match s.target {
        DetectionTarget::Landmark(id) => Some(id),
        _ => None,
    };
    detections(records).iter().filter_map(landmark).collect::<BTreeSet<_>>().len()
}

#[test]
fn all_have_truth_sightings_and_a_bounded_size() {
    for scenario in Scenario::all().into_iter().filter(|scenario| scenario.name != "office_laser") {
        let records = run(scenario.name, scenario.seed);
        let (n_records, n_detections) = (records.len(), detections(&records).len());
        println!("{}: {n_records} records, {n_detections} detections", scenario.name);
        assert!(count(&records, |d| matches!(d, RecordData::TruePose(_))) > 100, "{}", scenario.name);
        assert!(count(&records, |d| matches!(d, RecordData::TrueLandmark(_))) > 0, "{}", scenario.name);
        // Fixtures are to stay below 1 MB each; a record takes about 100 bytes of MCAP and a detection 60.
        assert!(n_records * 100 + n_detections * 60 < 1_000_000, "{}", scenario.name);
    }
}

#[test]
fn office_drive_closes_its_loop_and_sees_most_walls() {
    let records = run("office_laser", 7);
    let scans = count(&records, |d| matches!(d, RecordData::Scan(_)));
    let poses = count(&records, |d| matches!(d, RecordData::TruePose(_)));
    assert_eq!((scans, poses), (473, 473), "each scan has its true pose");
    let at: Vec<_> = records
        .iter()
        .filter_map(|record| match &record.data {
            RecordData::TruePose(pose) => Some(pose.translation),
            _ => None,
        })
        .collect();
    let driven: f64 = at.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    assert!((90.0..100.0).contains(&driven), "the loop of the paper is nearly 90 m: {driven}");
    // It comes by its start again: the last poses are near the first ones.
    assert!(at.iter().rev().take(40).any(|end| (end - at[0]).norm() < 0.3));
    assert!(count(&records, |d| matches!(d, RecordData::TrueWall(_))) > 100);
    let echoes: usize = records
        .iter()
        .map(|record| match &record.data {
            RecordData::Scan(scan) => scan.echoes().count(),
            _ => 0,
        })
        .sum();
    // 1 % of the beams are lost; a few find the slits between a door's leaf and its wall.
    assert!(echoes as f64 > 0.95 * (scans * 181) as f64, "{echoes} of {}", scans * 181);
}

#[test]
fn each_is_what_its_name_says() {
    let records = run("loop_known", 1);
    assert!(seen_landmarks(&records) >= 30);
    assert_eq!(count(&records, |d| matches!(d, RecordData::OdometryIncrement(_))), 500);

    let unlabelled = detections(&run("loop_unlabelled", 2));
    assert!(!unlabelled.is_empty() && unlabelled.iter().all(|s| s.target == DetectionTarget::Unlabelled));

    let office = run("office_velocity", 3);
    assert!(
        count(&office, |d| matches!(d, RecordData::Velocity(_))) == 3000 && seen_landmarks(&office) == 15
    );
    let kinds =
        |is: fn(&DetectionTarget) -> bool| detections(&office).iter().filter(|s| is(&s.target)).count();
    assert!(kinds(|t| matches!(t, DetectionTarget::Robot(2 | 3))) > 20);
    assert!(kinds(|t| matches!(t, DetectionTarget::UnknownCode(_))) > 20);

    let rough = run("rough_known", 4);
    assert!(count(&rough, |d| matches!(d, RecordData::Detections(_))) < 481, "some looks are lost");

    let long = run("long_loop", 5);
    assert!(seen_landmarks(&long) >= 45);
}

#[cfg(feature = "indoors")]
#[test]
fn store_drive_has_two_laps_and_a_view_every_quarter_metre() {
    let scenario = Scenario::named("store_area").expect("there is one");
    let records = run(scenario.name, scenario.seed);
    let views = count(&records, |data| matches!(data, RecordData::Image(_)));
    let increments = count(&records, |data| matches!(data, RecordData::OdometryIncrement(_)));
    assert_eq!(
        (views, count(&records, |data| matches!(data, RecordData::TruePose(_)))),
        (increments + 1, views)
    );
    // Two laps of 22 m × 7.3 m with rounded corners.
    assert!((400..480).contains(&views), "{views}");
}
