use std::{borrow::Borrow, sync::Arc};

use anyhow::{Result, bail};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_color_map::ColorMap;
use wayfix_color_model::{LightingFilterBank, LocalizationStatus};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_evaluation::errors::{PoseWithTruth, ReferencePath};
use wayfix_sensor_log::{Record, RecordData, Stamp};
use wayfix_system_core::TrueStartPose;
use wayfix_system_core::{
    IMAGES, ODOMETRY, RunStep, System, check_overlap, drive, warn_of_ended_odometry, warn_of_large_errors,
    warn_of_no_odometry, warn_of_no_overlap, warn_of_start, without_odometry_delay,
};

use super::{
    ColorFrameResult, ColorSystem, ColorSystemParams, RecordIterator, StartPose, totals::ColorTotals,
};

/// Results of colour localization on a log, with the truth of the log.
pub struct ColorRun {
    /// The system in its last state.
    pub system: ColorSystem,
    /// True poses, where the log has them.
    pub truth: ReferencePath,
    pub(super) totals: ColorTotals,
}

/// Everything that a run needs beside its log.
#[derive(Clone)]
pub struct ColorRunSetup {
    /// The map.
    pub map: Arc<ColorMap>,
    /// The light before the first image.
    pub bank: LightingFilterBank,
    /// The parameters.
    pub params: ColorSystemParams,
    /// The start pose. `None` draws it around the first true pose with the stated uncertainty; without truth the search is global.
    pub start: Option<StartPose>,
    /// Seed of the particles, and of the start pose.
    pub seed: u64,
}

impl ColorRunSetup {
    /// With the start pose of the log.
    pub fn new(
        map: &Arc<ColorMap>,
        bank: &LightingFilterBank,
        params: &ColorSystemParams,
        seed: u64,
    ) -> Self {
        Self { map: Arc::clone(map), bank: bank.clone(), params: params.clone(), start: None, seed }
    }
}

/// Processes the records of a log with the localizer and shows each step to `observe`.
///
/// # Errors
/// Returns an error if there is no usable image.
pub fn run(
    records: &[Record],
    setup: ColorRunSetup,
    observe: impl FnMut(RunStep<'_, ColorSystem>),
) -> Result<ColorRun> {
    let in_time = without_odometry_delay(records, setup.params.odometry_delay);
    run_streamed(records, in_time.iter(), None, setup, observe)
}

/// As [`run`], with the records one by one: a long log need not be kept. `overview` is the same log, whose images may be empty; a delay of odometry was
/// taken out of `records` already. A second camera of the robot, if there is one, has a log of its own, on the same clock.
///
/// # Errors
/// Returns the errors of [`run`].
pub fn run_streamed<R: Borrow<Record>>(
    overview: &[Record],
    records: impl IntoIterator<Item = R>,
    second_camera: Option<RecordIterator>,
    setup: ColorRunSetup,
    mut observe: impl FnMut(RunStep<'_, ColorSystem>),
) -> Result<ColorRun> {
    let ColorRunSetup { map, bank, params, start, seed } = setup;
    let Some(first_image) = overview.iter().find(|record| matches!(record.data, RecordData::Image(_))) else {
        bail!("the log has no camera images (`wayfix info` shows what a log holds)");
    };
    check_overlap(overview, ODOMETRY, IMAGES)?;
    let truth = ReferencePath::from_records(overview);
    let known = TrueStartPose::at(first_image.stamp, &truth, overview).filter(|_| start.is_none());
    let start = start.unwrap_or_else(|| match known {
        Some(known) => StartPose::Near(guess(&known.pose, &params, seed)),
        None => StartPose::Anywhere,
    });
    let mut system = ColorSystem::new(map, bank, params, start, seed);
    if let Some(records) = second_camera {
        system = system.with_second_camera(records);
    }
    if known.is_some() {
        warn_of_start(system.events(), known, &truth);
    }
    let assumed =
        "between two images the robot may move at walking speed (`[localizer.odometry]`, …_without_odometry)";
    warn_of_no_odometry(system.events(), overview, assumed);
    warn_of_ended_odometry(system.events(), overview, IMAGES, "the robot is taken to stand");
    let (mut truth, mut totals) = (truth.restarted(), ColorTotals::default());
    drive(&mut system, records, |step| {
        truth.take(step.record, step.system.frames().iter().map(|frame| frame.stamp));
        totals.take(step.record.stamp, step.system, &truth);
        observe(step);
    });
    totals.compare(None, &truth);
    if system.frames().is_empty() {
        let why = system.events().refusals().first().map_or(String::new(), |first| format!(": {first}"));
        bail!("no image could be used{why}");
    }
    let estimated =
        system.frames().first().zip(system.latest()).map(|(first, last)| (first.stamp, last.stamp));
    warn_of_no_overlap(system.events(), &truth, estimated);
    let mut run = ColorRun { system, truth, totals };
    let is_tracked = |frame: &ColorFrameResult| frame.status == LocalizationStatus::Tracking;
    let tracked = run.samples().into_iter().filter(|(frame, _)| is_tracked(frame));
    let samples: Vec<PoseWithTruth> = tracked.map(|(_, sample)| sample).collect();
    warn_of_large_errors(run.system.events(), &run.truth, &samples);
    Ok(run)
}

/// Number of camera frames in a log.
pub fn n_images(records: &[Record]) -> usize {
    records.iter().filter(|record| matches!(record.data, RecordData::Image(_))).count()
}

/// A start pose drawn around the truth with the stated uncertainty.
fn guess(truth: &Pose2<f64>, params: &ColorSystemParams, seed: u64) -> Pose2<f64> {
    // Uses a different stream than the particles.
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(1);
    let mut normal = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
    let (position, heading) =
        (params.start_uncertainty.position_sigma, params.start_uncertainty.heading_sigma);
    truth.retract(&nalgebra::Vector3::new(normal(position), normal(position), normal(heading)))
}

impl ColorRun {
    /// The [frames](ColorSystem::frames) with the true pose at their stamp.
    pub fn samples(&self) -> Vec<(&ColorFrameResult, PoseWithTruth)> {
        let frames = self.system.frames().iter();
        frames.filter_map(|frame| Some((frame, frame.beside(self.truth.at(frame.stamp)?)))).collect()
    }

    /// Seconds since the first frame.
    pub fn seconds(&self, stamp: Stamp) -> f64 {
        self.system.frames().first().map_or(0.0, |first| stamp.seconds_since(first.stamp))
    }
}
