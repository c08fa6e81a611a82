use anyhow::Result;
use serde::Deserialize;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_scene_sim::monobot::MonobotParams;
use wayfix_sensor_log::LogOpenOptions;

use super::super::PlannedJob;
use crate::{
    consistency::{self, ConsistencyMonteCarlo, CorridorLaps},
    monobot::{self, WorldReference},
};

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, tag = "experiment", rename_all = "kebab-case")]
enum Settings {
    /// Information against the number of landmarks.
    Fisher { n_landmarks: Vec<u32>, n_steps: usize },
    /// Likelihood of the measurements of many drives, and its gradient.
    Likelihood { n_drives: u64, n_steps: usize },
    /// Many drives with one kind of reference.
    Monobot {
        reference: WorldReference,
        n_runs: u64,
        #[serde(flatten)]
        noise: Noise,
    },
    /// The error at the end against the number of landmarks.
    Landmarks {
        n_landmarks: Vec<usize>,
        n_runs: u64,
        #[serde(flatten)]
        noise: Noise,
    },
    /// A stored log through all kinds of filters; `laps` has its noise.
    Log { laps: CorridorLaps },
    /// Laps of a loop in the plane, through all kinds of filters.
    Laps { n_runs: u32, n_runs_quick: u32, laps: CorridorLaps },
}

/// Noise of the monobot: the paper states none.
#[derive(Clone, Copy, Debug, Deserialize)]
struct Noise {
    motion_sigma_share: f64,
    range_sigma_share: f64,
    external_position_sigma_m: f64,
}

/// The paper's one-dimensional experiments, and laps in the plane.
pub(super) fn run(job: &PlannedJob<'_>) -> Result<ReportRun> {
    match job.planned.settings()? {
        Settings::Fisher { n_landmarks, n_steps } => fisher(&n_landmarks, n_steps),
        Settings::Likelihood { n_drives, n_steps } => {
            let metrics = monobot::likelihood_metrics(n_drives, n_steps, job.options.seed)?;
            Ok(ReportRun { metrics, ..ReportRun::default() })
        }
        Settings::Monobot { reference, n_runs, noise } => {
            let all = monobot::monte_carlo(&noise.params(1), reference, n_runs, job.options.seed)?;
            let figures = all.drives.first().map(monobot::plots).transpose()?.unwrap_or_default();
            Ok(ReportRun { metrics: all.metrics(), figures, ..ReportRun::default() })
        }
        Settings::Log { laps } => {
            let (records, _) = wayfix_sensor_log::open(job.log()?, &LogOpenOptions::default())?.read_all();
            report(&consistency::over_logs(&laps, 1, |_| Ok(records.clone()))?)
        }
        Settings::Laps { n_runs, n_runs_quick, laps } => {
            let n_runs = if job.options.quick { n_runs_quick } else { n_runs };
            report(&consistency::monte_carlo(&laps, n_runs, job.options.seed)?)
        }
        Settings::Landmarks { n_landmarks, n_runs, noise } => landmarks(job, &n_landmarks, n_runs, noise),
    }
}

fn fisher(n_landmarks: &[u32], n_steps: usize) -> Result<ReportRun> {
    let mut metrics = Vec::new();
    for n in n_landmarks {
        let entry = monobot::first_entry(*n, n_steps)?.last().copied().unwrap_or(f64::NAN);
        metrics.push(Metric::new(format!("fisher_information_{n}_landmarks"), entry, "1/m²"));
        let expected = monobot::expected_rate(*n) * n_steps as f64;
        metrics.push(Metric::new(
            format!("fisher_information_over_expected_{n}_landmarks"),
            entry / expected,
            "",
        ));
    }
    Ok(ReportRun {
        metrics,
        figures: vec![monobot::fisher_plot(n_landmarks, n_steps)?],
        ..ReportRun::default()
    })
}

fn landmarks(job: &PlannedJob<'_>, n_landmarks: &[usize], n_runs: u64, noise: Noise) -> Result<ReportRun> {
    let mut metrics: Vec<Metric> = Vec::new();
    for n in n_landmarks {
        let all = monobot::monte_carlo(&noise.params(*n), WorldReference::None, n_runs, job.options.seed)?;
        metrics.push(Metric::new(format!("landmark_error_rms_at_end_m_n{n}"), all.end_rms(), "m"));
    }
    let fall = metrics.first().zip(metrics.last()).map_or(f64::NAN, |(few, many)| few.value / many.value);
    metrics.push(Metric::new("landmark_error_rms_ratio_fewest_over_most_landmarks", fall, ""));
    Ok(ReportRun { metrics, ..ReportRun::default() })
}

fn report(all: &ConsistencyMonteCarlo) -> Result<ReportRun> {
    let note = format!(
        "{} logs; a consistent filter's average NEES is in {:.2} to {:.2} at any one scan, and in {:.2} to {:.2} at all scans, with 95 %.",
        all.n_runs, all.band.low, all.band.high, all.whole_run_band.low, all.whole_run_band.high
    );
    let figures = vec![consistency::picture(all)?];
    Ok(ReportRun { metrics: all.metrics(), figures, notes: vec![note], ..ReportRun::default() })
}

impl Noise {
    fn params(self, n_landmarks: usize) -> MonobotParams {
        let Self { motion_sigma_share, range_sigma_share, external_position_sigma_m } = self;
        MonobotParams {
            n_landmarks,
            motion_sigma_share,
            range_sigma_share,
            external_position_sigma_m,
            ..MonobotParams::default()
        }
    }
}
