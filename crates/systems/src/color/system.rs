use std::{sync::Arc, time::Duration};

use anyhow::ensure;
use nalgebra::Vector3;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_map::ColorMap;
use wayfix_color_model::{
    ColorDensity, ColorLocalizer, ColorLocalizerModels, ColorLookUpTable, FrameOutcome,
    ImageLikelihoodChoice, LightingFilterBank, LocalizationStatus, OdometryNoise, OdometryStep,
    PixelClassifier, StartPosePrior, YuvImage,
};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_evaluation::plot::Decimated;
use wayfix_gaussian_core::Gaussian;
use wayfix_sensor_log::{EncodedImage, Record, RecordData, Stamp};
use wayfix_system_core::{
    EventCounts, LoggedMotion, LoggedOdometry, MOST_ESTIMATES, OdometryRecordKind, Stopwatch, System,
    VELOCITY_TIMEOUT,
};

use super::{
    ClassificationCounts, ColorFrameResult, ColorSystemParams,
    camera::{LoggedCamera, PlacedImage, RecordIterator, SecondCamera, pinhole},
    tally,
};

/// Knowledge of the start pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StartPose {
    /// Near this pose, with the uncertainty of [`StartPoseUncertainty`](super::StartPoseUncertainty).
    Near(Pose2<f64>),
    /// Anywhere on the field.
    Anywhere,
}

/// The localizer, fed with the records of a log.
pub struct ColorSystem {
    map: Arc<ColorMap>,
    bank: LightingFilterBank,
    params: ColorSystemParams,
    start: StartPose,
    rng: ChaCha8Rng,
    camera: LoggedCamera,
    second_camera: Option<SecondCamera>,
    /// Computing time of its images since the last result.
    second_step: Duration,
    labels: Option<(Stamp, EncodedImage)>,
    localizer: Option<Localizer>,
    pending: Pending,
    odometry: LoggedOdometry,
    /// Stamp of the last increment of odometry.
    moved_until: Option<Stamp>,
    dead_reckoning: Option<Pose2<f64>>,
    frames: Decimated<ColorFrameResult>,
    latest: Option<ColorFrameResult>,
    table: Option<ColorLookUpTable>,
    events: EventCounts,
}

/// Motion since the last frame.
#[derive(Clone, Copy, Debug, Default)]
struct Pending {
    increment: Option<Pose2<f64>>,
    /// Time of it without a measured motion, s.
    unknown_seconds: f64,
    since: Option<Stamp>,
}

impl Pending {
    /// The measured motion until an image, then the time without one. It counts as predicted, whether or not the image is usable.
    fn steps_until(&mut self, stamp: Stamp) -> impl Iterator<Item = OdometryStep> + use<> {
        let next = Self { since: Some(stamp), ..Self::default() };
        let Self { increment, unknown_seconds, since } = std::mem::replace(self, next);
        let steps = since.map(|since| {
            let seconds = (stamp.seconds_since(since) - unknown_seconds).max(0.0);
            let unknown = OdometryStep { increment: None, seconds: unknown_seconds };
            let unknown = (unknown_seconds > 0.0).then_some(unknown);
            std::iter::once(OdometryStep { increment, seconds }).chain(unknown)
        });
        steps.into_iter().flatten()
    }
}

type Localizer = ColorLocalizer<LightingFilterBank, OdometryNoise, ImageLikelihoodChoice>;

impl ColorSystem {
    /// Creates a system before its first record.
    pub fn new(
        map: Arc<ColorMap>,
        bank: LightingFilterBank,
        params: ColorSystemParams,
        start: StartPose,
        seed: u64,
    ) -> Self {
        let dead_reckoning = match start {
            StartPose::Near(pose) => Some(pose),
            StartPose::Anywhere => None,
        };
        Self {
            map,
            bank,
            params,
            start,
            rng: ChaCha8Rng::seed_from_u64(seed),
            camera: LoggedCamera::default(),
            second_camera: None,
            second_step: Duration::ZERO,
            labels: None,
            localizer: None,
            pending: Pending::default(),
            odometry: LoggedOdometry::new(VELOCITY_TIMEOUT),
            moved_until: None,
            dead_reckoning,
            frames: Decimated::new(MOST_ESTIMATES),
            latest: None,
            table: None,
            events: EventCounts::default(),
        }
    }

    /// Takes images of a second camera from these records, in the order of time: they correct the pose between the results, which are those of the first camera.
    #[must_use]
    pub fn with_second_camera(self, records: RecordIterator) -> Self {
        Self { second_camera: Some(SecondCamera::new(records)), ..self }
    }

    /// Results of the frames so far, evenly spaced: all of a short log, at most [`MOST_ESTIMATES`] of a long one.
    pub fn frames(&self) -> &[ColorFrameResult] {
        self.frames.kept()
    }

