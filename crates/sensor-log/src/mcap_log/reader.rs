use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use mcap::MAGIC;
use mcap::records::op;

use super::chunk::ChunkRecords;
use super::decode;
use super::fields::Fields;
use super::frames::{Frame, Frames};
use super::origin;
use super::reorder::Reorder;
use super::routes::Route;
use crate::format::shortened;
use crate::{Format, LogEnd, LogError, Problem, ProblemKind, ReadReport, Record, Stamp};

/// The records of an MCAP file, chunk by chunk: memory does not grow with the file.
pub(crate) struct McapRecords {
    frames: Frames<BufReader<File>>,
    chunk: Option<ChunkRecords>,
    messages: Messages,
}

impl McapRecords {
    pub(crate) fn open(path: &Path) -> Result<Self, LogError> {
        let io = |source| LogError::io(path, source);
        let mut reader = BufReader::new(File::open(path).map_err(io)?);
        let mut magic = Vec::new();
        (&mut reader).take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(io)?;
        if magic.is_empty() {
            return Err(LogError::Empty { path: path.into() });
        }
        if magic != MAGIC {
            let reason = "it does not begin with the magic bytes of MCAP".to_owned();
            return Err(LogError::NotThisFormat { path: path.into(), format: Format::Mcap, reason });
        }
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { frames: Frames::new(reader), chunk: None, messages: Messages::new(file) })
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
        if let Some(chunk) = &mut self.chunk {
            match chunk.with_next(|opcode, body| self.messages.take(opcode, body, report)) {
                Some(Ok(())) => {}
                None => self.chunk = None,
                Some(Err(error)) => {
                    if !chunk.is_cut() {
                        let reason = format!("chunk left out: {error}");
                        self.messages.trouble(ProblemKind::DamagedChunk, reason, report);
                    }
                    self.chunk = None;
                }
            }
            return true;
        }
        match self.frames.next() {
            Frame::Record { opcode: op::CHUNK, body } => self.chunk = Some(ChunkRecords::whole(&body)),
            Frame::Record { opcode, body } => self.messages.take(opcode, &body, report),
            Frame::CutChunk { body, end } => {
                self.chunk = Some(ChunkRecords::cut(&body));
                report.end = end;
            }
            Frame::End(LogEnd::Complete) => return false,
            Frame::End(end) => {
                report.end = end;
                return false;
            }
        }
        true
    }
}

/// Schemas, channels, messages and metadata, wherever in the file they are.
struct Messages {
    file: String,
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    origin: Option<Format>,
    n_messages: u64,
    reorder: Reorder,
}

struct Channel {
    /// Topic and schema, for messages to people.
    name: String,
    route: Option<Route>,
}

impl Messages {
    fn new(file: String) -> Self {
        Self {
            file,
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            origin: None,
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
        self.schemas.insert(id, shortened(name));
        Some(())
    }

    fn channel(&mut self, mut fields: Fields<'_>) -> Option<()> {
        let (id, schema_id) = (fields.u16()?, fields.u16()?);
        let (topic, encoding) = (fields.str()?, fields.str()?);
        let schema = self.schemas.get(&schema_id).map_or("no schema", String::as_str);
        let metadata = fields.pairs().into_iter().flatten();
        let route = Route::of(topic, schema, encoding, metadata);
        self.channels.insert(id, Channel { name: format!("{} ({schema})", shortened(topic)), route });
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
        match decode::records(route, fields.0, log_time) {
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
