use std::{fs::File, io::BufWriter, path::Path};

use nalgebra::Matrix2;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::CovarianceEllipse;
use wayfix_sensor_log::{Drawing, Format, LogError, McapWriter, Record, Shape, topics};

use super::{Keyframe, SlamSystem};

/// Writes the estimates beside the records of the log into an MCAP file, so that Foxglove and Rerun show the map as it is built.
pub struct EstimateLog {
    writer: McapWriter<BufWriter<File>>,
    n_written: usize,
    path: Vec<Pose2<f64>>,
    failure: Option<LogError>,
}

/// The map and the whole path are written with every so many keyframes: they change slowly and are long.
const MAP_PERIOD: usize = 20;
/// Ellipses are drawn at two standard deviations.
const SIGMAS: f64 = 2.0;
const ROBOT_COLOR: [f64; 4] = [0.12, 0.47, 0.71, 1.0];
const LANDMARK_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

impl EstimateLog {
    /// Creates the file.
    ///
    /// # Errors
    /// When it cannot be created.
    pub fn create(path: &Path) -> Result<Self, LogError> {
        Ok(Self { writer: McapWriter::create(path)?, n_written: 0, path: Vec::new(), failure: None })
    }

    /// Says which format the records of the log come from; before the first of them.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn origin(&mut self, origin: Format) -> Result<(), LogError> {
        self.writer.origin(origin)
    }

    /// Writes a record of the log and what the system made of it. A failure is kept until [`finish`](Self::finish).
    pub fn observe(&mut self, record: &Record, system: &SlamSystem) {
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

    fn write(&mut self, record: &Record, system: &SlamSystem) -> Result<(), LogError> {
        match self.writer.record(record) {
            Err(LogError::NotFinite { .. }) => {} // refused by the system and counted there
            written => written?,
        }
        for keyframe in &system.keyframes()[self.n_written..] {
            self.path.push(keyframe.pose);
            self.writer.pose_in_frame(
                topics::ESTIMATED_POSE,
                keyframe.stamp,
                topics::WORLD_FRAME,
                &keyframe.pose,
            )?;
            self.writer.frame_transform(
                "/tf",
                keyframe.stamp,
                topics::WORLD_FRAME,
                topics::BODY_FRAME,
                &keyframe.pose,
            )?;
            self.writer.scene_update(
                "/estimate/robot",
                keyframe.stamp,
                topics::WORLD_FRAME,
                &robot(keyframe),
            )?;
            if self.path.len() % MAP_PERIOD == 1 {
                let (points, drawings) = map(system);
                self.writer.poses_in_frame(
                    "/estimate/path",
                    keyframe.stamp,
                    topics::WORLD_FRAME,
                    &self.path,
                )?;
                self.writer.point_cloud(
                    "/estimate/landmarks",
                    keyframe.stamp,
                    topics::WORLD_FRAME,
                    &points,
                )?;
                self.writer.scene_update("/estimate/map", keyframe.stamp, topics::WORLD_FRAME, &drawings)?;
            }
        }
        self.n_written = system.keyframes().len();
        Ok(())
    }
}

fn robot(keyframe: &Keyframe) -> Vec<Drawing> {
    let rotation = keyframe.pose.rotation_matrix();
    let covariance = rotation * keyframe.covariance.fixed_view::<2, 2>(0, 0) * rotation.transpose();
    let center = [keyframe.pose.x(), keyframe.pose.y()];
    ellipse("robot".to_owned(), ROBOT_COLOR, center, covariance).into_iter().collect()
}

fn map(system: &SlamSystem) -> (Vec<[f64; 2]>, Vec<Drawing>) {
    let (mut points, mut drawings) = (Vec::new(), Vec::new());
    for landmark in system.filter().landmarks() {
        let position = [landmark.mean.x, landmark.mean.y];
        points.push(position);
        let shape = Shape::Marker { position, radius: 0.05, text: landmark.id.to_string() };
        drawings.push(Drawing { id: format!("landmark {}", landmark.id), color: LANDMARK_COLOR, shape });
        let id = format!("ellipse {}", landmark.id);
        drawings.extend(ellipse(id, LANDMARK_COLOR, position, landmark.covariance));
    }
    (points, drawings)
}

/// Nothing while the covariance is singular (a start pose known exactly).
fn ellipse(id: String, color: [f64; 4], center: [f64; 2], covariance: Matrix2<f64>) -> Option<Drawing> {
    let ellipse = CovarianceEllipse::at_sigmas(&covariance, SIGMAS).ok()?;
    let semi_axes = [ellipse.semi_major, ellipse.semi_minor];
    Some(Drawing { id, color, shape: Shape::Ellipse { center, semi_axes, angle: ellipse.angle } })
}
