use nalgebra::{Matrix2, Vector2, linalg::Cholesky};
use wayfix_estimation_traits::{LieGroup, Pose2, SensorModel};
use wayfix_evaluation::{
    errors::{align, landmark_errors, median_distance, rms_distance},
    report::{Metric, ReportRun},
};
use wayfix_slam_ekf::PositionSensor;

use super::PointRun;
use crate::slam::{FrontEnd, StampedEstimate, summary};

/// The figures and events of a run, ready for the report.
pub fn summarize(run: &mut PointRun) -> ReportRun {
    let mut of_map = position_metrics(run);
    let samples = run.samples();
    let of_path =
        align(samples.iter().map(|(_, sample)| (sample.estimate.translation, sample.truth.translation)));
    if let Some((rmse, aligned)) =
        landmark_errors(&run.landmarks(), &run.true_map, run.correspondence(), &of_path)
    {
        of_map.push(Metric::new("landmark_rmse_m", rmse, "m"));
        of_map.push(Metric::new("landmark_aligned_rmse_m", aligned, "m"));
    }
    summary(run, of_map)
}

/// Where the log has true positions of an antenna and no true poses.
fn position_metrics(run: &PointRun) -> Vec<Metric> {
    let positions = run.positions();
    if !run.samples().is_empty() || positions.is_empty() {
        return Vec::new();
    }
    let estimated = positions.iter().map(|(_, estimate, truth)| (*estimate, *truth));
    let reckoned = positions
        .iter()
        .map(|(stamped_estimate, _, truth)| (run.system.antenna(&stamped_estimate.dead_reckoning), *truth));
    let motion = align(estimated.clone());
    let mut metrics = Vec::new();
    let mut add = |name, value: Option<f64>| metrics.extend(value.map(|value| Metric::new(name, value, "m")));
    add("ate_rmse_m", rms_distance(estimated.clone(), &Pose2::identity()));
    add("ate_median_m", median_distance(estimated.clone(), &Pose2::identity()));
    add("ate_aligned_rmse_m", rms_distance(estimated.clone(), &motion));
    add("ate_aligned_median_m", median_distance(estimated, &motion));
    add("dead_reckoning_aligned_rmse_m", rms_distance(reckoned.clone(), &align(reckoned)));
    let batch = run.batch_positions();
    if !batch.is_empty() {
        let batch = batch.iter().copied();
        add("batch_ate_rmse_m", rms_distance(batch.clone(), &Pose2::identity()));
        add("batch_ate_aligned_rmse_m", rms_distance(batch.clone(), &align(batch)));
    }
    metrics.extend(position_nees(run).map(|nees| Metric::new("position_nees_mean", nees, "")));
    metrics
}

/// Mean NEES of the positions, 2 for a consistent filter; only if the parameters give the noise of the true positions.
fn position_nees(run: &PointRun) -> Option<f64> {
    let (external, antenna) = run.system.front_end.external();
    let truth = Matrix2::identity() * external.position_sigma?.powi(2);
    let nees = |(at, estimate, truth_at): &(StampedEstimate, Vector2<f64>, Vector2<f64>)| {
        let jacobian = PositionSensor { antenna, covariance: truth }.jacobian(&at.pose);
        let covariance = jacobian * at.covariance * jacobian.transpose() + truth;
        let error = truth_at - estimate;
        Some(error.dot(&Cholesky::new(covariance)?.solve(&error)))
    };
    let all: Option<Vec<f64>> = run.positions().iter().map(nees).collect();
    all.map(|all| all.iter().sum::<f64>() / all.len() as f64)
}
