//! Records pass in time order, and refused ones are counted.

use wayfix_sensor_log::{Record, RecordData, Stamp, Velocity};
use wayfix_system_core::{EventCounts, System, drive};

/// Passes records in time order and rejects the others.
#[derive(Default)]
struct OneWay {
    taken: Vec<u64>,
    events: EventCounts,
}

impl System for OneWay {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        match record.data {
            RecordData::Velocity(velocity) if velocity.linear < 0.0 => Err("backwards".to_owned()),
            _ => {
                self.taken.push(record.stamp.nanoseconds());
                Ok(())
            }
        }
    }
    fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }
}

fn record(nanoseconds: u64, linear: f64) -> Record {
    let data = RecordData::Velocity(Velocity { linear, angular: 0.0 });
    Record { stamp: Stamp::from_nanoseconds(nanoseconds), data }
}

#[test]
fn record_back_in_time_is_refused_with_its_index() {
    let mut system = OneWay::default();
    let records = [record(10, 1.0), record(20, 1.0), record(15, 1.0), record(20, 1.0), record(30, -1.0)];
    let mut n_observed = 0;
    drive(&mut system, &records, |_| n_observed += 1);
    assert_eq!(system.taken, [10, 20, 20]);
    assert_eq!(n_observed, records.len());
    assert_eq!(system.events.get("record_refused"), 2);
    let refused: Vec<String> = system.events.refusals().iter().map(ToString::to_string).collect();
    assert_eq!(
        refused,
        [
            "record 2 at 0.000000015 s: time goes back by 0.000000005 s",
            "record 4 at 0.000000030 s: backwards"
        ]
    );
}

#[test]
fn the_first_twenty_refusals_are_listed_and_the_rest_counted() {
    let mut system = OneWay::default();
    let records: Vec<Record> = (0..50).map(|stamp| record(stamp, -1.0)).collect();
    drive(&mut system, &records, |_| {});
    assert_eq!((system.events.refusals().len(), system.events.n_refusals()), (20, 50));
    assert_eq!(system.events.get("record_refused"), 50);
}
