//! Which topics a file has, before its messages are read.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use mcap::MAGIC;
use mcap::records::op;

use super::fields::Fields;
use super::stream::{RecordStream, Step};
use crate::LogError;
use crate::bag::{TopicInfo, TopicProbe};

/// Opcode and length before each record, the two offsets and the checksum of the footer.
const FOOTER_BYTES: i64 = 9 + 20;
/// Maximum size of a summary that is read, in bytes.
const MAX_SUMMARY_BYTES: u64 = 64 << 20;

/// The topics of the files of a log in the order in which they are announced, each with the number of its messages.
pub(in crate::mcap_log) fn topics(files: &[PathBuf]) -> Result<Vec<TopicInfo>, LogError> {
    let mut all: Vec<TopicInfo> = Vec::new();
    for path in files {
        for topic in topics_of(path)? {
            match all.iter_mut().find(|known| known.is_same_as(&topic)) {
                Some(known) => known.n_messages += topic.n_messages,
                None => all.push(topic),
            }
        }
    }
    Ok(all)
}

/// Uses the index at the end of the file; without one, as in a truncated file, scans the whole file.
fn topics_of(path: &Path) -> Result<Vec<TopicInfo>, LogError> {
    match summary(path) {
        Ok(Some(topics)) => Ok(topics),
        // Problems of the file are reported when it is read.
        Ok(None) | Err(_) => counted(path),
    }
}

/// Probes topics and returns which passed.
pub(in crate::mcap_log) fn passed(
    files: &[PathBuf],
    topics: &[TopicInfo],
    mut topic_probes: Vec<TopicProbe>,
) -> Result<Vec<usize>, LogError> {
    let mut passed = Vec::new();
    for path in files {
        run_probes(path, topics, &mut topic_probes, &mut passed)?;
    }
    let left = topic_probes.iter().filter(|question| question.probe.at_end());
    passed.extend(left.map(|question| question.index));
    Ok(passed)
}

/// Answers the probes of topics that the file has an answer to.
fn run_probes(
    path: &Path,
    topics: &[TopicInfo],
    topic_probes: &mut Vec<TopicProbe>,
    passed: &mut Vec<usize>,
) -> Result<(), LogError> {
    let mut stream = RecordStream::open(path)?;
    let mut announced = Announced::default();
    while !topic_probes.is_empty() {
        let step = stream.step(|opcode, body| {
            let Some((topic, bytes)) = announced.take(opcode, body) else { return };
            let asks = |question: &TopicProbe| topics[question.index].is_same_as(topic);
            let Some(at) = topic_probes.iter().position(asks) else { return };
            let TopicProbe { index, schema, probe } = &mut topic_probes[at];
            if let Some(has_passed) = probe.inspect(*schema, bytes) {
                passed.extend(has_passed.then_some(*index));
                topic_probes.remove(at);
            }
        });
        if let Step::End(_) = step {
            break;
        }
    }
    Ok(())
}

/// Topics with the messages that are really there.
fn counted(path: &Path) -> Result<Vec<TopicInfo>, LogError> {
    let mut stream = RecordStream::open(path)?;
    let mut announced = Announced::default();
    let mut count = |opcode: u8, body: &[u8]| {
        let _ = announced.take(opcode, body);
    };
    while !matches!(stream.step(&mut count), Step::End(_)) {}
    Ok(announced.topics)
}

/// The topics in the index; `None` if it is missing or has no message counts.
fn summary(path: &Path) -> io::Result<Option<Vec<TopicInfo>>> {
    let mut file = BufReader::new(File::open(path)?);
    let magic_bytes = MAGIC.len() as i64;
    let footer_at = file.seek(SeekFrom::End(-(FOOTER_BYTES + magic_bytes)))?;
    let mut footer = Vec::new();
    file.by_ref().take(FOOTER_BYTES as u64).read_to_end(&mut footer)?;
    let Some((&op::FOOTER, body)) = footer.split_first() else { return Ok(None) };
    let mut fields = Fields(body);
    let (Some(20), Some(start)) = (fields.u64(), fields.u64()) else { return Ok(None) };
    let Some(n_bytes) = footer_at.checked_sub(start).filter(|_| start > 0) else { return Ok(None) };
    if n_bytes > MAX_SUMMARY_BYTES {
        return Ok(None);
    }
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    file.take(n_bytes).read_to_end(&mut bytes)?;
    Ok(read_summary(&bytes))
}

fn read_summary(bytes: &[u8]) -> Option<Vec<TopicInfo>> {
    let (mut announced, mut counts) = (Announced::default(), None);
    let mut rest = Fields(bytes);
    while let Some(opcode) = rest.u8() {
        let body = rest.bytes()?;
        match opcode {
            op::STATISTICS => counts = Some(message_counts(Fields(body))?),
            _ => drop(announced.take(opcode, body)),
        }
    }
    let counts = counts?;
    // A writer may leave schemas and channels out of the index.
    let is_known = |channel| announced.channels.contains_key(channel);
    if !counts.keys().all(is_known) || announced.topics.iter().any(|topic| topic.schema.is_empty()) {
        return None;
    }
    for (channel, topic) in &announced.channels {
        announced.topics[*topic].n_messages += counts.get(channel).copied().unwrap_or_default();
    }
    Some(announced.topics)
}

/// Messages by channel, from the record of statistics.
fn message_counts(mut fields: Fields<'_>) -> Option<BTreeMap<u16, u64>> {
    let (_messages, _schemas) = (fields.u64()?, fields.u16()?);
    let _channels_attachments_metadata_chunks = (fields.u32()?, fields.u32()?, fields.u32()?, fields.u32()?);
    let (_first, _last) = (fields.u64()?, fields.u64()?);
    let mut entries = Fields(fields.sized()?);
    Some(std::iter::from_fn(|| Some((entries.u16()?, entries.u64()?))).collect())
}

/// Schemas and channels as they are announced, and the messages of each topic.
#[derive(Default)]
struct Announced {
    schemas: BTreeMap<u16, String>,
    /// Index of the topic of each channel.
    channels: BTreeMap<u16, usize>,
    topics: Vec<TopicInfo>,
}

impl Announced {
    /// Processes a record; for a message returns the topic and the bytes.
    fn take<'a>(&mut self, opcode: u8, body: &'a [u8]) -> Option<(&TopicInfo, &'a [u8])> {
        let mut fields = Fields(body);
        match opcode {
            op::SCHEMA => {
                let (id, name) = (fields.u16()?, fields.str()?);
                self.schemas.insert(id, name.to_owned());
                None
            }
            op::CHANNEL => {
                let (id, schema_id) = (fields.u16()?, fields.u16()?);
                let (name, encoding) = (fields.str()?.to_owned(), fields.str()?.to_owned());
                let schema = self.schemas.get(&schema_id).cloned().unwrap_or_default();
                let topic = TopicInfo { name, schema, encoding, n_messages: 0 };
                let known = self.topics.iter().position(|known| known.is_same_as(&topic));
                let index = known.unwrap_or_else(|| {
                    self.topics.push(topic);
                    self.topics.len() - 1
                });
                self.channels.insert(id, index);
                None
            }
            op::MESSAGE => {
                let (channel, _sequence) = (fields.u16()?, fields.u32()?);
                let (_log_time, _publish_time) = (fields.u64()?, fields.u64()?);
                let topic = &mut self.topics[*self.channels.get(&channel)?];
                topic.n_messages += 1;
                Some((topic, fields.0))
            }
            _ => None,
        }
    }
}
