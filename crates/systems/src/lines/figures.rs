use super::{LineExtractionSystem, WallScore};
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_system_core::System;

/// Figures and events of a run for the report.
pub fn summarize(system: &mut LineExtractionSystem) -> ReportRun {
    let totals = system.totals.clone();
    let n_used = totals.n_used as f64;
    let mut metrics = vec![
        Metric::new("n_scans", system.n_scans() as f64, ""),
        Metric::new("n_skipped", system.n_scans() as f64 - n_used, ""),
    ];
    if n_used > 0.0 {
        metrics.push(Metric::new("segments_mean", totals.n_segments as f64 / n_used, ""));
    }
    metrics.extend(totals.residual_rms().map(|rms| Metric::new("residual_rms_m", rms, "m")));
    metrics.extend(totals.score().into_iter().flat_map(beside_truth));
    let seconds = totals.time.as_secs_f64();
    let mut timings = Vec::new();
    if seconds > 0.0 {
        timings.push(Metric::new("scan_mean_us", 1e6 * seconds / n_used, "µs"));
        timings.push(Metric::new("scans_per_second", n_used / seconds, "Hz"));
    }
    ReportRun { metrics, timings, events: system.events().counts(), ..ReportRun::default() }
}

fn beside_truth(score: WallScore) -> Vec<Metric> {
    let WallScore { n_true, n_false, n_within_2_sigma, squared_sum, n_visible, n_missed } = score;
    let share = |n: usize, of: usize| if of > 0 { n as f64 / of as f64 } else { f64::NAN };
    vec![
        Metric::new("extracted_walls_within_2_sigma_share", share(n_within_2_sigma, n_true), ""),
        Metric::new("nees_mean", squared_sum / n_true as f64, ""),
        Metric::new("false_wall_share", share(n_false, n_true + n_false), ""),
        Metric::new("found_wall_share", share(n_visible - n_missed, n_visible), ""),
    ]
}
