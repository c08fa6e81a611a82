use anyhow::Result;
use serde::Deserialize;
use wayfix_scene_sim::monobot::MonobotParams;

use super::super::Job;
use crate::{
    consistency::{self, Laps},
    monobot::{self, Reference},
};
use wayfix_evaluation::report::{Metric, Run};

/// Settings of a run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, tag = "experiment", rename_all = "kebab-case")]
enum Settings {
    /// Information against the number of landmarks.
    Fisher { n_landmarks: Vec<u32>, n_steps: usize },
    /// Many drives with one kind of reference.
    Monobot {
        reference: Reference,
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
    /// Laps of a loop in the plane, through all kinds of filters.
    Laps { n_runs: u32, n_runs_quick: u32, laps: Laps },
}

/// Noise of the monobot: the paper states none.
#[derive(Clone, Copy, Debug, Deserialize)]
struct Noise {
    motion_noise: f64,
    range_noise: f64,
    external_sigma_m: f64,
}

/// The paper's one-dimensional experiments, and laps in the plane.
pub(super) fn run(job: &Job<'_>) -> Result<Run> {
    match job.planned.settings()? {
        Settings::Fisher { n_landmarks, n_steps } => fisher(&n_landmarks, n_steps),
        Settings::Monobot { reference, n_runs, noise } => {
            let all = monobot::monte_carlo(&noise.params(1), reference, n_runs, job.options.seed)?;
            let figures = all.drives.first().map(monobot::pictures).transpose()?.unwrap_or_default();
            Ok(Run { metrics: all.metrics(), figures, ..Run::default() })
        }
        Settings::Laps { n_runs, n_runs_quick, laps } => {
            run_laps(job, &laps, if job.options.quick { n_runs_quick } else { n_runs })
        }
        Settings::Landmarks { n_landmarks, n_runs, noise } => landmarks(job, &n_landmarks, n_runs, noise),
    }
}

fn fisher(n_landmarks: &[u32], n_steps: usize) -> Result<Run> {
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
    Ok(Run { metrics, figures: vec![monobot::fisher_picture(n_landmarks, n_steps)?], ..Run::default() })
}

fn landmarks(job: &Job<'_>, n_landmarks: &[usize], n_runs: u64, noise: Noise) -> Result<Run> {
    let mut metrics: Vec<Metric> = Vec::new();
    for n in n_landmarks {
        let all = monobot::monte_carlo(&noise.params(*n), Reference::None, n_runs, job.options.seed)?;
        metrics.push(Metric::new(format!("end_landmark_rms_m_n{n}"), all.end_rms(), "m"));
    }
    let fall = metrics.first().zip(metrics.last()).map_or(f64::NAN, |(few, many)| few.value / many.value);
    metrics.push(Metric::new("landmark_rms_ratio", fall, ""));
    Ok(Run { metrics, ..Run::default() })
}

fn run_laps(job: &Job<'_>, laps: &Laps, n_runs: u32) -> Result<Run> {
    let all = consistency::monte_carlo(laps, n_runs, job.options.seed)?;
    let note = format!(
        "{n_runs} logs; a consistent filter's average NEES is in {:.2} to {:.2} at any one look, and in {:.2} to {:.2} at all looks, with 95 %.",
        all.band.low, all.band.high, all.whole_run_band.low, all.whole_run_band.high
    );
    let figures = vec![consistency::picture(&all)?];
    Ok(Run { metrics: all.metrics(), figures, notes: vec![note], ..Run::default() })
}

impl Noise {
    fn params(self, n_landmarks: usize) -> MonobotParams {
        let Self { motion_noise, range_noise, external_sigma_m } = self;
        MonobotParams { n_landmarks, motion_noise, range_noise, external_sigma_m, ..MonobotParams::default() }
    }
}
