use std::marker::PhantomData;

use nalgebra::DefaultAllocator;
use wayfix_sensor_log::{LogError, Record};
use wayfix_slam_ekf::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};
use wayfix_system_core::{EstimateDrawer, EstimateRecorder, EstimateWriter, PathSegmentWriter, write_robot};

use super::{FrontEnd, SlamSystem};

/// Path and map beside the records, for viewers.
pub type SlamEstimateRecorder<F> = EstimateRecorder<SlamDrawingState<F>>;

/// What [`SlamEstimateRecorder`] has drawn so far.
pub struct SlamDrawingState<F> {
    n_written: usize,
    path: PathSegmentWriter,
    /// Number of estimates at which the map is written next.
    next_map: usize,
    front_end: PhantomData<fn() -> F>,
}

impl<F> Default for SlamDrawingState<F> {
    fn default() -> Self {
        Self { n_written: 0, path: PathSegmentWriter::default(), next_map: 1, front_end: PhantomData }
    }
}

/// The map is written with every so many estimates, or two for each of its landmarks: it changes slowly and is long.
const MAP_PERIOD: usize = 20;
/// In a long log the period is this part of the estimates so far, so that the maps do not outgrow the log.
const MAP_PERIOD_SHARE: usize = 100;

impl<F: FrontEnd> EstimateDrawer for SlamDrawingState<F>
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
        for estimate in system.newest_estimates(system.n_estimates() - self.n_written) {
            self.n_written += 1;
            self.path.push(estimate.stamp, &estimate.pose, writer)?;
            write_robot(writer, estimate.stamp, &estimate.pose, &estimate.covariance)?;
            if self.n_written >= self.next_map {
                let n_landmarks = system.filter().n_landmarks();
                self.next_map =
                    self.n_written + MAP_PERIOD.max(2 * n_landmarks).max(self.n_written / MAP_PERIOD_SHARE);
                F::draw_map(system.filter(), estimate.stamp, writer)?;
            }
        }
        Ok(())
    }
}