    pub(super) fn sample(&self) -> &Decimated<ColorFrameResult> {
        &self.frames
    }

    /// Result of the last frame.
    pub fn latest(&self) -> Option<&ColorFrameResult> {
        self.latest.as_ref()
    }

    /// The localizer; `None` before the first frame.
    pub fn localizer(&self) -> Option<&Localizer> {
        self.localizer.as_ref()
    }

    /// The most probable light of the localizer; the prior before the first frame.
    pub fn light(&self) -> &LightingFilterBank {
        self.localizer.as_ref().map_or(&self.bank, ColorLocalizer::light)
    }

    /// Current colour densities of the map's colours.
    fn colors(&self) -> Vec<ColorDensity> {
        let light = self.light();
        self.params.localizer.pixels.shaded(light.member(light.active()).colors())
    }

    /// Parameters of the system.
    pub fn params(&self) -> &ColorSystemParams {
        &self.params
    }

    /// The map.
    pub fn map(&self) -> &ColorMap {
        &self.map
    }

    /// Classifies the image with the current light: the map's colours, 255 for background.
    ///
    /// # Errors
    /// Returns an error if a colour's density has no peak.
    pub(crate) fn classified(&mut self, image: &YuvImage) -> Result<Vec<u8>, String> {
        let colors = self.colors();
        let table = match self.table.take() {
            Some(mut table) => {
                table.rebuild_if_changed(colors).map_err(|error| error.to_string())?;
                table
            }
            None => ColorLookUpTable::new(colors, Some(self.params.background_model.clone()))
                .map_err(|e| e.to_string())?,
        };
        let classified = table.classify_image(image);
        self.table = Some(table);
        Ok(classified)
    }

    fn move_by(&mut self, motion: &LoggedMotion) {
        let so_far = self.pending.increment.unwrap_or(Pose2::new(0.0, 0.0, 0.0));
        self.pending.increment = Some(so_far.compose(&motion.increment));
        self.pending.unknown_seconds += motion.unknown_seconds;
        self.camera.move_by(&motion.increment);
        if let Some(second) = &mut self.second_camera {
            second.camera.move_by(&motion.increment);
        }
        if self.pending.since.is_some() {
            // The start is the pose at the first image.
            self.dead_reckoning = self.dead_reckoning.map(|pose| pose.compose(&motion.increment));
        }
    }

    fn see(&mut self, stamp: Stamp, image: &EncodedImage) -> Result<(), String> {
        let placed = self.camera.see(image, &self.params)?;
        let stopwatch = Stopwatch::start();
        let outcome = self.localize(stamp, &placed).map_err(|error| error.to_string())?;
        let step = stopwatch.elapsed() + std::mem::take(&mut self.second_step);

        self.events.count(match outcome.status {
            LocalizationStatus::Tracking => "tracking",
            LocalizationStatus::Ambiguous => "ambiguous",
            LocalizationStatus::Lost => "lost",
        });

        let labelled = self.labelled(stamp, &placed.image);
        let result = ColorFrameResult {
            stamp,
            pose: outcome.estimate.pose,
            status: outcome.status,
            odometry: self.dead_reckoning,
            effective_particles: outcome.effective_particles,
            n_particles: outcome.n_particles,
            light_probabilities: outcome.light_probabilities,
            labelled,
            step,
        };
        self.frames.push(result.clone());
        self.latest = Some(result);
        Ok(())
    }

    /// Applies the velocities that hold until an image.
    fn move_until(&mut self, stamp: Stamp) {
        let held = self.odometry.advance_to(stamp, &mut self.events);
        held.iter().for_each(|motion| self.move_by(motion));
    }

    fn localize(&mut self, stamp: Stamp, placed: &PlacedImage) -> anyhow::Result<FrameOutcome> {
        let PlacedImage { camera, mount, image } = placed;
        let localizer = match &mut self.localizer {
            Some(localizer) => localizer,
            none => none.insert(ColorLocalizer::with_models(
                Arc::clone(&self.map),
                pinhole(camera)?,
                ColorLocalizerModels {
                    light: self.bank.clone(),
                    odometry: self.params.localizer.odometry,
                    likelihood: self.params.likelihood(),
                },
                &start(self.start, &self.params)?,
                self.params.localizer,
                &mut self.rng,
            )?),
        };
        for step in self.pending.steps_until(stamp) {
            localizer.predict(&step, &mut self.rng)?;
        }
        Ok(localizer.update(image, mount, &mut self.rng)?)
    }

    fn next_second_image(&mut self, before: Stamp) -> Option<(Stamp, EncodedImage)> {
        self.second_camera.as_mut()?.next_image_before(before)
    }

