use std::marker::PhantomData;

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{LogError, Record, topics};
use wayfix_slam_ekf::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};

use super::{FrontEnd, SlamSystem};
use crate::system::{self, EstimateRecorder, EstimateWriter, write_robot};

/// Path and map beside the records, for viewers.
pub type SlamEstimateRecorder<F> = EstimateRecorder<SlamDrawingState<F>>;

/// What [`SlamEstimateRecorder`] has drawn so far.
pub struct SlamDrawingState<F> {
    n_written: usize,
    path: Vec<Pose2<f64>>,
    front_end: PhantomData<fn() -> F>,
}

impl<F> Default for SlamDrawingState<F> {
    fn default() -> Self {
        Self { n_written: 0, path: Vec::new(), front_end: PhantomData }
    }
}

/// The map and the whole path are written with every so many estimates: they change slowly and are long.
const MAP_PERIOD: usize = 20;

impl<F: FrontEnd> system::EstimateDrawer for SlamDrawingState<F>
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
            write_robot(writer, estimate.stamp, &estimate.pose, &estimate.covariance)?;
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
