use std::time::Duration;

use nalgebra::{Matrix3, Vector3};
use wayfix_appearance_cml::{
    AppearanceIndex, AppearanceLocalizer, AppearanceMap, LocalizerEvent, PanoramaDescriptor, ReferenceSearch,
    StartPosePrior, ViewDescriptor,
};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_evaluation::plot::Decimated;
use wayfix_gaussian_core::Gaussian;
use wayfix_sensor_log::{EncodedImage, MeasuredQuantity, PoseMeasurement, Record, RecordData, Stamp, topics};
use wayfix_system_core::{
    EventCounts, LoggedMotion, LoggedOdometry, MOST_ESTIMATES, ODOMETRY_SCALE_TOLERANCE, RepeatedImageCheck,
    Stopwatch, System, TurnHistory,
};

use super::{CmlParams, PoseSigmas, ViewDescriptorReader, external::ExternalSensors};

/// The localizer of panoramas with an index, which avoids comparing with every reference.
pub type PanoramaLocalizer = AppearanceLocalizer<PanoramaDescriptor, AppearanceIndex<PanoramaDescriptor>>;
/// Its map.
pub type PanoramaMap = AppearanceMap<PanoramaDescriptor, AppearanceIndex<PanoramaDescriptor>>;

/// The localizer, fed with the records of a log.
pub struct CmlSystem {
    reader: ViewDescriptorReader,
    pub(super) localizer: PanoramaLocalizer,
    odometry: LoggedOdometry,
    dead_reckoning: Option<Pose2<f64>>,
    /// Dead-reckoned motion since the first record.
    moved: Pose2<f64>,
    last_view: Option<PanoramaDescriptor>,
    repeated: RepeatedImageCheck,
    /// Turns between the views, by odometry and by the views alone.
    turns: TurnHistory,
    frames: Decimated<CmlViewResult>,
    latest: Option<CmlViewResult>,
    longest_step: Duration,
    pub(super) external: ExternalSensors,
    pub(super) events: EventCounts,
}

/// Result of one view.
#[derive(Clone, Debug)]
pub struct CmlViewResult {
    /// Capture time.
    pub stamp: Stamp,
    /// The most probable pose, with covariance in its body frame; `None` while the pose is unknown.
    pub pose: Option<Gaussian<Pose2<f64>>>,
    /// Whether it is the only hypothesis.
    pub is_certain: bool,
    /// Dead-reckoned pose; `None` without a known start.
    pub odometry: Option<Pose2<f64>>,
    /// The most similar reference before learning from this view: its distance, and the position where it was learned.
    pub nearest: Option<(f64, [f64; 2])>,
    /// Number of places that match the view.
    pub n_detections: usize,
    /// The pose at which the view matches the map best, before fusion.
    pub best_match: Option<Gaussian<Pose2<f64>>>,
    /// Number of references in the map after the view.
    pub n_references: usize,
    /// Computing time after decoding.
    pub step: Duration,
}

impl CmlViewResult {
    /// The best match as a measured pose for the run of another camera. [Gross et al. 2005, Fig. 2, other estimators]
    ///
    /// The covariance turns from the body frame into the axes of the map.
    pub fn pose_measurement(&self) -> Option<PoseMeasurement> {
        let matched = self.best_match.as_ref()?;
        let mut rotation = Matrix3::identity();
        rotation.fixed_view_mut::<2, 2>(0, 0).copy_from(&matched.mean().rotation_matrix());
        Some(PoseMeasurement {
            frame: topics::WORLD_FRAME.to_owned(),
            quantity: MeasuredQuantity::Pose(*matched.mean()),
            covariance: Some(rotation * matched.covariance() * rotation.transpose()),
        })
    }
}

