use std::collections::BTreeSet;

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{PoseMeasurement, Record, RecordData, Stamp};
use wayfix_slam_ekf::{
    AnchorError, AnchorParams, EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MapMeasurement,
    MeasurementDim, RobotDim, SlamAlloc, SlamError, SlamSnapshot, observability::ObservabilityRecorder,
};
use wayfix_system_core::{EventCounts, HeadingSignTest, System, map_measurement};

use super::{
    AssociationRule, ExternalState, FrontEnd, SavedMapError, SlamEstimator, SlamState, StampedEstimate,
    carried,
};

/// EKF-SLAM that takes records; `F` is the front end of a kind of landmark.
pub struct SlamSystem<F: FrontEnd>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    pub(crate) front_end: F,
    pub(crate) estimator: SlamEstimator<F::Model>,
    /// Stamp of the last record that was taken.
    taken_until: Stamp,
    /// The previous run, which this one continues, used the records up to this stamp.
    resumed_at: Option<Stamp>,
    last_increment: Option<Stamp>,
    /// Measurements of the pose that wait for the increment that leads beyond them.
    waiting: Vec<(Stamp, MapMeasurement)>,
    heading_sign: HeadingSignTest,
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
    /// A system before its first record.
    pub fn new(front_end: F, estimator: SlamEstimator<F::Model>) -> Self {
        Self {
            front_end,
            estimator,
            taken_until: Stamp::default(),
            resumed_at: None,
            last_increment: None,
            waiting: Vec::new(),
            heading_sign: HeadingSignTest::default(),
        }
    }

    /// The system with a saved map; the front end has its saved state already.
    pub(crate) fn resumed(
        self,
        filter: SlamSnapshot<<F::Model as LandmarkModel>::Robot, <F::Model as LandmarkModel>::Landmark>,
        next_id: Option<u32>,
        taken_until: u64,
        external: ExternalState,
    ) -> Result<Self, SavedMapError> {
        let ExternalState { last_increment, waiting, mirrored_compass_log_odds } = external;
        let not_finite = |_| SlamError::NotFinite { what: "saved odds of a mirrored compass" };
        let heading_sign = HeadingSignTest::from_log_odds(mirrored_compass_log_odds).map_err(not_finite)?;
        let stamp = Stamp::from_nanoseconds;
        let Self { front_end, mut estimator, .. } = self;
        let (model, params) = (estimator.filter.model().clone(), *estimator.filter.params());
        estimator.filter = EkfSlam::resume(model, params, filter)?;
        estimator.association = estimator.association.numbering_from(next_id);
        Ok(Self {
            taken_until: stamp(taken_until),
            resumed_at: Some(stamp(taken_until)),
            last_increment: last_increment.map(stamp),
            waiting: waiting.into_iter().map(|(since, measured)| (stamp(since), measured)).collect(),
            heading_sign,
            ..Self::new(front_end, estimator)
        })
    }

    /// Adds a landmark whose place is known.
    pub(crate) fn add_anchor(
        &mut self,
        id: LandmarkId,
        landmark: <F::Model as LandmarkModel>::Landmark,
    ) -> Result<(), SlamError> {
        self.estimator.filter.add_anchor(id, landmark)
    }

    /// Adds the landmarks that the user knows; `seen` are the identities that the sensor reads, if it does.
    pub(crate) fn add_given_anchors<P: Copy>(
        &mut self,
        anchors: &[AnchorParams<P>],
        seen: Option<&BTreeSet<u32>>,
        landmark: impl Fn(P) -> <F::Model as LandmarkModel>::Landmark,
    ) -> Result<(), AnchorError> {
        self.estimator.filter.add_anchors(anchors, seen, landmark)?;
        self.estimator.unseen_anchors = anchors.iter().map(|anchor| LandmarkId(anchor.id)).collect();
        Ok(())
    }

    /// Takes a measurement of the pose now, or after the increment that leads beyond it.
    fn take_or_wait(&mut self, stamp: Stamp, measured: &PoseMeasurement) -> Result<(), String> {
        let (params, antenna) = self.front_end.external();
        if !params.is_on() {
            self.estimator.events.count("measurement_ignored");
            return Ok(());
        }
        let measurement = map_measurement(measured, params, antenna).map_err(|error| error.to_string())?;
        if self.last_increment.is_some_and(|last| last < stamp) {
            self.waiting.push((stamp, measurement));
            return Ok(());
        }
        self.measure(stamp, &measurement, &Pose2::identity())
    }

    /// Takes the waiting measurements at the end of an increment, less the part of it that comes after them.
    fn take_waiting(&mut self, end: Stamp, increment: &Pose2<f64>) {
        let begin = self.last_increment.replace(end).unwrap_or(end);
        for (stamp, measurement) in std::mem::take(&mut self.waiting) {
            let share = end.seconds_since(stamp) / end.seconds_since(begin).max(f64::MIN_POSITIVE);
            let back = Pose2::exp(&(increment.log() * -share.clamp(0.0, 1.0)));
            if let Err(reason) = self.measure(end, &measurement, &back) {
                self.estimator.events.refuse("record_refused", format!("measured pose of {stamp}: {reason}"));
            }
        }
    }

    /// Corrects by a measurement that was made after the motion `rest` from the pose at `stamp`.
    fn measure(
        &mut self,
        stamp: Stamp,
        measurement: &MapMeasurement,
        rest: &Pose2<f64>,
    ) -> Result<(), String> {
        let Some((motion, covariance)) = self.front_end.motion_to(stamp, &mut self.estimator)? else {
            self.estimator.events.count("record_before_start");
            return Ok(());
        };
        let (motion, covariance) = (motion.compose(rest), carried(&covariance, rest));
        let before = self.estimator.filter.robot().clone();
        self.estimator.update_moved(measurement, motion, covariance, &mut self.heading_sign)?;
        self.front_end.corrected(&before, self.estimator.filter.robot());
        Ok(())
    }

    /// All that is needed to continue from here.
    pub fn save(&self) -> StateOf<F> {
        let taken_until = self.front_end.settled_until(self.taken_until);
        // Later ones are read again.
        let waiting = self.waiting.iter().filter(|(stamp, _)| *stamp <= taken_until);
        let SlamEstimator { filter, follower, .. } = &self.estimator;
        SlamState {
            filter: filter.snapshot(),
            smoothed: follower.as_ref().and_then(|follower| follower.save(filter)),
            association: self.association(),
            next_id: self.estimator.association.next_id(),
            taken_until: taken_until.nanoseconds(),
            dead_reckoning: self.estimator.dead_reckoning,
            external: ExternalState {
                last_increment: self.last_increment.map(Stamp::nanoseconds),
                waiting: waiting.map(|(stamp, measured)| (stamp.nanoseconds(), *measured)).collect(),
                mirrored_compass_log_odds: self.heading_sign.log_odds(),
            },
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
    /// One estimate for every scan of the sensor, evenly spaced: all of a short log, at most [`MOST_ESTIMATES`](wayfix_system_core::MOST_ESTIMATES) of a long one.
    pub fn stamped_estimates(&self) -> &[StampedEstimate] {
        self.estimator.stamped_estimates.kept()
    }
    /// Number of estimates so far.
    pub fn n_estimates(&self) -> usize {
        self.estimator.stamped_estimates.n_seen()
    }
    /// The last `n` estimates, if so many came with the last record.
    pub(super) fn newest_estimates(&self, n: usize) -> &[StampedEstimate] {
        let newest = &self.estimator.newest_estimates;
        &newest[newest.len().saturating_sub(n)..]
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
        self.estimator.newest_estimates.clear();
        match &record.data {
            RecordData::PoseMeasurement(measured) => self.take_or_wait(record.stamp, measured),
            RecordData::OdometryIncrement(increment) => {
                let taken = self.front_end.take(record, &mut self.estimator);
                self.take_waiting(record.stamp, increment);
                taken
            }
            _ => self.front_end.take(record, &mut self.estimator),
        }
    }
    fn finish(&mut self) -> Result<(), String> {
        self.take_waiting(self.taken_until, &Pose2::identity());
        self.heading_sign.warn_if_mirrored(&mut self.estimator.events);
        self.front_end.finish(&mut self.estimator)
    }
    fn events(&mut self) -> &mut EventCounts {
        &mut self.estimator.events
    }
}
