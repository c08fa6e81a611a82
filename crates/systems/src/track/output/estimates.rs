use std::{
    fs::File,
    io::{BufWriter, Write},
    path::Path,
};

use anyhow::{Context, Result};
use wayfix_sensor_log::{
    FoxgloveMessageWriter, ImageOutline, LogFormat, McapMessageSink, MessageSinks, Record, RecordData, topics,
};
use wayfix_system_core::EstimateWriter;
use wayfix_visual_tracking::TrackStatus;

use super::super::{TargetTruth, TrackFrameResult, TrackSystem};
use super::{overlay, run_history::outline};

/// Writes images with outlines to an MCAP file or to viewers, and boxes to a text in the format of the truth.
pub struct TrackEstimateRecorder {
    writer: EstimateWriter,
    boxes: Box<dyn Write>,
    n_lines: usize,
    has_echo: bool,
    failure: Option<anyhow::Error>,
}

impl TrackEstimateRecorder {
    /// Creates both files; `origin` is the format of the source log.
    ///
    /// # Errors
    /// Returns an error if a file cannot be created.
    pub fn create(log: &Path, boxes: &Path, origin: LogFormat) -> Result<Self> {
        let file = File::create(boxes).with_context(|| format!("cannot create {}", boxes.display()))?;
        Self::new(vec![Box::new(McapMessageSink::create(log)?)], Box::new(BufWriter::new(file)), origin)
    }

    /// Writes images and outlines into all of `sinks`.
    ///
    /// # Errors
    /// Returns an error if a sink fails.
    pub fn new(sinks: MessageSinks, boxes: Box<dyn Write>, origin: LogFormat) -> Result<Self> {
        let mut writer = FoxgloveMessageWriter::into_sink(sinks);
        writer.origin(origin)?;
        Ok(Self { writer, boxes, n_lines: 0, has_echo: true, failure: None })
    }

    /// Writes the outlines only, without the images of the log.
    pub fn without_echo(self) -> Self {
        Self { has_echo: false, ..self }
    }

    /// Writes an image of the log and the tracker's outline. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &TrackSystem) {
        if self.failure.is_none() {
            self.failure = self.write(record, system).err();
        }
    }

    /// Finishes both outputs; `n_frames` is the number of frames.
    ///
    /// # Errors
    /// Returns an error if any write failed.
    pub fn finish(mut self, n_frames: usize) -> Result<()> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        self.fill_up(n_frames)?;
        self.boxes.flush()?;
        Ok(self.writer.finish()?)
    }

    fn write(&mut self, record: &Record, system: &TrackSystem) -> Result<()> {
        if !matches!(record.data, RecordData::Image(_)) {
            return Ok(());
        }
        if self.has_echo {
            self.writer.record(record)?;
        }
        let Some(frame) = system.frame() else { return Ok(()) };
        self.writer.image_outlines(topics::TARGET, frame.stamp, &outlines(frame))?;
        self.fill_up(frame.index)?;
        self.n_lines += 1;
        match frame.target.status {
            TrackStatus::Lost => writeln!(self.boxes, "NaN,NaN,NaN,NaN")?,
            TrackStatus::Tracked => {
                let target = &frame.target.bounding_box;
                let [x, y] = target.corner();
                writeln!(self.boxes, "{x:.2},{y:.2},{:.2},{:.2}", target.width(), target.height())?;
            }
        }
        Ok(())
    }

    /// Writes lines for the frames before `index` without an estimate.
    fn fill_up(&mut self, index: usize) -> Result<()> {
        while self.n_lines < index {
            self.n_lines += 1;
            writeln!(self.boxes, "NaN,NaN,NaN,NaN")?;
        }
        Ok(())
    }
}

fn outlines(frame: &TrackFrameResult) -> Vec<ImageOutline> {
    let ink = |[r, g, b]: [u8; 3]| [r, g, b, 255].map(|value| f64::from(value) / 255.0);
    let color = if frame.target.status == TrackStatus::Lost { overlay::LOST } else { overlay::ESTIMATE };
    let mut outlines = vec![ImageOutline { color: ink(color), points: outline(&frame.target) }];
    if let TargetTruth::At(truth) = &frame.truth {
        outlines.push(ImageOutline { color: ink(overlay::TRUTH), points: overlay::corners(truth).to_vec() });
    }
    outlines
}
