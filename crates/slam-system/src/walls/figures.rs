use wayfix_estimation_traits::{LieGroup, wrap_angle};
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_sensor_log::{PoseRelation, Stamp};

use super::WallRun;
use crate::slam::{StampedEstimate, summary};

/// The figures and events of a run, ready for the report.
pub fn summarize(run: &mut WallRun) -> ReportRun {
    let mut of_map = Vec::new();
    if let Some((_, last)) = run.samples().last() {
        of_map.push(Metric::new("end_position_error_m", last.position_error(), "m"));
    }
    of_map.extend(wall_metrics(&run.wall_nees()));
    summary(run, of_map)
}

/// How many walls of the map are walls of the world, and which share of them is within two standard deviations (in two dimensions: the ellipse
/// of 95.45 %).
fn wall_metrics(nees: &[f64]) -> Vec<Metric> {
    const TWO_SIGMA: f64 = 6.18; // chi-squared quantile, two degrees of freedom
    if nees.is_empty() {
        return Vec::new();
    }
    let n_within = nees.iter().filter(|nees| **nees <= TWO_SIGMA).count();
    vec![
        Metric::new("n_true_walls_found", nees.len() as f64, ""),
        Metric::new("walls_within_2_sigma_share", n_within as f64 / nees.len() as f64, ""),
    ]
}

/// How well the path keeps relations between poses that are known from elsewhere: the mean translational and rotational error, and the
/// same of dead reckoning. [Kümmerle et al. 2009, Eq. 2]
///
/// Relations count whose stamps both have a estimate within 10 ms.
pub fn relation_metrics(run: &WallRun, relations: &[PoseRelation]) -> Vec<Metric> {
    let stamped_estimates = run.system.stamped_estimates();
    let pairs: Vec<(&PoseRelation, &StampedEstimate, &StampedEstimate)> = relations
        .iter()
        .filter_map(|relation| {
            Some((relation, near(stamped_estimates, relation.from)?, near(stamped_estimates, relation.to)?))
        })
        .collect();
    if pairs.is_empty() {
        return Vec::new();
    }
    let mean = |error: &dyn Fn(&(&PoseRelation, &StampedEstimate, &StampedEstimate)) -> f64| {
        pairs.iter().map(error).sum::<f64>() / pairs.len() as f64
    };
    let translation = mean(&|(relation, from, to)| {
        (from.pose.inverse().compose(&to.pose).translation - relation.pose.translation).norm()
    });
    let rotation = mean(&|(relation, from, to)| {
        wrap_angle(from.pose.inverse().compose(&to.pose).heading() - relation.pose.heading()).abs()
    });
    let reckoned = mean(&|(relation, from, to)| {
        let moved = from.dead_reckoning.inverse().compose(&to.dead_reckoning);
        (moved.translation - relation.pose.translation).norm()
    });
    vec![
        Metric::new("pose_relation_translation_error_mean_m", translation, "m"),
        Metric::new("pose_relation_rotation_error_mean_deg", rotation.to_degrees(), "°"),
        Metric::new("pose_relation_dead_reckoning_error_mean_m", reckoned, "m"),
        Metric::new("n_pose_relations", pairs.len() as f64, ""),
    ]
}

/// The estimate nearest in time, when it is within 10 ms.
fn near(stamped_estimates: &[StampedEstimate], stamp: Stamp) -> Option<&StampedEstimate> {
    const LONGEST_WAIT: f64 = 0.01;
    let distance = |stamped_estimate: &StampedEstimate| stamped_estimate.stamp.seconds_since(stamp).abs();
    let after = stamped_estimates.partition_point(|stamped_estimate| stamped_estimate.stamp < stamp);
    let neighbours =
        stamped_estimates[after.saturating_sub(1)..stamped_estimates.len().min(after + 1)].iter();
    neighbours
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .filter(|stamped_estimate| distance(stamped_estimate) <= LONGEST_WAIT)
}
