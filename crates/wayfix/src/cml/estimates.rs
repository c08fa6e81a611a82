use std::{fs::File, io::BufWriter, path::Path};

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Format, LogError, McapWriter, Record, topics};

use super::CmlSystem;

/// Writes the estimates beside the records into an MCAP file, so that Foxglove and Rerun show the views, the path and the references.
pub struct CmlEstimateLog {
    writer: McapWriter<BufWriter<File>>,
    n_written: usize,
    path: Vec<Pose2<f64>>,
    failure: Option<LogError>,
}

/// The whole path and the references are written with every so many views.
const PERIOD: usize = 20;

impl CmlEstimateLog {
    /// Creates the file; `origin` is the format that the records come from.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn create(path: &Path, origin: Format) -> Result<Self, LogError> {
        let mut writer = McapWriter::create(path)?;
        writer.origin(origin)?;
        Ok(Self { writer, n_written: 0, path: Vec::new(), failure: None })
    }

    /// Writes a record and what the system made of it. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &CmlSystem) {
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

    fn write(&mut self, record: &Record, system: &CmlSystem) -> Result<(), LogError> {
        match self.writer.record(record) {
            Err(LogError::NotFinite { .. }) => {} // refused by the system and counted there
            written => written?,
        }
        let Some(frame) = system.frames().get(self.n_written) else { return Ok(()) };
        self.n_written += 1;
        let (stamp, world) = (frame.stamp, topics::WORLD_FRAME);
        if let Some(pose) = frame.pose.as_ref().map(|pose| *pose.mean()) {
            self.path.push(pose);
            self.writer.pose_in_frame(topics::ESTIMATED_POSE, stamp, world, &pose)?;
            self.writer.frame_transform("/tf", stamp, world, topics::BODY_FRAME, &pose)?;
        }
        if self.n_written % PERIOD == 1 {
            self.writer.poses_in_frame("/estimate/path", stamp, world, &self.path)?;
            let references = system.localizer().map().references().values();
            let places = references.flat_map(|reference| &reference.places);
            let points: Vec<[f64; 2]> =
                places.map(|place| [place.gaussian.mean().x(), place.gaussian.mean().y()]).collect();
            self.writer.point_cloud("/estimate/references", stamp, world, &points)?;
        }
        Ok(())
    }
}
