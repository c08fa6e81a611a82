use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mcap::records::op;

use super::super::origin;
use super::fields::Fields;
use super::parts::Parts;
use super::reorder::Reorder;
use super::routes::Route;
use super::stream::{RecordStream, Step};
use super::topic_clock::TopicClock;
use super::{decode, topic_listing};
use crate::bag::{BagRecords, BagRoute, Choice};
use crate::formats::format::shortened;
use crate::{
    BagTopic, LogCompleteness, LogError, LogFormat, ReadReport, Record, RecordData, RowProblem,
    RowProblemKind, Stamp,
};

/// The records of an MCAP file, or of several of one recording, chunk by chunk: memory does not grow with them.
pub(crate) struct McapRecords {
    parts: Parts,
    messages: Messages,
    topics: Vec<BagTopic>,
}

impl McapRecords {
    /// Opens the files of the log at `source`. Reads ROS 2 messages on the topics `wanted`, and for each other kind those of one topic.
    ///
    /// An unreadable file among several is skipped and reported.
    pub(crate) fn open(
        source: &Path,
        files: &[PathBuf],
        wanted: &[String],
        report: &mut ReadReport,
    ) -> Result<Self, LogError> {
        let files = &readable(files, report)?;
        let parts = Parts::open(files)?;
        let topics = topic_listing::topics(files)?;
        // Problems of a file are reported when it is read.
        let tried = |topic_probes| topic_listing::passed(files, &topics, topic_probes).unwrap_or_default();
        let choice = Choice::among(&topics, wanted, tried).map_err(|error| error.of(source, &topics))?;
        Ok(Self {
            parts,
            topics: choice.uses(&topics),
            messages: Messages::new(files, BagRecords::new(choice)),
        })
    }

    /// The topics of ROS 2 messages and their use.
    pub(crate) fn topics(&self) -> &[BagTopic] {
        &self.topics
    }

    /// The original format of the records, if it was read so far.
    pub(crate) fn origin(&self) -> Option<LogFormat> {
        self.messages.origin
    }

    /// The next record in time order; problems go into the report.
    pub(crate) fn next(&mut self, report: &mut ReadReport) -> Option<Record> {
        loop {
            if let Some(record) = self.messages.reorder.pop_ready() {
                return Some(record);
            }
            if !self.step(report) {
                return self.messages.reorder.pop();
            }
        }
    }

    /// Reads one record of the file; false at its end.
    fn step(&mut self, report: &mut ReadReport) -> bool {
        let (file, step) =
            self.parts.step(|file, opcode, body| self.messages.take(file, opcode, body, report));
        match step {
            Step::On => true,
            Step::DamagedChunk(error) => {
                let reason = format!("chunk left out: {error}");
                self.messages.trouble(file, RowProblemKind::DamagedChunk, reason, report);
                true
            }
            Step::Cut(end) => {
                report.end = end;
                true
            }
            Step::End(end) => {
                if end != LogCompleteness::Complete {
                    report.end = end;
                }
                self.messages.finish(report);
                false
            }
        }
    }
}

