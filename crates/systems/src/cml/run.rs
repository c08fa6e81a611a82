use std::borrow::Borrow;

use anyhow::{Result, bail};
use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_appearance_cml::StartPosePrior;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_evaluation::errors::{PoseWithTruth, ReferencePath};
use wayfix_sensor_log::{Record, RecordData};
use wayfix_system_core::{
    IMAGES, ODOMETRY, RunStep, System, TrueStartPose, check_overlap, drive, warn_of_ended_odometry,
    warn_of_large_errors, warn_of_no_odometry, without_odometry_delay,
};

use super::{CmlParams, CmlRunPlan, CmlSystem, CmlViewResult, PoseSigmas, system::gaussian};

/// Task of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CmlTask {
    /// Builds the map while localizing in it, from a known start.
    ConcurrentMapBuilding,
    /// Learns views with known poses, then localizes others.
    LearnThenLocalize,
    /// Localizes views in a saved map.
    LocalizeInSavedMap,
}

/// Start pose of the robot at the first view.
#[derive(Clone, Debug)]
pub enum CmlStartPose {
    /// Near this pose, with the uncertainty [`CmlParams::start_uncertainty`].
    Near(Pose2<f64>),
    /// At exactly this pose, which defines the frame of a new map.
    Exactly(Pose2<f64>),
    /// Anywhere in the map.
    Anywhere,
    /// The pose of the saved state.
    Saved(StartPosePrior),
}

/// Localized views and the truth.
pub struct CmlRun {
    /// The task.
    pub task: CmlTask,
    /// The system in its last state.
    pub system: CmlSystem,
    /// True poses, where there are any.
    pub truth: ReferencePath,
    /// Whether the true headings were measured.
    pub headings_are_measured: bool,
    /// Remarks for the user.
    pub notes: Vec<String>,
}

/// Everything that a run needs beside its records.
pub struct CmlRunSetup<'a> {
    /// The system with its map.
    pub system: CmlSystem,
    /// The views to learn and to localize.
    pub plan: &'a CmlRunPlan,
    /// What the run is for.
    pub task: CmlTask,
    /// The start pose.
    pub start: CmlStartPose,
    /// The parameters.
    pub params: &'a CmlParams,
    /// Seed of the start pose.
    pub seed: u64,
}

/// Learns the training views of a plan, sets the start pose and processes the records, showing each step to `observe`.
///
/// # Errors
/// Returns an error if there is no usable image.
pub fn run(setup: CmlRunSetup<'_>, observe: impl FnMut(RunStep<'_, CmlSystem>)) -> Result<CmlRun> {
    let records = without_odometry_delay(&setup.plan.records, setup.params.odometry_delay);
    run_streamed(setup, records.iter(), observe)
}

/// As [`run`], with the records one by one: a long log need not be kept. The records of the plan are then the
/// [overview](wayfix_system_core::LogOverview) of the log; a delay of odometry was taken out of `records` already.
///
/// # Errors
/// Returns the errors of [`run`].
pub fn run_streamed<R: Borrow<Record>>(
    setup: CmlRunSetup<'_>,
    records: impl IntoIterator<Item = R>,
    mut observe: impl FnMut(RunStep<'_, CmlSystem>),
) -> Result<CmlRun> {
    let CmlRunSetup { mut system, plan, task, start, params, seed } = setup;
    if !plan.records.iter().any(|record| IMAGES.1(&record.data)) {
        bail!("there are no images to localize (`wayfix info` shows what a log holds)");
    }
    check_overlap(&plan.records, ODOMETRY, IMAGES)?;
    for (image, pose) in &plan.training_views {
        system.teach(image, pose, &params.taught_pose_uncertainty)?;
    }
    system.start(begin(start, &params.start_uncertainty, seed)?)?;
    let assumed = "the robot is taken to stand";
    warn_of_no_odometry(system.events(), &plan.records, assumed);
    warn_of_ended_odometry(system.events(), &plan.records, IMAGES, assumed);
    let mut truth = ReferencePath::from_records(&plan.records).restarted();
    drive(&mut system, records, |step| {
        truth.take(step.record, step.system.frames().iter().map(|frame| frame.stamp));
        observe(step);
    });
    if system.frames().is_empty() {
        let why = system.events().refusals().first().map_or(String::new(), |first| format!(": {first}"));
        bail!("no image could be used{why}");
    }
    // Headings along a smoothed path turn at other times than the robot.
    if plan.headings_are_measured {
        system.warn_of_lag(params.odometry_delay);
        system.warn_of_turn_scale();
    }
    if system.localizer().map().is_empty() {
        let text =
            "no view was learned: by odometry the robot has never moved far enough from where it started";
        system.events().warn("map_is_empty", text);
    }
    let mut run = CmlRun {
        task,
        system,
        truth,
        headings_are_measured: plan.headings_are_measured,
        notes: plan.notes.clone(),
    };
    let certain = run.samples().into_iter().filter(|(frame, _)| frame.is_certain);
    let samples: Vec<PoseWithTruth> = certain.map(|(_, sample)| sample).collect();
    warn_of_large_errors(run.system.events(), &run.truth, &samples);
    Ok(run)
}

/// The true pose at the first motion or view. If truth begins later, odometry extrapolates its first pose back.
pub fn first_true_pose(records: &[Record]) -> Option<Pose2<f64>> {
    let (_, moves) = ODOMETRY;
    let first = records
        .iter()
        .position(|record| moves(&record.data) || matches!(record.data, RecordData::Image(_)))?;
    // An increment begins at the record before it.
    let is_increment = matches!(records[first].data, RecordData::OdometryIncrement(_));
    let begin = if is_increment { first.saturating_sub(1) } else { first };
    let start = TrueStartPose::at(records[begin].stamp, &ReferencePath::from_records(records), records)?;
    Some(start.pose)
}

/// Uncertainty of a start pose that defines the frame of a map.
const EXACT: PoseSigmas = PoseSigmas { position_sigma: 1e-3, heading_sigma: 1e-3 };

fn begin(start: CmlStartPose, sigmas: &PoseSigmas, seed: u64) -> Result<StartPosePrior> {
    Ok(match start {
        CmlStartPose::Anywhere => StartPosePrior::Anywhere,
        CmlStartPose::Saved(start) => start,
        CmlStartPose::Exactly(pose) => StartPosePrior::Known(gaussian(&pose, &EXACT)?),
        CmlStartPose::Near(pose) => {
            // Draws the start error from the stated uncertainty.
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut normal = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
            let error = Vector3::new(
                normal(sigmas.position_sigma),
                normal(sigmas.position_sigma),
                normal(sigmas.heading_sigma),
            );
            StartPosePrior::Known(gaussian(&pose.retract(&error), sigmas)?)
        }
    })
}

impl CmlRun {
    /// Localized views with the true pose at their stamp.
    pub fn samples(&self) -> Vec<(&CmlViewResult, PoseWithTruth)> {
        let sample = |frame: &CmlViewResult| {
            let (pose, truth) = (frame.pose.as_ref()?, self.truth.at(frame.stamp)?);
            Some(PoseWithTruth { estimate: *pose.mean(), covariance: *pose.covariance(), truth })
        };
        let frames = self.system.frames().iter();
        frames.filter_map(|frame| Some((frame, sample(frame)?))).collect()
    }

    /// Seconds since the first view.
    pub fn seconds(&self, frame: &CmlViewResult) -> f64 {
        self.system.frames().first().map_or(0.0, |first| frame.stamp.seconds_since(first.stamp))
    }
}
