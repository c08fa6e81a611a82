use wayfix_sensor_log::{
    EncodedImage, LaserScan, Log, LogCompleteness, LogWarning, ReadReport, Record, RecordData,
};

use super::run::interrupt;
use wayfix_evaluation::terminal::print_message;
use wayfix_systems::system::EventCounts;

/// Reads all records of a log; prints read problems and assumptions.
pub(super) fn read_all(log: Log) -> (Vec<Record>, ReadReport) {
    let (records, read) = log.read_all();
    if !read.is_clean() {
        print_message(&read);
    }
    (records, read)
}

/// Reads all of a log but what its scans and images hold, which a long log has too much of; prints read problems and assumptions.
pub(super) fn read_overview(log: Log) -> (Vec<Record>, ReadReport) {
    let mut log = log;
    let records = log.by_ref().map(without_bulk).collect();
    let read = log.report().clone();
    if !read.is_clean() {
        print_message(&read);
    }
    (records, read)
}

fn without_bulk(record: Record) -> Record {
    let data = match record.data {
        RecordData::Scan(scan) => RecordData::Scan(LaserScan { ranges: Vec::new(), ..scan }),
        RecordData::Image(image) => RecordData::Image(EncodedImage { bytes: [].into(), ..image }),
        data => data,
    };
    Record { data, ..record }
}

/// Prints refusals and assumptions of the run, counts read problems, and returns all warnings for the report.
pub(super) fn add_read_problems(events: &mut EventCounts, read: &ReadReport) -> Vec<String> {
    for refusal in events.refusals() {
        print_message(format!("refused {refusal}"));
    }
    let n_unlisted = events.n_refusals() - events.refusals().len() as u64;
    if n_unlisted > 0 {
        print_message(format!("refused … and {n_unlisted} more"));
    }
    events.warnings().iter().for_each(print_message); // those of the log were printed when it was read
    events.add("log_problem", read.n_problems());
    if read.end != LogCompleteness::Complete {
        events.count("log_incomplete");
    }
    for LogWarning { name, .. } in &read.warnings {
        events.count(name);
    }
    let of_run = read.warnings.iter().chain(events.warnings()).map(|warning| warning.text.clone());
    of_run.chain(interrupt::warning()).collect()
}