    /// Takes the images of the second camera before this time; velocities hold until each.
    fn look_through_second_camera(&mut self, before: Stamp) {
        while let Some((stamp, image)) = self.next_second_image(before) {
            self.move_until(stamp);
            self.see_second(stamp, &image);
        }
    }

    /// Moves by an increment of odometry; an image of the second camera on the way is seen after its share of the motion.
    fn move_along(&mut self, motion: &LoggedMotion, until: Stamp) {
        let (mut rest, mut since) = (*motion, self.moved_until.replace(until));
        while let Some((stamp, image)) = self.next_second_image(until) {
            let share = since.map_or(0.0, |since| {
                (stamp.seconds_since(since) / until.seconds_since(since)).clamp(0.0, 1.0)
            });
            let identity = Pose2::identity();
            let increment = identity.retract(&(identity.local(&rest.increment) * share));
            self.move_by(&LoggedMotion { increment, ..rest });
            rest.increment = increment.inverse().compose(&rest.increment);
            since = Some(stamp);
            self.see_second(stamp, &image);
        }
        self.move_by(&rest);
    }

    /// Localizes by an image of the second camera, once the first one has seen the start.
    fn see_second(&mut self, stamp: Stamp, image: &EncodedImage) {
        let stopwatch = Stopwatch::start();
        match self.localize_by_second(stamp, image) {
            Ok(true) => self.events.count("second_camera_image"),
            Ok(false) => {}
            Err(reason) => {
                self.events.refuse("record_refused", format!("second camera, {stamp}: {reason}"));
            }
        }
        self.second_step += stopwatch.elapsed();
    }

    fn localize_by_second(&mut self, stamp: Stamp, image: &EncodedImage) -> anyhow::Result<bool> {
        let (Some(since), Some(localizer)) = (self.pending.since, &mut self.localizer) else {
            return Ok(false);
        };
        ensure!(stamp >= since, "time goes back by {:.9} s", since.seconds_since(stamp));
        let Some(second) = &mut self.second_camera else { return Ok(false) };
        ensure!(
            second.camera.mount() != self.camera.mount(),
            "its mount is that of the first camera: give the log or the topic of the second one"
        );
        let placed = second.camera.see(image, &self.params).map_err(anyhow::Error::msg)?;
        let number = match second.number {
            Some(number) => number,
            None => *second.number.insert(localizer.add_camera(pinhole(&placed.camera)?)),
        };
        for step in self.pending.steps_until(stamp) {
            localizer.predict(&step, &mut self.rng)?;
        }
        localizer.update_from(number, &placed.image, &placed.mount, &mut self.rng)?;
        Ok(true)
    }

    fn labelled(&mut self, stamp: Stamp, image: &YuvImage) -> Option<ClassificationCounts> {
        let (_, labels) = self.labels.take().filter(|(labelled, _)| *labelled == stamp)?;
        let labels = labels.decode_labels().ok()?;
        let classifier = PixelClassifier::new(self.colors()).ok()?;
        tally(image, &labels, &classifier, self.map.colors().len())
    }
}

fn start(start: StartPose, params: &ColorSystemParams) -> anyhow::Result<StartPosePrior> {
    let StartPose::Near(pose) = start else { return Ok(StartPosePrior::Anywhere) };
    let sigma = params.start_uncertainty.position_sigma;
    let sigmas = Vector3::new(sigma, sigma, params.start_uncertainty.heading_sigma);
    Ok(StartPosePrior::Near(Gaussian::from_sigmas(pose, &sigmas)?))
}

impl System for ColorSystem {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        match &record.data {
            data @ (RecordData::CameraInfo(_) | RecordData::CameraMount(_)) => self.camera.take(data),
            RecordData::TrueLabels(labels) => self.labels = Some((record.stamp, labels.clone())),
            RecordData::Image(image) => {
                self.look_through_second_camera(record.stamp);
                self.move_until(record.stamp);
                self.see(record.stamp, image)?;
            }
            RecordData::OdometryIncrement(_) => {
                let motion = self.odometry.take(record, &mut self.events)?;
                motion.iter().for_each(|motion| self.move_along(motion, record.stamp));
            }
            _ => {
                if self.odometry.kind() == Some(OdometryRecordKind::Velocities) {
                    self.look_through_second_camera(record.stamp);
                }
                let motion = self.odometry.take(record, &mut self.events)?;
                motion.iter().for_each(|motion| self.move_by(motion));
            }
        }
        Ok(())
    }

    fn cuts_odometry(data: &RecordData) -> bool {
        matches!(data, RecordData::Image(_))
    }

    fn finish(&mut self) -> Result<(), String> {
        if self.second_camera.is_some() && self.events.get("second_camera_image") == 0 {
            let text =
                "no image of the second camera was used: all were refused, or none is of the time of the log";
            self.events.warn("second_camera_unused", text);
        }
        Ok(())
    }

    fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }
}
