use anyhow::{Result, bail};
use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_appearance_cml::Start;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_sensor_log::{Data, Record};

use super::{CmlParams, CmlSystem, FrameResult, Plan, PoseSigmas, system::gaussian};

use crate::system::{DriveStep, KnownStart, ODOMETRY, System, check_overlap, drive, without_odometry_delay};
use wayfix_evaluation::errors::{Sample, TrueTrack};

/// What a run does with its views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// The map grows while the robot localizes in it, from a known start.
    ConcurrentMapBuilding,
    /// Views with known poses are taught first, others are localized then.
    LearnThenLocalize,
    /// Views are localized in a map that was saved.
    LocalizeInSavedMap,
}

/// Where the robot is at the first view.
#[derive(Clone, Debug)]
pub enum StartPlace {
    /// Near there, as well as [`CmlParams::start`] says.
    Near(Pose2<f64>),
    /// There, in a map that has no other frame than the one that the start gives it.
    Exactly(Pose2<f64>),
    /// Anywhere in the map.
    Anywhere,
    /// Where the saved state has it.
    Saved(Start),
}

/// Views that went through the localizer, beside the truth.
pub struct CmlRun {
    /// What was done.
    pub task: Task,
    /// The system in its last state.
    pub system: CmlSystem,
    /// True poses, where there are any.
    pub truth: TrueTrack,
    /// Whether true headings were measured.
    pub headings_are_measured: bool,
    /// Remarks for the user.
    pub notes: Vec<String>,
}

/// Teaches the training views of a plan, puts the robot at its start and takes the records through, showing each step to `observe`.
///
/// # Errors
/// When there is no image, or none that could be used.
pub fn run(
    mut system: CmlSystem,
    plan: &Plan,
    task: Task,
    start: StartPlace,
    params: &CmlParams,
    seed: u64,
    observe: impl FnMut(DriveStep<'_, CmlSystem>),
) -> Result<CmlRun> {
    if !plan.records.iter().any(|record| matches!(record.data, Data::Image(_))) {
        bail!("there are no images to localize (`wayfix info` shows what a log holds)");
    }
    check_overlap(&plan.records, ODOMETRY, ("images", |data| matches!(data, Data::Image(_))))?;
    for (image, pose) in &plan.training_views {
        system.teach(image, pose, &params.taught_pose)?;
    }
    system.start(begin(start, &params.start, seed)?)?;
    let records = without_odometry_delay(&plan.records, params.odometry_delay);
    drive(&mut system, records.iter(), observe);
    if system.frames().is_empty() {
        let why = system.events().refusals().first().map_or(String::new(), |first| format!(": {first}"));
        bail!("no image could be used{why}");
    }
    system.warn_of_lag(params.odometry_delay);
    Ok(CmlRun {
        task,
        system,
        truth: TrueTrack::from_records(&plan.records),
        headings_are_measured: plan.headings_are_measured,
        notes: plan.notes.clone(),
    })
}

/// The true pose where the first motion or view is, or led back to there by odometry from the first true pose after it.
pub fn first_true_pose(records: &[Record]) -> Option<Pose2<f64>> {
    let (_, moves) = ODOMETRY;
    let first =
        records.iter().position(|record| moves(&record.data) || matches!(record.data, Data::Image(_)))?;
    // An increment leads from the record before it.
    let is_increment = matches!(records[first].data, Data::OdometryIncrement(_));
    let begin = if is_increment { first.saturating_sub(1) } else { first };
    let start = KnownStart::at(records[begin].stamp, &TrueTrack::from_records(records), records)?;
    Some(start.pose)
}

/// How well a start is known that defines the frame of a map.
const EXACT: PoseSigmas = PoseSigmas { position: 1e-3, heading: 1e-3 };

fn begin(start: StartPlace, sigmas: &PoseSigmas, seed: u64) -> Result<Start> {
    Ok(match start {
        StartPlace::Anywhere => Start::Anywhere,
        StartPlace::Saved(start) => start,
        StartPlace::Exactly(pose) => Start::Known(gaussian(&pose, &EXACT)?),
        StartPlace::Near(pose) => {
            // As far off the truth as it is said to be.
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut normal = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
            let error =
                Vector3::new(normal(sigmas.position), normal(sigmas.position), normal(sigmas.heading));
            Start::Known(gaussian(&pose.retract(&error), sigmas)?)
        }
    })
}

impl CmlRun {
    /// Views that were localized, with the true pose at their stamp.
    pub fn samples(&self) -> Vec<(&FrameResult, Sample)> {
        let sample = |frame: &FrameResult| {
            let (pose, truth) = (frame.pose.as_ref()?, self.truth.at(frame.stamp)?);
            Some(Sample { estimate: *pose.mean(), covariance: *pose.covariance(), truth })
        };
        let frames = self.system.frames().iter();
        frames.filter_map(|frame| Some((frame, sample(frame)?))).collect()
    }

    /// Seconds since the first view.
    pub fn seconds(&self, frame: &FrameResult) -> f64 {
        self.system.frames().first().map_or(0.0, |first| frame.stamp.seconds_since(first.stamp))
    }
}
