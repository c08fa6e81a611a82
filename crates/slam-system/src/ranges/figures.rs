use std::collections::BTreeMap;

use nalgebra::Vector2;
use wayfix_evaluation::{
    errors::{LandmarkCorrespondence, align, landmark_errors},
    plot::{EstimatedLandmark, MapPlot, PlotError, SvgPlot},
    report::{Metric, ReportRun},
};

use super::RangeRun;
use crate::slam::{path_metrics, path_plots, timings};

/// The figures and events of a run, ready for the report.
pub fn summarize(run: &RangeRun) -> ReportRun {
    let samples = run.samples();
    let mut metrics = path_metrics(&samples, run.truth.is_estimate());
    let of_path =
        align(samples.iter().map(|(_, sample)| (sample.estimate.translation, sample.truth.translation)));
    let beacons: BTreeMap<u32, Vector2<f64>> =
        run.estimate.beacons.iter().map(|(id, (place, _))| (*id, *place)).collect();
    let errors = landmark_errors(&beacons, &run.true_beacons, LandmarkCorrespondence::ById, &of_path);
    if let Some((rmse, aligned)) = errors.filter(|_| !samples.is_empty()) {
        metrics.push(Metric::new("landmark_rmse_m", rmse, "m"));
        metrics.push(Metric::new("landmark_aligned_rmse_m", aligned, "m"));
    }
    metrics.push(Metric::new("n_landmarks", beacons.len() as f64, ""));
    let n_unused = ["observation_unusable", "record_before_start", "record_after_odometry"];
    let n_rejected: u64 = n_unused.iter().map(|name| run.events.get(name)).sum();
    metrics.push(Metric::new("n_rejected", n_rejected as f64, ""));
    metrics.push(Metric::new("range_bias_m", run.estimate.calibration.bias, "m"));
    metrics.push(Metric::new("range_scale", run.estimate.calibration.log_scale.exp(), ""));
    metrics.push(Metric::new("range_sigma_m", run.estimate.range_sigma, "m"));
    let notes = vec!["A batch over the whole log: each pose uses all measurements. Step times are the batch's, spread over the poses.".to_owned()];
    let longest = run.stamped_estimates.iter().map(|at| at.step).max().unwrap_or_default();
    let timings = timings(&run.stamped_estimates, longest);
    ReportRun { metrics, timings, notes, events: run.events.counts(), ..ReportRun::default() }
}

/// Path and beacons, errors with their 3σ bands and NEES where there is truth.
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(run: &RangeRun) -> Result<Vec<SvgPlot>, PlotError> {
    let beacon = |(position, covariance): &(Vector2<f64>, nalgebra::Matrix2<f64>)| EstimatedLandmark {
        position: (position.x, position.y),
        covariance: covariance.transpose().into(),
    };
    let map = MapPlot {
        title: "Path and beacons with 2σ ellipses".to_owned(),
        landmarks: run.estimate.beacons.values().map(beacon).collect(),
        true_landmarks: run.true_beacons.values().map(|position| (position.x, position.y)).collect(),
        ..MapPlot::default()
    };
    path_plots(&run.samples(), &run.stamped_estimates, map, !run.truth.is_estimate())
}
