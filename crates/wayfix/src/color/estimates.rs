use std::{fs::File, io::BufWriter, path::Path};

use nalgebra::Matrix2;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::CovarianceEllipse;
use wayfix_sensor_log::{Drawing, Format, LogError, McapWriter, Record, Shape, topics};

use super::{ColorSystem, FrameResult};

/// Writes the estimates beside the records of the log into an MCAP file, so that Foxglove and Rerun show the camera's images, the path and
/// the particles.
pub struct ColorEstimateLog {
    writer: McapWriter<BufWriter<File>>,
    n_written: usize,
    path: Vec<Pose2<f64>>,
    failure: Option<LogError>,
}

/// The whole path is written with every so many frames.
const PATH_PERIOD: usize = 20;
/// Ellipses are drawn at two standard deviations.
const SIGMAS: f64 = 2.0;
const ROBOT_COLOR: [f64; 4] = [0.12, 0.47, 0.71, 1.0];

impl ColorEstimateLog {
    /// Creates the file; `origin` is the format that the records come from.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn create(path: &Path, origin: Format) -> Result<Self, LogError> {
        let mut writer = McapWriter::create(path)?;
        writer.origin(origin)?;
        Ok(Self { writer, n_written: 0, path: Vec::new(), failure: None })
    }

    /// Writes a record of the log and what the system made of it. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &ColorSystem) {
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

    fn write(&mut self, record: &Record, system: &ColorSystem) -> Result<(), LogError> {
        match self.writer.record(record) {
            Err(LogError::NotFinite { .. }) => {} // refused by the system and counted there
            written => written?,
        }
        let Some(frame) = system.frames().get(self.n_written) else { return Ok(()) };
        self.n_written += 1;
        let (stamp, pose, world) = (frame.stamp, frame.pose.mean(), topics::WORLD_FRAME);
        self.path.push(*pose);
        self.writer.pose_in_frame(topics::ESTIMATED_POSE, stamp, world, pose)?;
        self.writer.frame_transform("/tf", stamp, world, topics::BODY_FRAME, pose)?;
        self.writer.scene_update("/estimate/robot", stamp, world, &robot(frame))?;
        if let Some(localizer) = system.localizer() {
            let points: Vec<[f64; 2]> = localizer.poses().map(|(pose, _)| [pose.x(), pose.y()]).collect();
            self.writer.point_cloud("/estimate/particles", stamp, world, &points)?;
        }
        if self.path.len() % PATH_PERIOD == 1 {
            self.writer.poses_in_frame("/estimate/path", stamp, world, &self.path)?;
        }
        Ok(())
    }
}

fn robot(frame: &FrameResult) -> Vec<Drawing> {
    let pose = frame.pose.mean();
    let rotation = pose.rotation_matrix();
    let covariance: Matrix2<f64> =
        rotation * frame.pose.covariance().fixed_view::<2, 2>(0, 0) * rotation.transpose();
    let Ok(ellipse) = CovarianceEllipse::at_sigmas(&covariance, SIGMAS) else { return Vec::new() };
    let shape = Shape::Ellipse {
        center: [pose.x(), pose.y()],
        semi_axes: [ellipse.semi_major, ellipse.semi_minor],
        angle: ellipse.angle,
    };
    vec![Drawing { id: "robot".to_owned(), color: ROBOT_COLOR, shape }]
}
