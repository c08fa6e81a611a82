use wayfix_sensor_log::{Record, Stamp};

use super::System;

/// Passes all records through a system and calls `progress` after each; records that go back in time are refused and counted.
pub fn drive(system: &mut impl System, records: &[Record], mut progress: impl FnMut()) {
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
        progress();
    }
}
