use std::{collections::BTreeMap, fmt};

use wayfix_sensor_log::Stamp;

/// How often each kind of event happened, and the first records that were refused.
#[derive(Clone, Debug, Default)]
pub struct Events {
    counts: BTreeMap<&'static str, u64>,
    refusals: Vec<Refusal>,
}

/// A record that the system could not use.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// Its place among the log's records, from 0.
    pub index: usize,
    /// Its stamp.
    pub stamp: Stamp,
    /// Why.
    pub reason: String,
}

/// More than this many refusals are counted, not listed.
const MOST_LISTED: usize = 20;

impl Events {
    /// Counts an event.
    pub fn count(&mut self, name: &'static str) {
        self.add(name, 1);
    }
    /// Counts `n` events of a kind; 0 makes the kind known.
    pub fn add(&mut self, name: &'static str, n: u64) {
        *self.counts.entry(name).or_default() += n;
    }
    /// Counts a record that could not be used.
    pub fn refuse(&mut self, index: usize, stamp: Stamp, reason: String) {
        self.count("record_refused");
        if self.refusals.len() < MOST_LISTED {
            self.refusals.push(Refusal { index, stamp, reason });
        }
    }
    /// How often a kind of event happened.
    pub fn get(&self, name: &str) -> u64 {
        self.counts.get(name).copied().unwrap_or(0)
    }
    /// All kinds with their counts.
    pub fn counts(&self) -> BTreeMap<String, u64> {
        self.counts.iter().map(|(name, n)| ((*name).to_owned(), *n)).collect()
    }
    /// The first refusals.
    pub fn refusals(&self) -> &[Refusal] {
        &self.refusals
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "record {} at {}: {}", self.index, self.stamp, self.reason)
    }
}
