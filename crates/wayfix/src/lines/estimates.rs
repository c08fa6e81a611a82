use std::{fs::File, io::BufWriter, path::Path};

use wayfix_sensor_log::{Data, Drawing, Format, LogError, McapWriter, Record, Shape, topics};

use super::{LineSystem, ScanWalls};

/// Writes the records of the log and the walls into an MCAP file for viewers.
pub struct LineLog {
    writer: McapWriter<BufWriter<File>>,
    n_written: usize,
    /// Walls of the scan before: those that the next has not are drawn over with nothing.
    n_walls: usize,
    /// What the walls are given in: the laser's frame once the log has placed it, else the robot's.
    frame: &'static str,
    failure: Option<LogError>,
}

const WALL_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

impl LineLog {
    /// Creates the file; `origin` is the format that the records come from.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn create(path: &Path, origin: Format) -> Result<Self, LogError> {
        let mut writer = McapWriter::create(path)?;
        writer.origin(origin)?;
        Ok(Self { writer, n_written: 0, n_walls: 0, frame: topics::BODY_FRAME, failure: None })
    }

    /// Writes a record of the log and what the system made of it. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &LineSystem) {
        if self.failure.is_none() {
            self.failure = self.write(record, system).err();
        }
    }

    /// Completes the file.
    ///
    /// # Errors
    /// When anything could not be written.
    pub fn finish(self) -> Result<(), LogError> {
        match self.failure {
            Some(failure) => Err(failure),
            None => self.writer.finish(),
        }
    }

    fn write(&mut self, record: &Record, system: &LineSystem) -> Result<(), LogError> {
        match self.writer.record(record) {
            Err(LogError::NotFinite { .. }) => {} // refused by the system and counted there
            written => written?,
        }
        if let Data::TruePose(pose) | Data::EstimatedPose(pose) = &record.data {
            let (world, body) = (topics::WORLD_FRAME, topics::BODY_FRAME);
            self.writer.frame_transform("/tf", record.stamp, world, body, pose)?;
        }
        if let Data::LaserMount(_) = record.data {
            self.frame = topics::LASER_FRAME;
        }
        let Some(scan) = system.scans().get(self.n_written) else { return Ok(()) };
        self.n_written += 1;
        let drawings = drawings(scan, self.n_walls);
        self.n_walls = scan.segments.len();
        self.writer.scene_update("/walls", scan.stamp, self.frame, &drawings)
    }
}

fn drawings(scan: &ScanWalls, n_before: usize) -> Vec<Drawing> {
    let path = |wall: usize| match scan.segments.get(wall) {
        Some(segment) => vec![segment.start.into(), segment.end.into()],
        None => Vec::new(),
    };
    (0..n_before.max(scan.segments.len()))
        .map(|wall| Drawing { id: format!("wall {wall}"), color: WALL_COLOR, shape: Shape::Path(path(wall)) })
        .collect()
}
