use std::sync::Arc;

use anyhow::Result;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rayon::prelude::*;
use wayfix_color_map::ColorMap;
use wayfix_color_model::LightingFilterBank;
use wayfix_evaluation::{
    errors::proportion_interval,
    plot::{LinePlot, PlotError},
    report::{Metric, ReportRun},
};
use wayfix_scene_sim::league::{LampSetting, LeagueParams};
use wayfix_scene_sim::random::RandomStreams;
use wayfix_systems::color::{ColorRun, ColorRunSetup, ColorSystemParams, StartPose, run};

use crate::error_quantiles::error_quantiles;

/// Maximum position error of a successful run, m.
const NEAR_M: f64 = 0.2;
/// Number of frames of a run, for global localization or for relocalization after a kidnapping.
const FRAMES: usize = 60;
/// Number of final frames that must satisfy it; a single one could be chance.
const LAST_FRAMES: usize = 5;

/// Number of successful runs, each in its own hall under unseen light.
#[derive(Clone, Debug)]
pub(crate) struct ConvergenceCount {
    /// Whether the start is known and the robot is kidnapped later, rather than unknown.
    pub kidnapped: bool,
    /// One a seed, in their order.
    pub trials: Vec<ConvergenceTrial>,
}

/// One run.
#[derive(Clone, Debug)]
pub(crate) struct ConvergenceTrial {
    /// Its seed, also of its hall.
    pub seed: u64,
    /// Position error frame by frame, metres.
    pub errors: Vec<f64>,
    /// Whether the estimate reports tracking at the end.
    pub reported_tracking: bool,
}

/// Global localization with unknown light.
/// # Errors
/// Returns an error if a log cannot be simulated or no image used.
pub(crate) fn global_start(
    seeds: impl IntoIterator<Item = u64>,
    map: &Arc<ColorMap>,
    bank: &LightingFilterBank,
    params: &ColorSystemParams,
) -> Result<ConvergenceCount> {
    let trials = trials(seeds, |seed| {
        let drive = LeagueParams {
            n_frames: FRAMES,
            lamp_settings: vec![(0, lighting(seed))],
            ..LeagueParams::default()
        };
        trial(seed, drive, Some(StartPose::Anywhere), map, bank, params)
    })?;
    Ok(ConvergenceCount { kidnapped: false, trials })
}

/// Starts near the truth; the robot is kidnapped after 40 frames.
///
/// # Errors
/// Returns the errors of [`global_start`].
pub(crate) fn kidnapped(
    seeds: impl IntoIterator<Item = u64>,
    map: &Arc<ColorMap>,
    bank: &LightingFilterBank,
    params: &ColorSystemParams,
) -> Result<ConvergenceCount> {
    const BEFORE: usize = 40;
    let trials = trials(seeds, |seed| {
        let drive = LeagueParams {
            n_frames: BEFORE + FRAMES,
            kidnap_frames: vec![BEFORE],
            lamp_settings: vec![(0, lighting(seed))],
            ..LeagueParams::default()
        };
        trial(seed, drive, None, map, bank, params)
    })?;
    Ok(ConvergenceCount { kidnapped: true, trials })
}

/// Every other hall is dark.
fn lighting(seed: u64) -> LampSetting {
    if seed.is_multiple_of(2) { LampSetting::Dark } else { LampSetting::Bright }
}

fn trials(
    seeds: impl IntoIterator<Item = u64>,
    trial: impl Fn(u64) -> Result<ConvergenceTrial> + Sync,
) -> Result<Vec<ConvergenceTrial>> {
    seeds.into_iter().collect::<Vec<u64>>().into_par_iter().map(&trial).collect()
}

fn trial(
    seed: u64,
    drive: LeagueParams,
    start: Option<StartPose>,
    map: &Arc<ColorMap>,
    bank: &LightingFilterBank,
    params: &ColorSystemParams,
) -> Result<ConvergenceTrial> {
    let records = drive.simulate(RandomStreams::new(ChaCha8Rng::seed_from_u64(seed)))?;
    let run: ColorRun =
        run(&records, ColorRunSetup { start, ..ColorRunSetup::new(map, bank, params, seed) }, |_| {})?;
    let errors = run.samples().iter().map(|(_, sample)| sample.position_error()).collect();
    let reported_tracking = run
        .samples()
        .last()
        .is_some_and(|(frame, _)| frame.status == wayfix_color_model::LocalizationStatus::Tracking);
    Ok(ConvergenceTrial { seed, errors, reported_tracking })
}

impl ConvergenceTrial {
    /// Whether the last frame is near the truth.
    pub(crate) fn is_near_at_end(&self) -> bool {
        self.errors.last().is_some_and(|error| *error <= NEAR_M)
    }

    /// Whether the last frames are all near the truth.
    pub(crate) fn succeeded(&self) -> bool {
        let from = self.errors.len().saturating_sub(LAST_FRAMES);
        !self.errors.is_empty() && self.errors[from..].iter().all(|error| *error <= NEAR_M)
    }
}

impl ConvergenceCount {
    /// Counts, their interval, and the errors of every frame over the runs.
    ///
    /// # Errors
    /// Returns an error if the picture cannot be drawn.
    pub(crate) fn report(&self) -> Result<ReportRun, PlotError> {
        let n = self.trials.len();
        let n_succeeded = self.trials.iter().filter(|trial| trial.succeeded()).count();
        let n_near_at_end = self.trials.iter().filter(|trial| trial.is_near_at_end()).count();
        let n_deceived =
            self.trials.iter().filter(|trial| trial.reported_tracking && !trial.succeeded()).count();
        let (low, high) = proportion_interval(n_succeeded as u64, n as u64);
        let mut notes = vec![format!(
            "{n} halls, one for each run, every other one dark; success: within {NEAR_M} m in each of the last {LAST_FRAMES} of {FRAMES} frames; near at the end: in the last one."
        )];
        let failed: Vec<String> =
            self.trials.iter().filter(|t| !t.succeeded()).map(|t| t.seed.to_string()).collect();
        if !failed.is_empty() {
            notes.push(format!("Failed: seeds {}.", failed.join(", ")));
        }
        Ok(ReportRun {
            metrics: vec![
                Metric::new("trials", n as f64, ""),
                Metric::new("success_share", n_succeeded as f64 / n.max(1) as f64, ""),
                Metric::new("success_share_low95", low, ""),
                Metric::new("success_share_high95", high, ""),
                Metric::new("near_truth_at_end_share", n_near_at_end as f64 / n.max(1) as f64, ""),
                Metric::new("n_failures_reported_as_tracking", n_deceived as f64, ""),
            ],
            figures: vec![self.plot().draw()?],
            notes,
            ..ReportRun::default()
        })
    }

    fn plot(&self) -> LinePlot {
        let n_frames = self.trials.iter().map(|trial| trial.errors.len()).max().unwrap_or(0);
        let title =
            if self.kidnapped { "Kidnapped at frame 40" } else { "Global localization in unknown light" };
        error_quantiles(title, "frame", n_frames, |frame| {
            let errors = self.trials.iter().filter_map(|trial| trial.errors.get(frame).copied());
            (frame as f64, errors.collect())
        })
    }
}
