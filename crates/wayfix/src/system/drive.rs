use wayfix_sensor_log::{Record, Stamp};

use super::System;

/// Passes all records through a system and shows it to `observe` after each; records that go back in time are refused and counted.
pub fn drive<S: System>(system: &mut S, records: &[Record], mut observe: impl FnMut(&S)) {
    let mut latest = Stamp::default();
    for (index, record) in records.iter().enumerate() {
        let taken = if record.stamp < latest {
            Err(format!("time goes back by {:.6} s", latest.seconds_since(record.stamp)))
        } else {
            latest = record.stamp;
            system.take(record)
        };
        if let Err(reason) = taken {
            system.events().refuse(index, record.stamp, reason);
        }
        observe(system);
    }
}
