use std::collections::BTreeMap;

use crate::{Record, RecordData, Stamp};

/// Number of records buffered to sort late ones.
const WINDOW_RECORDS: usize = 256;
/// Maximum size of buffered detections and images, in bytes.
const WINDOW_BYTES: usize = 32 << 20;

/// Sorts slightly out-of-order records, with bounded memory.
///
/// Recorders write messages on arrival, and camera messages have a larger delay than encoder messages. Equal stamps keep the file order.
#[derive(Debug, Default)]
pub(in crate::mcap_log) struct Reorder {
    held: BTreeMap<(Stamp, u64), Record>,
    n_bytes: usize,
    n_pushed: u64,
    last_out: Stamp,
}

/// A record so late that later ones are already out; it is dropped.
pub(in crate::mcap_log) struct TooLate {
    pub(in crate::mcap_log) stamp: Stamp,
    pub(in crate::mcap_log) last_out: Stamp,
}

impl Reorder {
    pub(in crate::mcap_log) fn push(&mut self, record: Record) -> Result<(), TooLate> {
        let stamp = record.stamp;
        if stamp < self.last_out {
            return Err(TooLate { stamp, last_out: self.last_out });
        }
        self.n_bytes += n_bytes(&record);
        self.n_pushed += 1;
        self.held.insert((stamp, self.n_pushed), record);
        Ok(())
    }

    /// The earliest record once enough others are known.
    pub(in crate::mcap_log) fn pop_ready(&mut self) -> Option<Record> {
        let is_ready = self.held.len() > WINDOW_RECORDS || self.n_bytes > WINDOW_BYTES;
        if is_ready { self.pop() } else { None }
    }

    /// The earliest record.
    pub(in crate::mcap_log) fn pop(&mut self) -> Option<Record> {
        let ((stamp, _), record) = self.held.pop_first()?;
        self.last_out = stamp;
        self.n_bytes -= n_bytes(&record);
        Some(record)
    }
}

/// Heap size of a record, in bytes.
fn n_bytes(record: &Record) -> usize {
    match &record.data {
        RecordData::Detections(detections) => size_of_val(detections.as_slice()),
        RecordData::DetectionWidths(widths) => size_of_val(widths.as_slice()),
        RecordData::Scan(scan) => size_of_val(scan.ranges.as_slice()),
        RecordData::Image(image) | RecordData::TrueLabels(image) => image.bytes.len(),
        _ => 0,
    }
}
