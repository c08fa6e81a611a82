use std::collections::BTreeMap;
use std::path::Path;

use mcap::records::op;

use super::fields::Fields;
use super::reorder::Reorder;
use super::routes::Route;
use super::stream::{RecordStream, Step};
use super::{decode, origin, survey};
use crate::bag::{BagRecords, BagRoute, Choice};
use crate::format::shortened;
use crate::{Format, LogEnd, LogError, Problem, ProblemKind, ReadReport, Record, Stamp, Topic};

/// The records of an MCAP file, chunk by chunk: memory does not grow with the file.
pub(crate) struct McapRecords {
    stream: RecordStream,
    messages: Messages,
    topics: Vec<Topic>,
}

impl McapRecords {
    /// Opens the file; of ROS 2 messages those on the topics `wanted` are read, and of kinds of which none is wanted those on one topic each.
    pub(crate) fn open(path: &Path, wanted: &[String]) -> Result<Self, LogError> {
        let stream = RecordStream::open(path)?;
        let topics = survey::topics(path)?;
        // What is wrong with the file will be told where it is read.
        let tried = |questions| survey::passed(path, &topics, questions).unwrap_or_default();
        let choice = Choice::among(&topics, wanted, tried).map_err(|error| error.of(path, &topics))?;
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self {
            stream,
            topics: choice.uses(&topics),
            messages: Messages::new(file, BagRecords::new(choice)),
        })
    }

    /// The topics of ROS 2 messages and what becomes of them.
    pub(crate) fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The format that the records come from, when it was announced so far.
    pub(crate) fn origin(&self) -> Option<Format> {
        self.messages.origin
    }

    /// The next record in time order; trouble goes into the report.
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
        match self.stream.step(|opcode, body| self.messages.take(opcode, body, report)) {
            Step::On => true,
            Step::DamagedChunk(error) => {
                self.messages.trouble(ProblemKind::DamagedChunk, format!("chunk left out: {error}"), report);
                true
            }
            Step::Cut(end) => {
                report.end = end;
                true
            }
            Step::End(end) => {
                if end != LogEnd::Complete {
                    report.end = end;
                }
                false
            }
        }
    }
}

/// Schemas, channels, messages and metadata, wherever in the file they are.
struct Messages {
    file: String,
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    origin: Option<Format>,
    bag: BagRecords,
    n_messages: u64,
    reorder: Reorder,
}

struct Channel {
    /// Topic and schema, for messages to people.
    name: String,
    route: Option<AnyRoute>,
}

/// What the messages of a channel become.
#[derive(Clone, Copy)]
enum AnyRoute {
    Foxglove(Route),
    Ros(BagRoute),
}

impl Messages {
    fn new(file: String, bag: BagRecords) -> Self {
        Self {
            file,
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            origin: None,
            bag,
            n_messages: 0,
            reorder: Reorder::default(),
        }
    }

    fn take(&mut self, opcode: u8, body: &[u8], report: &mut ReadReport) {
        let understood = match opcode {
            op::SCHEMA => self.schema(Fields(body)),
            op::CHANNEL => self.channel(Fields(body)),
            op::MESSAGE => self.message(Fields(body), report),
            op::METADATA => {
                self.origin = self.origin.or(origin::decode(body));
                Some(())
            }
            _ => Some(()),
        };
        if understood.is_none() {
            let reason = format!("record of kind {opcode} breaks off");
            self.trouble(ProblemKind::Undecodable, reason, report);
        }
    }

    fn schema(&mut self, mut fields: Fields<'_>) -> Option<()> {
        let (id, name) = (fields.u16()?, fields.str()?);
        self.schemas.insert(id, name.to_owned());
        Some(())
    }

    fn channel(&mut self, mut fields: Fields<'_>) -> Option<()> {
        let (id, schema_id) = (fields.u16()?, fields.u16()?);
        let (topic, encoding) = (fields.str()?, fields.str()?);
        let schema = self.schemas.get(&schema_id).map_or("no schema", String::as_str);
        let metadata = fields.pairs().into_iter().flatten();
        let route = match encoding {
            "cdr" => self.bag.route(topic, schema).map(AnyRoute::Ros),
            _ => Route::of(topic, schema, encoding, metadata).map(AnyRoute::Foxglove),
        };
        let name = format!("{} ({})", shortened(topic), shortened(schema));
        self.channels.insert(id, Channel { name, route });
        Some(())
    }

    fn message(&mut self, mut fields: Fields<'_>, report: &mut ReadReport) -> Option<()> {
        let (channel_id, _sequence) = (fields.u16()?, fields.u32()?);
        let (log_time, _publish_time) = (Stamp::from_nanoseconds(fields.u64()?), fields.u64()?);
        self.n_messages += 1;
        let Some(channel) = self.channels.get(&channel_id) else {
            let reason = format!("message on the unannounced channel {channel_id}");
            self.trouble(ProblemKind::Unrecognized, reason, report);
            return Some(());
        };
        let Some(route) = channel.route else {
            report.ignore(&channel.name);
            return Some(());
        };
        let records = match route {
            AnyRoute::Foxglove(route) => decode::records(route, fields.0, log_time),
            AnyRoute::Ros(route) => self.bag.take(route, fields.0, log_time),
        };
        match records {
            Ok(records) => {
                report.rows_read += 1;
                self.release(records, report);
            }
            Err((kind, reason)) => {
                let reason = format!("{}: {reason}", channel.name);
                self.trouble(kind, reason, report);
            }
        }
        Some(())
    }

    fn release(&mut self, records: Vec<Record>, report: &mut ReadReport) {
        for record in records {
            if let Err(late) = self.reorder.push(record) {
                let reason =
                    format!("{} is too late, {} is already out; left out", late.stamp, late.last_out);
                self.trouble(ProblemKind::TooLate, reason, report);
            }
        }
    }

    fn trouble(&self, kind: ProblemKind, reason: String, report: &mut ReadReport) {
        report.add(Problem { file: self.file.clone(), row: self.n_messages, kind, reason });
    }
}
