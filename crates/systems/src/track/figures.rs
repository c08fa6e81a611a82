use std::time::Duration;

use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_system_core::System;

use super::TrackRun;

/// Figures and events of a run for the report.
pub fn summarize(run: &mut TrackRun) -> ReportRun {
    let (score, totals) = (run.system.score(), *run.system.totals());
    let judged = [
        ("iou_mean", score.iou_mean(), ""),
        ("success_auc", score.success_auc(), ""),
        ("precision_20px", score.precision(), ""),
        ("center_error_mean_px", score.center_error_mean(), "px"),
    ];
    let mut metrics: Vec<Metric> =
        judged.into_iter().filter_map(|(name, value, unit)| Some(Metric::new(name, value?, unit))).collect();
    if score.n_frames() > 0 {
        let status = run.system.status_score();
        metrics.extend([
            Metric::new("false_tracked_share", status.false_tracked_share(), ""),
            Metric::new("false_lost_share", status.false_lost_share(), ""),
            Metric::new("n_frames_with_truth", score.n_frames() as f64, ""),
        ]);
    }
    metrics.extend([
        Metric::new("n_frames", run.system.n_frames() as f64, ""),
        Metric::new("n_lost", totals.n_lost as f64, ""),
        Metric::new("n_frames_without_estimate", totals.n_frames_without_estimate as f64, ""),
    ]);
    if let Some((frame, iou)) = run.system.detected() {
        metrics.push(Metric::new("n_frames_until_detection", frame as f64, ""));
        metrics.extend(iou.map(|iou| Metric::new("first_box_iou", iou, "")));
    }
    let ms = |time: Duration| 1e3 * time.as_secs_f64();
    let timings = vec![
        Metric::new("frame_mean_ms", ms(totals.time) / totals.n_steps.max(1) as f64, "ms"),
        Metric::new("frame_max_ms", ms(totals.longest), "ms"),
    ];
    let notes = coverage(run.system.truth().len(), run.system.n_frames()).into_iter().collect();
    ReportRun { metrics, timings, events: run.system.events().counts(), notes, ..ReportRun::default() }
}

/// A note if the list of true boxes has another length than the sequence.
fn coverage(n_true: usize, n_frames: usize) -> Option<String> {
    match n_true {
        0 => None,
        n if n < n_frames => {
            Some(format!("The truth covers {n} of {n_frames} frames; the others are not scored."))
        }
        n if n > n_frames => Some(format!("The truth has {n} frames, but there are {n_frames}.")),
        _ => None,
    }
}
