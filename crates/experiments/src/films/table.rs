use std::{ops::Range, time::Duration};

use anyhow::Result;
use rayon::prelude::*;
use wayfix_evaluation::{
    errors::MeanInterval,
    report::{ConfidenceInterval, Metric, ReportRun},
};
use wayfix_scene_sim::film::{OcclusionEvent, SyntheticFilm};
use wayfix_systems::track::{LostStatusScore, TrackParams, TrackRunHistory, TrackingMethod, plots};

use super::{FilmTrackingScore, follow, score::mean};

/// Frames at the end of a film by which it is judged whether the target was found again.
const N_END: usize = 20;

/// A film with many seeds through several methods: overlap with its interval over the seeds, centre error, frames lost. Pictures are of
/// the first method and seed. [Andrade-Cetto 2005, Fig. 13]
///
/// # Errors
/// Returns an error if a tracker cannot begin or refuses a frame, or a picture not be drawn.
pub fn table(
    film: &SyntheticFilm,
    seeds: Range<u64>,
    methods: &[TrackingMethod],
    params: &TrackParams,
) -> Result<ReportRun> {
    let shown = seeds.start;
    let one = |seed: u64| -> Result<(Vec<FilmTrackingScore>, TrackRunHistory, Vec<Duration>)> {
        let (mut run_history, mut steps) = (TrackRunHistory::default(), Vec::new());
        let scores = follow(&SyntheticFilm { seed, ..*film }, methods, params, |frame| {
            steps.push(frame.step);
            if seed == shown { Ok(run_history.observe(frame)?) } else { Ok(()) }
        })?;
        Ok((scores, run_history, steps))
    };
    let runs = seeds.into_par_iter().map(one).collect::<Result<Vec<_>>>()?;
    let mut metrics = Vec::new();
    for (k, method) in methods.iter().enumerate() {
        let scores: Vec<&FilmTrackingScore> = runs.iter().map(|(scores, ..)| &scores[k]).collect();
        let prefix = method.name().replace('-', "_");
        let of_method = over_seeds(&scores, film.occlusion).into_iter();
        metrics.extend(of_method.map(|metric| prefixed(&prefix, metric)));
    }
    let mut steps: Vec<Duration> = runs.iter().flat_map(|(.., steps)| steps).copied().collect();
    steps.sort_unstable();
    let median = steps.get(steps.len() / 2).map_or(f64::NAN, |step| 1e3 * step.as_secs_f64());
    let timings = vec![Metric::new("frame_median_ms", median, "ms")];
    let figures = runs.first().map(|(_, run_history, _)| plots(run_history)).transpose()?.unwrap_or_default();
    let notes =
        vec![format!("{} seeds; the pictures are of seed {shown} and {}.", runs.len(), methods[0].name())];
    Ok(ReportRun { metrics, timings, figures, notes, ..ReportRun::default() })
}

/// With the name of what it is about before its own.
pub(super) fn prefixed(prefix: &str, metric: Metric) -> Metric {
    Metric { name: format!("{prefix}_{}", metric.name), ..metric }
}

pub(super) fn over_seeds(scores: &[&FilmTrackingScore], occlusion: OcclusionEvent) -> Vec<Metric> {
    let all = |values: fn(&FilmTrackingScore) -> &Vec<f64>| -> Vec<f64> {
        scores.iter().flat_map(|score| values(score)).copied().collect()
    };
    let ious: Vec<f64> = scores.iter().map(|score| mean(&score.iou)).collect();
    let sum = |count: fn(&FilmTrackingScore) -> usize| {
        scores.iter().map(|score| count(score)).sum::<usize>() as f64
    };
    let spread = MeanInterval::of(&ious)
        .map(|MeanInterval { half_width, n, .. }| ConfidenceInterval { half_width, n });
    let mut metrics = vec![
        Metric { spread, ..Metric::new("iou_mean", mean(&ious), "") },
        Metric::new("iou_mean_of_worst_seed", ious.iter().copied().fold(f64::INFINITY, f64::min), ""),
        Metric::new("n_frames_lost", sum(|score| score.n_lost), ""),
    ];
    let mut status = LostStatusScore::default();
    scores.iter().for_each(|score| status.merge(&score.status));
    metrics.push(Metric::new("false_tracked_share", status.false_tracked_share(), ""));
    metrics.push(Metric::new("false_lost_share", status.false_lost_share(), ""));
    // A tracker that loses the target at once has no centre.
    let centers = all(|score| &score.center_error);
    if !centers.is_empty() {
        metrics.push(Metric::new("center_error_mean_px", mean(&centers), "px"));
    }
    let necks = all(|score| &score.distractor_share);
    if !necks.is_empty() {
        metrics.push(Metric::new("distractor_share_mean", mean(&necks), ""));
    }
    if occlusion != OcclusionEvent::None {
        let found = scores.iter().filter(|score| score.is_correct_at_end(N_END)).count();
        metrics.push(Metric::new("reacquired_share", found as f64 / scores.len() as f64, ""));
    }
    let n_hidden = sum(|score| score.n_hidden);
    if n_hidden > 0.0 {
        let share = sum(|score| score.n_hidden_and_lost) / n_hidden;
        metrics.push(Metric::new("lost_detection_recall", share, ""));
    }
    metrics
}
