use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Record, RecordData, Stamp};
use wayfix_slam_ekf::{
    EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc, SlamError,
    SlamSnapshot, observability::ObservabilityRecorder,
};

use super::{
    AssociationRule, FrontEnd, SavedMapError, SlamEstimator, SlamState, StampedEstimate,
    external::MapMeasurement,
};
use crate::system::{EventCounts, System};

/// EKF-SLAM that takes records; `F` is the front end of a kind of landmark.
pub struct SlamSystem<F: FrontEnd>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    pub(crate) front_end: F,
    pub(crate) estimator: SlamEstimator<F::Model>,
    /// Stamp of the last record that was taken.
    taken_until: Stamp,
    /// Records up to this stamp were taken by the run that this one goes on from.
    resumed_at: Option<Stamp>,
}

/// The identity of the first anchor of a map without identities; association gives smaller ones.
pub(crate) const FIRST_ANCHOR: u32 = 1 << 31;

/// The [`SlamState`] of a front end.
pub type StateOf<F> = SlamState<
    <<F as FrontEnd>::Model as LandmarkModel>::Robot,
    <<F as FrontEnd>::Model as LandmarkModel>::Landmark,
    <F as FrontEnd>::State,
>;

impl<F: FrontEnd> SlamSystem<F>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    pub(crate) fn new(front_end: F, estimator: SlamEstimator<F::Model>) -> Self {
        Self { front_end, estimator, taken_until: Stamp::default(), resumed_at: None }
    }

    /// The system with a saved map; the front end has its saved state already.
    pub(crate) fn resumed(
        self,
        filter: SlamSnapshot<<F::Model as LandmarkModel>::Robot, <F::Model as LandmarkModel>::Landmark>,
        next_id: Option<u32>,
        taken_until: u64,
    ) -> Result<Self, SavedMapError> {
        let Self { front_end, mut estimator, .. } = self;
        let (model, params) = (estimator.filter.model().clone(), *estimator.filter.params());
        estimator.filter = EkfSlam::resume(model, params, filter)?;
        estimator.association = estimator.association.numbering_from(next_id);
        let taken_until = Stamp::from_nanoseconds(taken_until);
        Ok(Self { front_end, estimator, taken_until, resumed_at: Some(taken_until) })
    }

    /// Adds a landmark whose place is known.
    pub(crate) fn add_anchor(
        &mut self,
        id: LandmarkId,
        landmark: <F::Model as LandmarkModel>::Landmark,
    ) -> Result<(), SlamError> {
        self.estimator.filter.add_anchor(id, landmark)
    }

    /// All that is needed to go on from here.
    pub fn save(&self) -> StateOf<F> {
        SlamState {
            filter: self.estimator.filter.snapshot(),
            association: self.association(),
            next_id: self.estimator.association.next_id(),
            taken_until: self.front_end.settled_until(self.taken_until).nanoseconds(),
            dead_reckoning: self.estimator.dead_reckoning,
            front_end: self.front_end.state(),
        }
    }

    /// The filter: robot, map, covariance.
    pub fn filter(&self) -> &EkfSlam<F::Model> {
        &self.estimator.filter
    }
    /// How observations find their landmarks.
    pub fn association(&self) -> AssociationRule {
        AssociationRule::of(&self.estimator.association)
    }
    /// Where odometry alone would put the robot.
    pub fn dead_reckoning(&self) -> &Pose2<f64> {
        &self.estimator.dead_reckoning
    }
    /// One estimate for every scan of the sensor.
    pub fn stamped_estimates(&self) -> &[StampedEstimate] {
        &self.estimator.stamped_estimates
    }
    /// What the run observed, where that was to be recorded.
    pub fn observability(&self) -> Option<&ObservabilityRecorder> {
        self.estimator.observability.as_ref()
    }
}

impl<F: FrontEnd> System for SlamSystem<F>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    fn take(&mut self, record: &Record) -> Result<(), String> {
        if self.resumed_at.is_some_and(|resumed_at| record.stamp <= resumed_at) {
            self.estimator.events.count("record_before_resume");
            return Ok(());
        }
        self.taken_until = record.stamp;
        let RecordData::PoseMeasurement(measured) = &record.data else {
            return self.front_end.take(record, &mut self.estimator);
        };
        let (params, antenna) = self.front_end.external();
        if !params.is_on() {
            self.estimator.events.count("measurement_ignored");
            return Ok(());
        }
        let measurement =
            MapMeasurement::new(measured, params, antenna).map_err(|error| error.to_string())?;
        let Some(motion) = self.front_end.motion_to(record.stamp, &mut self.estimator)? else {
            self.estimator.events.count("record_before_start");
            return Ok(());
        };
        let taken = self.estimator.take_measurement(&measurement, motion);
        taken.map_err(|error| error.to_string())
    }
    fn finish(&mut self) -> Result<(), String> {
        self.front_end.finish(&mut self.estimator)
    }
    fn events(&mut self) -> &mut EventCounts {
        &mut self.estimator.events
    }
}
