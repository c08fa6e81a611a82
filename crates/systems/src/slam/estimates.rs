use nalgebra::Matrix2;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::CovarianceEllipse;
use wayfix_sensor_log::{Drawing, LogError, Record, Shape, topics};

use super::{SlamSystem, StampedEstimate};
use crate::system::{self, EstimateLog, EstimateWriter};

/// The map as it is built beside the records, for viewers.
pub type SlamEstimateLog = EstimateLog<SlamDrawing>;

/// What [`SlamEstimateLog`] has drawn so far.
#[derive(Default)]
pub struct SlamDrawing {
    n_written: usize,
    path: Vec<Pose2<f64>>,
}

/// The map and the whole path are written with every so many estimates: they change slowly and are long.
const MAP_PERIOD: usize = 20;
/// Ellipses are drawn at two standard deviations.
const SIGMAS: f64 = 2.0;
const ROBOT_COLOR: [f64; 4] = [0.12, 0.47, 0.71, 1.0];
const LANDMARK_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

impl system::Drawing for SlamDrawing {
    type System = SlamSystem;

    fn draw(&mut self, _: &Record, system: &SlamSystem, writer: &mut EstimateWriter) -> Result<(), LogError> {
        for stamped_estimate in &system.stamped_estimates()[self.n_written..] {
            self.path.push(stamped_estimate.pose);
            draw_stamped_estimate(stamped_estimate, writer)?;
            if self.path.len() % MAP_PERIOD == 1 {
                let (points, drawings) = map(system);
                writer.poses_in_frame(
                    "/estimate/path",
                    stamped_estimate.stamp,
                    topics::WORLD_FRAME,
                    &self.path,
                )?;
                writer.point_cloud(
                    "/estimate/landmarks",
                    stamped_estimate.stamp,
                    topics::WORLD_FRAME,
                    &points,
                )?;
                writer.scene_update(
                    "/estimate/map",
                    stamped_estimate.stamp,
                    topics::WORLD_FRAME,
                    &drawings,
                )?;
            }
        }
        self.n_written = system.stamped_estimates().len();
        Ok(())
    }
}

/// The robot and how sure it is of its place.
pub(crate) fn draw_stamped_estimate(
    stamped_estimate: &StampedEstimate,
    writer: &mut EstimateWriter,
) -> Result<(), LogError> {
    let (stamp, pose, world) = (stamped_estimate.stamp, &stamped_estimate.pose, topics::WORLD_FRAME);
    writer.pose_in_frame(topics::ESTIMATED_POSE, stamp, world, pose)?;
    writer.frame_transform("/tf", stamp, world, topics::BODY_FRAME, pose)?;
    writer.scene_update("/estimate/robot", stamp, world, &robot(stamped_estimate))
}

fn robot(stamped_estimate: &StampedEstimate) -> Vec<Drawing> {
    let rotation = stamped_estimate.pose.rotation_matrix();
    let covariance = rotation * stamped_estimate.covariance.fixed_view::<2, 2>(0, 0) * rotation.transpose();
    let center = [stamped_estimate.pose.x(), stamped_estimate.pose.y()];
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