impl CmlSystem {
    /// A system with a map, which may be empty.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range.
    pub fn new(params: &CmlParams, reader: ViewDescriptorReader, map: PanoramaMap) -> anyhow::Result<Self> {
        params.external.check()?;
        Ok(Self {
            reader,
            localizer: PanoramaLocalizer::with_map(params.localizer, map, StartPosePrior::Anywhere)?,
            odometry: LoggedOdometry::new(params.velocity_timeout),
            dead_reckoning: None,
            moved: Pose2::identity(),
            last_view: None,
            repeated: RepeatedImageCheck::default(),
            turns: TurnHistory::default(),
            frames: Decimated::new(MOST_ESTIMATES),
            latest: None,
            longest_step: Duration::ZERO,
            external: ExternalSensors::new(params.external.clone()),
            events: EventCounts::default(),
        })
    }

    /// Results of the views so far, evenly spaced: all of a short log, at most [`MOST_ESTIMATES`] of a long one.
    pub fn frames(&self) -> &[CmlViewResult] {
        self.frames.kept()
    }

    pub(super) fn sample(&self) -> &Decimated<CmlViewResult> {
        &self.frames
    }

    /// Result of the last view.
    pub fn latest(&self) -> Option<&CmlViewResult> {
        self.latest.as_ref()
    }

    /// Longest computing time of a view.
    pub(super) fn longest_step(&self) -> Duration {
        self.longest_step
    }

    /// The localizer.
    pub fn localizer(&self) -> &PanoramaLocalizer {
        &self.localizer
    }

    /// The reader of the views; it holds the panorama size.
    pub fn reader(&self) -> &ViewDescriptorReader {
        &self.reader
    }

    /// Warns if the turns of the views show that odometry lags; `delay` is the delay already corrected, s.
    pub(super) fn warn_of_lag(&mut self, delay: f64) {
        self.turns.warn_of_lag(&mut self.events, delay);
    }

    /// Warns if the turns of the views contradict those of odometry, or of the table of poses, beyond its calibration.
    pub(super) fn warn_of_turn_scale(&mut self) {
        let Some([low, high]) = self.turns.turn_scale() else { return };
        let text = match (1.0 - ODOMETRY_SCALE_TOLERANCE, 1.0 + ODOMETRY_SCALE_TOLERANCE) {
            _ if high < 0.0 => "views turn the other way than odometry or the table of poses: check the sign of its turns and the order of columns (`--column-order`)".to_owned(),
            (least, most) if high < least || low > most => format!(
                "views turn {low:.2} to {high:.2} times as far as odometry or the table of poses says: check the unit and the scale of its turns, and whether a panorama spans 360°"
            ),
            _ => return,
        };
        self.events.warn("views_contradict_odometry", text);
    }

    /// Adds a reference view with a known pose; counts and skips an unusable view.
    ///
    /// # Errors
    /// Returns an error if the pose or a sigma is invalid, or if no reference number is left.
    pub fn teach(
        &mut self,
        image: &EncodedImage,
        pose: &Pose2<f64>,
        sigmas: &PoseSigmas,
    ) -> anyhow::Result<()> {
        match self.reader.describe(image) {
            Ok(view) => {
                self.localizer.teach(view, &gaussian(pose, sigmas)?)?;
                self.events.count("view_taught");
            }
            Err(error) => self.events.refuse("view_refused", format!("{error:#}")),
        }
        Ok(())
    }

    /// Restarts the localizer at `start`.
    ///
    /// # Errors
    /// Returns an error if the start pose is invalid.
    pub fn start(&mut self, start: StartPosePrior) -> anyhow::Result<()> {
        self.dead_reckoning = match &start {
            StartPosePrior::Known(pose) => Some(*pose.mean()),
            _ => None,
        };
        Ok(self.localizer.restart(start)?)
    }

    pub(super) fn move_by(&mut self, increment: &Pose2<f64>) -> Result<(), String> {
        self.localizer.predict(increment).map_err(|error| error.to_string())?;
        self.dead_reckoning = self.dead_reckoning.map(|pose| pose.compose(increment));
        self.moved = self.moved.compose(increment);
        self.repeated.move_by(increment);
        Ok(())
    }

