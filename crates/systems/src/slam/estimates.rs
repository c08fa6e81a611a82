use std::marker::PhantomData;

use nalgebra::{DefaultAllocator, Matrix2};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::CovarianceEllipse;
use wayfix_sensor_log::{Drawing, LogError, Record, Shape, topics};
use wayfix_slam_ekf::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};

use super::{FrontEnd, SlamSystem, StampedEstimate};
use crate::system::{self, EstimateLog, EstimateWriter, write_pose};

/// Path and map beside the records, for viewers.
pub type SlamEstimateLog<F> = EstimateLog<SlamDrawing<F>>;

/// What [`SlamEstimateLog`] has drawn so far.
pub struct SlamDrawing<F> {
    n_written: usize,
    path: Vec<Pose2<f64>>,
    front_end: PhantomData<fn() -> F>,
}

impl<F> Default for SlamDrawing<F> {
    fn default() -> Self {
        Self { n_written: 0, path: Vec::new(), front_end: PhantomData }
    }
}

/// The map and the whole path are written with every so many estimates: they change slowly and are long.
const MAP_PERIOD: usize = 20;
/// Ellipses are drawn at two standard deviations.
const SIGMAS: f64 = 2.0;
const ROBOT_COLOR: [f64; 4] = [0.12, 0.47, 0.71, 1.0];

impl<F: FrontEnd> system::Drawing for SlamDrawing<F>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    type System = SlamSystem<F>;

    fn draw(
        &mut self,
        _: &Record,
        system: &SlamSystem<F>,
        writer: &mut EstimateWriter,
    ) -> Result<(), LogError> {
        for estimate in &system.stamped_estimates()[self.n_written..] {
            self.path.push(estimate.pose);
            draw_stamped_estimate(estimate, writer)?;
            if self.path.len() % MAP_PERIOD == 1 {
                let (stamp, world) = (estimate.stamp, topics::WORLD_FRAME);
                writer.poses_in_frame("/estimate/path", stamp, world, &self.path)?;
                F::draw_map(system.filter(), stamp, writer)?;
            }
        }
        self.n_written = system.stamped_estimates().len();
        Ok(())
    }
}

/// The robot and how sure it is of its place.
fn draw_stamped_estimate(
    stamped_estimate: &StampedEstimate,
    writer: &mut EstimateWriter,
) -> Result<(), LogError> {
    let StampedEstimate { stamp, pose, .. } = stamped_estimate;
    write_pose(writer, *stamp, pose)?;
    writer.scene_update("/estimate/robot", *stamp, topics::WORLD_FRAME, &robot(stamped_estimate))
}

fn robot(stamped_estimate: &StampedEstimate) -> Vec<Drawing> {
    let rotation = stamped_estimate.pose.rotation_matrix();
    let covariance = rotation * stamped_estimate.covariance.fixed_view::<2, 2>(0, 0) * rotation.transpose();
    let center = [stamped_estimate.pose.x(), stamped_estimate.pose.y()];
    ellipse("robot".to_owned(), ROBOT_COLOR, center, covariance).into_iter().collect()
}

/// Nothing while the covariance is singular (a start pose known exactly).
pub(crate) fn ellipse(
    id: String,
    color: [f64; 4],
    center: [f64; 2],
    covariance: Matrix2<f64>,
) -> Option<Drawing> {
    let ellipse = CovarianceEllipse::at_sigmas(&covariance, SIGMAS).ok()?;
    let semi_axes = [ellipse.semi_major, ellipse.semi_minor];
    Some(Drawing { id, color, shape: Shape::Ellipse { center, semi_axes, angle: ellipse.angle } })
}
