use std::{borrow::Borrow, cell::Cell};

use wayfix_sensor_log::{Record, Stamp};

use crate::{System, records::CutOdometry};

/// State shown to an observer of [`drive`] after each record.
#[derive(Clone, Copy, Debug)]
pub struct RunStep<'a, S> {
    /// The system after the record.
    pub system: &'a S,
    /// The record, with the stamp at which the system took it; or a part of an increment of odometry.
    pub record: &'a Record,
    /// The next record.
    pub next: Option<&'a Record>,
    /// An observer that sets it ends the drive after this record.
    pub stop: &'a Cell<bool>,
}

/// Passes records through a system and shows each step to `observe`. Rejects and counts records that go back in time.
///
/// Records may be read one by one: at most two are kept, and those that [wait for odometry](System::cuts_odometry).
pub fn drive<S: System, R: Borrow<Record>>(
    system: &mut S,
    records: impl IntoIterator<Item = R>,
    mut observe: impl FnMut(RunStep<'_, S>),
) {
    let mut latest = Stamp::default();
    let stop = Cell::new(false);
    let mut records = CutOdometry::new(records.into_iter(), S::cuts_odometry).peekable();
    while let Some((index, record)) = records.next() {
        let record: &Record = record.borrow();
        system.events().at_record(index, record.stamp);
        let taken = if record.stamp < latest {
            Err(format!("time goes back by {:.9} s", latest.seconds_since(record.stamp)))
        } else {
            latest = record.stamp;
            system.take(record)
        };
        if let Err(reason) = taken {
            system.events().refuse("record_refused", reason);
        }
        let next = records.peek().map(|(_, next)| next.borrow());
        observe(RunStep { system, record, next, stop: &stop });
        if stop.get() {
            break;
        }
    }
    if let Err(reason) = system.finish() {
        system.events().refuse("record_refused", reason);
    }
}
