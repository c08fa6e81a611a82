use wayfix_evaluation::terminal::print_message;
use wayfix_sensor_log::{Log, LogCompleteness, LogError, LogWarning, ReadReport, Record, RecordData};
use wayfix_system_core::{EventCounts, LogOverview};

use super::run::interrupt;

/// Reads all records of a log; prints read problems and assumptions.
pub(super) fn read_all(log: Log) -> (Vec<Record>, ReadReport) {
    let (records, read) = log.read_all();
    if !read.is_clean() {
        print_message(&read);
    }
    (records, read)
}

/// Reads what must be known of a log beforehand; prints read problems and assumptions.
pub(super) fn read_overview(
    open: impl Fn() -> Result<Log, LogError>,
    n_images: usize,
) -> Result<LogOverview, LogError> {
    let overview = LogOverview::read(open, n_images)?;
    if !overview.read.is_clean() {
        print_message(&overview.read);
    }
    Ok(overview)
}

/// The whole log in the place of an overview.
pub(super) fn whole(records: Vec<Record>, read: ReadReport) -> LogOverview {
    let is_image = |record: &&Record| matches!(record.data, RecordData::Image(_));
    let (n_records, n_images) = (records.len(), records.iter().filter(is_image).count());
    LogOverview { records, n_records, n_images, read }
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
    let of_run: Vec<String> = events.warnings().iter().map(|warning| warning.text.clone()).collect();
    add_read_report(events, read).chain(of_run).chain(interrupt::warning()).collect()
}

/// Counts the read problems of a log, and returns its warnings.
pub(super) fn add_read_report<'a>(
    events: &mut EventCounts,
    read: &'a ReadReport,
) -> impl Iterator<Item = String> + use<'a> {
    events.add("log_problem", read.n_problems());
    if read.end != LogCompleteness::Complete {
        events.count("log_incomplete");
    }
    for LogWarning { name, .. } in &read.warnings {
        events.count(name);
    }
    read.warnings.iter().map(|warning| warning.text.clone())
}
