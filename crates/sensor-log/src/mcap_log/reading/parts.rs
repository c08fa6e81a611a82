use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use mcap::records::op;

use super::fields::Fields;
use super::stream::{RecordStream, Step};
use crate::{LogCompleteness, LogError};

/// The files of one recording, merged message by message in log-time order.
///
/// The messages of a file keep their order. A file is opened when its first message is due, so about one file of a split recording is open at a time.
pub(in crate::mcap_log) struct Parts {
    waiting: VecDeque<Waiting>,
    open: Vec<Part>,
}

struct Waiting {
    index: usize,
    path: PathBuf,
    first_log_time: u64,
}

struct Part {
    index: usize,
    stream: RecordStream,
    /// Log time and body of the next message, once it is read.
    next: Option<(u64, Vec<u8>)>,
    /// Log time of the message before.
    last_time: Option<u64>,
}

/// A log time further ahead than this of the message before it in its file is wrong, nanoseconds: no recording pauses for a day.
const LONGEST_PAUSE: u64 = 86_400 * 1_000_000_000;
/// Number of messages used to find the start of a file, because the first may have a wrong log time.
const FIRST_MESSAGES: usize = 10;

impl Parts {
    /// Opens the files; those without a message come last.
    pub(in crate::mcap_log) fn open(paths: &[PathBuf]) -> Result<Self, LogError> {
        if let [path] = paths {
            let part = Part { index: 0, stream: RecordStream::open(path)?, next: None, last_time: None };
            return Ok(Self { waiting: VecDeque::new(), open: vec![part] });
        }
        let waiting = |(index, path): (usize, &PathBuf)| {
            Ok(Waiting { index, path: path.clone(), first_log_time: first_log_time(path)? })
        };
        let mut waiting = paths.iter().enumerate().map(waiting).collect::<Result<Vec<_>, LogError>>()?;
        waiting.sort_by_key(|part| (part.first_log_time, part.index));
        Ok(Self { waiting: waiting.into(), open: Vec::new() })
    }

    /// Advances to the next record and passes it, with the index of its file, to `take`; returns the file of the step.
    pub(in crate::mcap_log) fn step(&mut self, mut take: impl FnMut(usize, u8, &[u8])) -> (usize, Step) {
        if let Some(at) = self.open.iter().position(|part| part.next.is_none()) {
            let is_alone = self.open.len() == 1 && self.waiting.is_empty();
            let Part { index, stream, next, last_time } = &mut self.open[at];
            let index = *index;
            let step = stream.step(|opcode, body| match log_time(opcode, body) {
                Some(time) if !is_alone => {
                    let expected = last_time.unwrap_or(time);
                    let time = if time.saturating_sub(expected) > LONGEST_PAUSE { expected } else { time };
                    *last_time = Some(time);
                    *next = Some((time, body.to_vec()));
                }
                _ => take(index, opcode, body),
            });
            return (index, self.after(at, step));
        }
        let due = |part: &Part| part.next.as_ref().map(|(time, _)| *time);
        let first_due = self.open.iter().filter_map(due).min();
        let is_due = |part: &Waiting| first_due.is_none_or(|first| part.first_log_time < first);
        if self.waiting.front().is_some_and(is_due)
            && let Some(waiting) = self.waiting.pop_front()
        {
            return (waiting.index, self.begin(waiting));
        }
        let Some(part) = self.open.iter_mut().min_by_key(|part| due(part)) else {
            return (0, Step::End(LogCompleteness::Complete));
        };
        if let Some((_, body)) = part.next.take() {
            take(part.index, op::MESSAGE, &body);
        }
        (part.index, Step::On)
    }

    fn begin(&mut self, Waiting { index, path, first_log_time }: Waiting) -> Step {
        match RecordStream::open(&path) {
            Ok(stream) => {
                self.open.push(Part { index, stream, next: None, last_time: Some(first_log_time) });
                // At equal times, messages of the earlier file come first.
                self.open.sort_by_key(|part| part.index);
                Step::On
            }
            Err(error) => Step::DamagedChunk(error.to_string()),
        }
    }

    /// The end of a file ends the recording only if it is the last file.
    fn after(&mut self, at: usize, step: Step) -> Step {
        let Step::End(end) = step else { return step };
        self.open.remove(at);
        match end {
            end if self.open.is_empty() && self.waiting.is_empty() => Step::End(end),
            LogCompleteness::Complete => Step::On,
            end => Step::Cut(end),
        }
    }
}

/// Log time of the first message; `u64::MAX` without messages.
fn first_log_time(path: &Path) -> Result<u64, LogError> {
    let mut stream = RecordStream::open(path)?;
    let mut times = Vec::new();
    while times.len() < FIRST_MESSAGES {
        if let Step::End(_) = stream.step(|opcode, body| times.extend(log_time(opcode, body))) {
            break;
        }
    }
    Ok(times.into_iter().min().unwrap_or(u64::MAX))
}

fn log_time(opcode: u8, body: &[u8]) -> Option<u64> {
    if opcode != op::MESSAGE {
        return None;
    }
    let mut fields = Fields(body);
    let (_channel, _sequence) = (fields.u16()?, fields.u32()?);
    fields.u64()
}
