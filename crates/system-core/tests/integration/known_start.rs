//! The true pose at the start, led back by odometry where truth begins late.

use approx::assert_abs_diff_eq;
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::errors::ReferencePath;
use wayfix_sensor_log::{Record, RecordData, Stamp, Velocity};
use wayfix_system_core::TrueStartPose;

fn at(milliseconds: u64) -> Stamp {
    Stamp::from_nanoseconds(milliseconds * 1_000_000)
}

fn increment(milliseconds: u64, x: f64) -> Record {
    Record { stamp: at(milliseconds), data: RecordData::OdometryIncrement(Pose2::new(x, 0.0, 0.0)) }
}

fn truth(milliseconds: u64, x: f64) -> Record {
    Record { stamp: at(milliseconds), data: RecordData::TruePose(Pose2::new(x, 0.0, 0.0)) }
}

#[test]
fn truth_that_begins_late_is_led_back_by_odometry() {
    let odometry = [increment(0, 0.0), increment(1000, 1.0), increment(2000, 2.0)];
    let records = [&odometry[..], &[truth(1500, 7.0), truth(1600, 7.2)]].concat();
    let track = ReferencePath::from_records(&records);
    let start = TrueStartPose::at(at(500), &track, &records).unwrap();
    assert_abs_diff_eq!(start.pose.x(), 7.0 - 0.5 - 1.0, epsilon = 1e-12);
    assert_abs_diff_eq!(start.seconds_late, 1.0, epsilon = 1e-12);
    assert_eq!(TrueStartPose::at(at(1500), &track, &records).unwrap().seconds_late, 0.0);
    assert_eq!(TrueStartPose::at(at(500), &ReferencePath::default(), &records), None);
}

#[test]
fn velocities_lead_back_as_well() {
    let data = RecordData::Velocity(Velocity { linear: 2.0, angular: 0.0 });
    let records = [Record { stamp: at(0), data }, truth(1500, 7.0), truth(1600, 7.2)];
    let start = TrueStartPose::at(at(500), &ReferencePath::from_records(&records), &records).unwrap();
    assert_abs_diff_eq!(start.pose.x(), 5.0, epsilon = 1e-12);
}
