//! A system of your own behind a log: dead reckoning, driven, judged and reported like the others.
//!
//! `cargo run -p wayfix --example 02_custom_system -- fixtures/loop_known.mcap`

use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_evaluation::report::{Metric, ReportRun, table};
use wayfix_sensor_log::{LogOpenOptions, Record, RecordData};
use wayfix_system_core::{EventCounts, System, drive};

/// Believes its odometry.
#[derive(Default)]
struct DeadReckoning {
    pose: Option<Pose2<f64>>,
    last_truth: Option<Pose2<f64>>,
    travelled_m: f64,
    events: EventCounts,
}

impl System for DeadReckoning {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        match &record.data {
            RecordData::OdometryIncrement(increment) if !increment.is_finite() => {
                return Err("odometry that is not finite".to_owned()); // counted with its place in the log; nothing has changed
            }
            RecordData::OdometryIncrement(increment) => {
                self.travelled_m += increment.x().hypot(increment.y());
                self.pose = self.pose.map(|pose| pose.compose(increment));
                self.events.count("odometry");
            }
            RecordData::TruePose(truth) => {
                self.pose.get_or_insert(*truth);
                self.last_truth = Some(*truth);
            }
            _ => {}
        }
        Ok(())
    }

    fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "fixtures/loop_known.mcap".to_owned());
    let (records, _) = wayfix_sensor_log::open(&path, &LogOpenOptions::default())?.read_all();
    let mut system = DeadReckoning::default();
    drive(&mut system, &records, |_| {});

    let (pose, truth) = system.pose.zip(system.last_truth).ok_or("no true pose in the log")?;
    let run = ReportRun {
        name: path,
        metrics: vec![
            Metric::new("travelled_m", system.travelled_m, "m"),
            Metric::new("error_at_end_m", truth.local(&pose).xy().norm(), "m"),
        ],
        events: system.events.counts(),
        ..ReportRun::default()
    };
    print!("{}", table::run(&run, table::TableStyle::PLAIN));
    assert!(system.travelled_m > 0.0 && system.events.n_refusals() == 0);
    Ok(())
}
