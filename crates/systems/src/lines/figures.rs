use wayfix_line_extract::WallSegment;

use super::{LineExtractionSystem, WallScore};
use crate::system::System;
use wayfix_evaluation::report::{Metric, ReportRun};

/// Figures and events of a run for the report. Names follow the contract of `docs/architecture.md`.
pub fn summarize(system: &mut LineExtractionSystem) -> ReportRun {
    let n_used = system.scans().len() as f64;
    let segments = || system.scans().iter().flat_map(|scan| &scan.segments);
    let mut metrics = vec![
        Metric::new("n_scans", system.n_scans() as f64, ""),
        Metric::new("n_skipped", system.n_scans() as f64 - n_used, ""),
    ];
    if n_used > 0.0 {
        metrics.push(Metric::new("segments_mean", segments().count() as f64 / n_used, ""));
    }
    metrics.extend(residual_rms(segments()).map(|rms| Metric::new("residual_rms_m", rms, "m")));
    metrics.extend(WallScore::of(system.scans(), system.true_walls()).into_iter().flat_map(beside_truth));
    let seconds: f64 = system.scans().iter().map(|scan| scan.step.as_secs_f64()).sum();
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

/// RMS distance of the echoes from the walls fitted to them, m.
fn residual_rms<'a>(segments: impl Iterator<Item = &'a WallSegment>) -> Option<f64> {
    let (sum, n_points) = segments.fold((0.0, 0.0), |(sum, n_points), segment| {
        let n = segment.n_points as f64;
        (sum + n * segment.rms_m.powi(2), n_points + n)
    });
    (n_points > 0.0).then(|| (sum / n_points).sqrt())
}
