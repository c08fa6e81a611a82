use std::{sync::Arc, time::Duration};

use nalgebra::Vector3;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_map::{ColorMap, PinholeCamera};
use wayfix_color_model::{
    ColorDensity, ColorLocalizer, ColorLocalizerModels, ColorLookUpTable, ImageLikelihoodChoice,
    LightingFilterBank, LocalizationStatus, OdometryNoise, OdometryStep, PixelClassifier, StartPosePrior,
    YuvImage,
};
use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
use wayfix_evaluation::{errors::PoseWithTruth, plot::Decimated};
use wayfix_gaussian_core::Gaussian;
use wayfix_sensor_log::{CameraInfo, EncodedImage, Record, RecordData, Stamp};
use wayfix_system_core::{
    EventCounts, LoggedMotion, LoggedOdometry, MOST_ESTIMATES, Stopwatch, System, VELOCITY_TIMEOUT,
};

use super::{ClassificationCounts, ColorSystemParams, tally};

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
    camera: Option<CameraInfo>,
    mount: Option<Pose3<f64>>,
    labels: Option<(Stamp, EncodedImage)>,
    localizer: Option<Localizer>,
    pending: Pending,
    last_image: Option<LastImage>,
    odometry: LoggedOdometry,
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

/// An image that differs from the one before, and the motion since.
struct LastImage {
    image: EncodedImage,
    moved: Pose2<f64>,
}

/// Result of one frame.
#[derive(Clone, Debug)]
pub struct ColorFrameResult {
    /// Capture time.
    pub stamp: Stamp,
    /// The pose estimate, with covariance in its body frame.
    pub pose: Gaussian<Pose2<f64>>,
    /// Quality of the estimate.
    pub status: LocalizationStatus,
    /// Dead-reckoned pose; `None` without a known start.
    pub odometry: Option<Pose2<f64>>,
    /// Effective number of particles.
    pub effective_particles: f64,
    /// Number of particles.
    pub n_particles: usize,
    /// Probability of each light of the bank.
    pub light_probabilities: Vec<f64>,
    /// Classification counts, if the log has true labels.
    pub labelled: Option<ClassificationCounts>,
    /// Computing time after decoding.
    pub step: Duration,
}

impl ColorFrameResult {
    /// The estimate beside the truth at its stamp.
    pub(super) fn beside(&self, truth: Pose2<f64>) -> PoseWithTruth {
        PoseWithTruth { estimate: *self.pose.mean(), covariance: *self.pose.covariance(), truth }
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
            camera: None,
            mount: None,
            labels: None,
            localizer: None,
            pending: Pending::default(),
            last_image: None,
            odometry: LoggedOdometry::new(VELOCITY_TIMEOUT),
            dead_reckoning,
            frames: Decimated::new(MOST_ESTIMATES),
            latest: None,
            table: None,
            events: EventCounts::default(),
        }
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
        if let Some(LastImage { moved, .. }) = &mut self.last_image {
            *moved = moved.compose(&motion.increment);
        }
        if self.pending.since.is_some() {
            // The start is the pose at the first image.
            self.dead_reckoning = self.dead_reckoning.map(|pose| pose.compose(&motion.increment));
        }
    }

    /// Refuses an image that repeats the last one although the robot has turned by more than a pixel, or moved as far as turns a view at 1 m so.
    fn check_is_new(&mut self, image: &EncodedImage, pixels: &[u8], fx: f64) -> Result<(), String> {
        let Some(LastImage { moved, .. }) = self.last_image.as_ref().filter(|last| last.image == *image)
        else {
            self.last_image = Some(LastImage { image: image.clone(), moved: Pose2::identity() });
            return Ok(());
        };
        let shift = (moved.translation.norm() + moved.heading().abs()) * fx;
        // A covered camera, or one without light, sees the same everywhere.
        let is_blank = pixels.iter().max().zip(pixels.iter().min()).is_none_or(|(most, least)| most == least);
        if shift > 1.0 && !is_blank {
            return Err(format!(
                "the image repeats the one before, although odometry has moved it by some {shift:.0} pixels: the camera hangs"
            ));
        }
        Ok(())
    }

    fn see(&mut self, stamp: Stamp, image: &EncodedImage) -> Result<(), String> {
        let info = self.camera.ok_or("no camera info before this image")?;
        let mount = self.mount.ok_or("no camera mount before this image")?;
        let decoded = image.decode_rgb().map_err(|error| error.to_string())?;
        self.check_is_new(image, &decoded.pixels, info.fx)?;
        let image =
            YuvImage::from_rgb(decoded.width, decoded.height, &decoded.pixels, self.params.yuv_standard)
                .map_err(|error| error.to_string())?;

        let stopwatch = Stopwatch::start();
        let outcome = self.localize(stamp, info, &mount, &image).map_err(|error| error.to_string())?;
        let step = stopwatch.elapsed();

        self.events.count(match outcome.status {
            LocalizationStatus::Tracking => "tracking",
            LocalizationStatus::Ambiguous => "ambiguous",
            LocalizationStatus::Lost => "lost",
        });

        let labelled = self.labelled(stamp, &image);
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

    fn localize(
        &mut self,
        stamp: Stamp,
        info: CameraInfo,
        mount: &Pose3<f64>,
        image: &YuvImage,
    ) -> anyhow::Result<wayfix_color_model::FrameOutcome> {
        let localizer = match &mut self.localizer {
            Some(localizer) => localizer,
            none => none.insert(ColorLocalizer::with_models(
                Arc::clone(&self.map),
                PinholeCamera::new(info.width, info.height, info.fx, info.fy, info.cx, info.cy)?,
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
        if let Some(since) = self.pending.since {
            let Pending { increment, unknown_seconds, .. } = self.pending;
            let seconds = stamp.seconds_since(since);
            localizer.predict(
                &OdometryStep { increment, seconds: (seconds - unknown_seconds).max(0.0) },
                &mut self.rng,
            )?;
            if unknown_seconds > 0.0 {
                let unknown = OdometryStep { increment: None, seconds: unknown_seconds };
                localizer.predict(&unknown, &mut self.rng)?;
            }
        }
        // The motion is already predicted, whether or not the image is usable.
        self.pending = Pending { since: Some(stamp), ..Pending::default() };
        Ok(localizer.update(image, mount, &mut self.rng)?)
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
            RecordData::CameraInfo(info) => self.camera = Some(*info),
            RecordData::CameraMount(mount) => self.mount = Some(*mount),
            RecordData::TrueLabels(labels) => self.labels = Some((record.stamp, labels.clone())),
            RecordData::Image(image) => {
                let held = self.odometry.advance_to(record.stamp, &mut self.events);
                held.iter().for_each(|motion| self.move_by(motion));
                self.see(record.stamp, image)?;
            }
            _ => {
                let motion = self.odometry.take(record, &mut self.events)?;
                motion.iter().for_each(|motion| self.move_by(motion));
            }
        }
        Ok(())
    }

    fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }
}