    /// Predicts the pose to `stamp` with the held velocity.
    pub(super) fn advance_to(&mut self, stamp: Stamp) -> Result<(), String> {
        let held = self.odometry.advance_to(stamp, &mut self.events);
        held.map_or(Ok(()), |motion| self.move_as_logged(&motion))
    }

    fn move_as_logged(&mut self, motion: &LoggedMotion) -> Result<(), String> {
        self.move_by(&motion.increment)?;
        if motion.unknown_seconds == 0.0 {
            return Ok(());
        }
        self.localizer.predict_unknown(&motion.unknown_covariance).map_err(|error| error.to_string())
    }

    fn see(&mut self, stamp: Stamp, image: &EncodedImage) -> Result<(), String> {
        let panorama_took = Stopwatch::start();
        let view = self.reader.describe(image).map_err(|error| format!("{error:#}"))?;
        let (n_columns, _) = self.reader.size().ok_or("a view without a size")?;
        self.repeated.check(image, n_columns as f64 / std::f64::consts::TAU)?;
        let describing = panorama_took.elapsed();
        let seen_turn = self.last_view.replace(view.clone()).map(|last| view.compare(&last).rotation);
        self.turns.push(stamp, self.moved, seen_turn);
        let nearest = self.nearest(&view);
        let stopwatch = Stopwatch::start();
        let outcome = self.localizer.update(view).map_err(|error| error.to_string())?;
        let step = describing + stopwatch.elapsed();
        outcome.events.iter().for_each(|event| self.count(event));
        self.longest_step = self.longest_step.max(step);
        let result = CmlViewResult {
            stamp,
            pose: self.localizer.estimate().cloned(),
            is_certain: outcome.estimate.is_some(),
            odometry: self.dead_reckoning,
            nearest,
            n_detections: outcome.n_detections,
            best_match: outcome.best_match,
            n_references: self.localizer.map().len(),
            step,
        };
        self.frames.push(result.clone());
        self.latest = Some(result);
        Ok(())
    }

    pub(super) fn count(&mut self, event: &LocalizerEvent) {
        self.events.count(match event {
            LocalizerEvent::NewReference(_) => "new_reference",
            LocalizerEvent::Forgotten(_) => "reference_forgotten",
            LocalizerEvent::Lost => "pose_lost",
            LocalizerEvent::Found => "pose_found",
            LocalizerEvent::Relocated => "pose_relocated",
            _ => "other",
        });
    }

    fn nearest(&self, view: &PanoramaDescriptor) -> Option<(f64, [f64; 2])> {
        let map = self.localizer.map();
        let nearest = *map.search().nearest(view, 1).first()?;
        let places = &map.reference(nearest.id)?.places;
        let heaviest = places.iter().max_by(|a, b| a.weight.total_cmp(&b.weight))?;
        let mean = heaviest.gaussian.mean();
        Some((nearest.comparison.distance, [mean.x(), mean.y()]))
    }
}

/// A Gaussian with this mean and these standard deviations.
pub(super) fn gaussian(pose: &Pose2<f64>, sigmas: &PoseSigmas) -> anyhow::Result<Gaussian<Pose2<f64>>> {
    Ok(Gaussian::from_sigmas(
        *pose,
        &Vector3::new(sigmas.position_sigma, sigmas.position_sigma, sigmas.heading_sigma),
    )?)
}

impl System for CmlSystem {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        if let Some(motion) = self.odometry.take(record, &mut self.events)? {
            return match &record.data {
                RecordData::OdometryIncrement(increment) => self.move_through(record.stamp, increment),
                _ => self.move_as_logged(&motion),
            };
        }
        match &record.data {
            RecordData::Image(image) => {
                self.advance_to(record.stamp)?;
                self.see(record.stamp, image)
            }
            RecordData::PoseMeasurement(measured) => self.take_measurement(record.stamp, measured),
            _ => Ok(()),
        }
    }

    fn cuts_odometry(data: &RecordData) -> bool {
        matches!(data, RecordData::Image(_))
    }

    fn finish(&mut self) -> Result<(), String> {
        self.finish_measurements();
        Ok(())
    }

    fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }
}
