//! Records and messages made up for tests.

pub(crate) mod bag;
pub(crate) mod cdr;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Detection, DetectionTarget, Record, RecordData, Stamp, TrueLandmark, Velocity};

/// A log of `n_steps` steps of a robot that sees landmarks.
pub(crate) fn drive(n_steps: u64) -> Vec<Record> {
    let mut records = vec![record(0, RecordData::TrueLandmark(TrueLandmark { id: 3, x: 5.0, y: 1.0 }))];
    for step in 0..n_steps {
        let x = 0.1 * step as f64;
        let look = vec![
            Detection { target: DetectionTarget::Landmark(3), range: 5.0, bearing: 0.01 * x },
            Detection { target: DetectionTarget::Unlabelled, range: 1.0 + x, bearing: -1.0 },
        ];
        records.push(record(step, RecordData::TruePose(Pose2::new(x, 0.0, 0.3 * x))));
        records.push(record(step, RecordData::Velocity(Velocity { linear: 1.0, angular: 0.3 })));
        records.push(record(step, RecordData::OdometryIncrement(Pose2::new(0.1, 0.0, 0.03))));
        records.push(record(step, RecordData::Detections(look)));
        records.push(record(step, RecordData::EstimatedPose(Pose2::new(x + 0.01, 0.02, 0.3 * x))));
    }
    records
}

fn record(step: u64, data: RecordData) -> Record {
    Record { stamp: Stamp::from_nanoseconds(1_000_000_000 + step * 100_000_000), data }
}