/// The files that can be opened; the others are reported, unless there is none.
fn readable(files: &[PathBuf], report: &mut ReadReport) -> Result<Vec<PathBuf>, LogError> {
    let mut readable = Vec::new();
    let mut first_error = None;
    for path in files {
        match RecordStream::open(path) {
            Ok(_) => readable.push(path.clone()),
            Err(error) => {
                let reason = format!("left out: {error}");
                report.add(RowProblem {
                    file: file_name(path),
                    row: 0,
                    kind: RowProblemKind::UnreadableFile,
                    reason,
                });
                first_error = first_error.or(Some(error));
            }
        }
    }
    match first_error {
        Some(error) if readable.is_empty() => Err(error),
        _ => Ok(readable),
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Messages and metadata, wherever in the files they are.
struct Messages {
    files: Vec<FileState>,
    origin: Option<LogFormat>,
    bag: BagRecords,
    clocks: BTreeMap<String, TopicClock>,
    set_back: Option<SetBack>,
    reorder: Reorder,
}

/// The clock was set back: later records are skipped.
struct SetBack {
    topic: String,
    from: Stamp,
    to: Stamp,
    n_left_out: u64,
}

/// Schemas and channels of a file so far; each file numbers its own.
#[derive(Default)]
struct FileState {
    name: String,
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    n_messages: u64,
}

struct Channel {
    /// Topic and schema, for messages to people.
    name: String,
    route: Option<AnyRoute>,
}

/// Conversion of the messages of a channel.
#[derive(Clone, Copy)]
enum AnyRoute {
    Foxglove(Route),
    Ros(BagRoute),
}

impl Messages {
    fn new(files: &[PathBuf], bag: BagRecords) -> Self {
        let state = |path: &PathBuf| FileState { name: file_name(path), ..FileState::default() };
        let files = files.iter().map(state).collect();
        Self {
            files,
            origin: None,
            bag,
            clocks: BTreeMap::new(),
            set_back: None,
            reorder: Reorder::default(),
        }
    }

    fn take(&mut self, file: usize, opcode: u8, body: &[u8], report: &mut ReadReport) {
        let understood = match opcode {
            op::SCHEMA => self.schema(file, Fields(body)),
            op::CHANNEL => self.channel(file, Fields(body)),
            op::MESSAGE => self.message(file, Fields(body), report),
            op::METADATA => {
                self.origin = self.origin.or(origin::decode(body));
                Some(())
            }
            _ => Some(()),
        };
        if understood.is_none() {
            let reason = format!("record of kind {opcode} breaks off");
            self.trouble(file, RowProblemKind::Undecodable, reason, report);
        }
    }

    fn schema(&mut self, file: usize, mut fields: Fields<'_>) -> Option<()> {
        let (id, name) = (fields.u16()?, fields.str()?);
        self.files[file].schemas.insert(id, name.to_owned());
        Some(())
    }

    fn channel(&mut self, file: usize, mut fields: Fields<'_>) -> Option<()> {
        let (id, schema_id) = (fields.u16()?, fields.u16()?);
        let (topic, encoding) = (fields.str()?, fields.str()?);
        let schema = self.files[file].schemas.get(&schema_id).map_or("no schema", String::as_str);
        let metadata = fields.pairs().into_iter().flatten();
        let route = match encoding {
            "cdr" => self.bag.route(topic, schema).map(AnyRoute::Ros),
            _ => Route::of(topic, schema, encoding, metadata).map(AnyRoute::Foxglove),
        };
        let name = format!("{} ({})", shortened(topic), shortened(schema));
        self.files[file].channels.insert(id, Channel { name, route });
        Some(())
    }

    fn message(&mut self, file: usize, mut fields: Fields<'_>, report: &mut ReadReport) -> Option<()> {
        let (channel_id, _sequence) = (fields.u16()?, fields.u32()?);
        let (log_time, _publish_time) = (Stamp::from_nanoseconds(fields.u64()?), fields.u64()?);
        self.files[file].n_messages += 1;
        let Some(channel) = self.files[file].channels.get(&channel_id) else {
            let reason = format!("message on the unannounced channel {channel_id}");
            self.trouble(file, RowProblemKind::Unrecognized, reason, report);
            return Some(());
        };
        let Some(route) = channel.route else {
            report.ignore(&channel.name);
            return Some(());
        };
        if let Some(set_back) = &mut self.set_back {
            set_back.n_left_out += 1;
            return Some(());
        }
        let name = channel.name.clone();
        let records = match route {
            AnyRoute::Foxglove(route) => decode::records(route, fields.0, log_time),
            AnyRoute::Ros(route) => self.bag.take(route, fields.0, log_time),
        };
        match records {
            Ok(records) => {
                report.rows_read += 1;
                for record in records {
                    match &record.data {
                        RecordData::Image(image) => report.warn_of_orientation(image),
                        RecordData::Scan(scan) => self.bag.note_range_limit(scan),
                        _ => {}
                    }
                    self.check_clock(file, &name, record, report);
                }
            }
            Err((kind, reason)) => self.trouble(file, kind, format!("{name}: {reason}"), report),
        }
        for (kind, reason) in self.bag.take_faults() {
            self.trouble(file, kind, format!("{name}: {reason}"), report);
        }
        Some(())
    }

    fn check_clock(&mut self, file: usize, topic: &str, record: Record, report: &mut ReadReport) {
        let clock = self.clocks.entry(topic.to_owned()).or_default();
        let checked = clock.check(record);
        for record in &checked.wrong {
            self.wrong_stamp(file, topic, record, report);
        }
        self.release(file, checked.passed, report);
        if let Some((from, to)) = checked.set_back {
            self.set_back = Some(SetBack { topic: topic.to_owned(), from, to, n_left_out: 0 });
        }
    }

    fn wrong_stamp(&self, file: usize, topic: &str, record: &Record, report: &mut ReadReport) {
        let latest = self.clocks.get(topic).and_then(TopicClock::latest);
        let kind =
            if Some(record.stamp) < latest { RowProblemKind::TooLate } else { RowProblemKind::BadStamp };
        let reason = format!("{topic}: the stamp {} does not follow those before it; left out", record.stamp);
        self.trouble(file, kind, reason, report);
    }

    /// Reports the facts known only at the end.
    fn finish(&mut self, report: &mut ReadReport) {
        let held = self
            .clocks
            .iter_mut()
            .flat_map(|(topic, clock)| clock.finish().into_iter().map(move |record| (topic.clone(), record)));
        let held: Vec<(String, Record)> = held.collect();
        for (topic, record) in &held {
            self.wrong_stamp(self.files.len() - 1, topic, record, report);
        }
        if let Some(SetBack { topic, from, to, n_left_out }) = self.set_back.take() {
            let text = format!(
                "the clock is set back from {from} to {to} ({topic}): the log is cut there, {n_left_out} messages after it are left out"
            );
            report.warn("clock_set_back", text);
        }
        for (name, text) in self.bag.warnings() {
            report.warn(name, text);
        }
    }

    fn release(&mut self, file: usize, records: Vec<Record>, report: &mut ReadReport) {
        for record in records {
            if let Err(late) = self.reorder.push(record) {
                let reason =
                    format!("{} is too late, {} is already out; left out", late.stamp, late.last_out);
                self.trouble(file, RowProblemKind::TooLate, reason, report);
            }
        }
    }

    fn trouble(&self, file: usize, kind: RowProblemKind, reason: String, report: &mut ReadReport) {
        let FileState { name, n_messages, .. } = &self.files[file];
        report.add(RowProblem { file: name.clone(), row: *n_messages, kind, reason });
    }
}
