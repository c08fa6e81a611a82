use std::{collections::BTreeMap, fmt};

use wayfix_sensor_log::{LogWarning, Stamp};

/// Event counts by kind, and the first unusable records.
///
/// ```
/// use wayfix_system_core::EventCounts;
/// use wayfix_sensor_log::Stamp;
/// let mut events = EventCounts::default();
/// events.at_record(7, Stamp::from_nanoseconds(5_000_000_000));
/// events.count("observation_accepted");
/// events.refuse("observation_unusable", "range 0 m".to_owned());
/// assert_eq!((events.get("observation_accepted"), events.get("observation_unusable")), (1, 1));
/// assert_eq!(events.refusals()[0].to_string(), "record 7 at 5.000000000 s: range 0 m");
/// ```
#[derive(Clone, Debug, Default)]
pub struct EventCounts {
    counts: BTreeMap<&'static str, u64>,
    refusals: Vec<RefusedRecord>,
    n_refusals: u64,
    warnings: Vec<LogWarning>,
    record: (usize, Stamp),
}

/// A record, or one of its detections, that the system could not use.
#[derive(Clone, Debug, PartialEq)]
pub struct RefusedRecord {
    /// Index of the record in the log, from 0.
    pub index: usize,
    /// Its stamp.
    pub stamp: Stamp,
    /// The reason.
    pub reason: String,
}

/// Maximum number of listed refusals; the others are only counted.
const MOST_LISTED: usize = 20;

impl EventCounts {
    /// Sets the record of the following events.
    pub fn at_record(&mut self, index: usize, stamp: Stamp) {
        self.record = (index, stamp);
    }
    /// Counts an event.
    pub fn count(&mut self, name: &'static str) {
        self.add(name, 1);
    }
    /// Counts `n` events of a kind; 0 registers the kind.
    pub fn add(&mut self, name: &'static str, n: u64) {
        *self.counts.entry(name).or_default() += n;
    }
    /// Counts an event, and lists the current record with the reason why it, or a part of it, is unusable.
    pub fn refuse(&mut self, name: &'static str, reason: String) {
        self.count(name);
        self.n_refusals += 1;
        if self.refusals.len() < MOST_LISTED {
            let (index, stamp) = self.record;
            self.refusals.push(RefusedRecord { index, stamp, reason });
        }
    }
    /// Counts an event and adds a warning for the user; each text appears once.
    pub fn warn(&mut self, name: &'static str, text: impl Into<String>) {
        self.count(name);
        let warning = LogWarning { name, text: text.into() };
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }
    /// Warnings for the user, in order of occurrence.
    pub fn warnings(&self) -> &[LogWarning] {
        &self.warnings
    }
    /// Count of a kind of event.
    pub fn get(&self, name: &str) -> u64 {
        self.counts.get(name).copied().unwrap_or(0)
    }
    /// All kinds with their counts.
    pub fn counts(&self) -> BTreeMap<String, u64> {
        self.counts.iter().map(|(name, n)| ((*name).to_owned(), *n)).collect()
    }
    /// The first refusals, up to a limit.
    pub fn refusals(&self) -> &[RefusedRecord] {
        &self.refusals
    }
    /// Number of refusals, listed or not.
    pub fn n_refusals(&self) -> u64 {
        self.n_refusals
    }
}

impl fmt::Display for RefusedRecord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "record {} at {}: {}", self.index, self.stamp, self.reason)
    }
}
