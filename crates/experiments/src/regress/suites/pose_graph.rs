//! Pose graphs through the smoother.

use std::path::Path;

use anyhow::Result;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_sensor_log::read_text;
use wayfix_smoother::{
    Params,
    g2o::{self, G2o, PoseGraph, Repair, RigidPose},
};
use wayfix_system_core::Stopwatch;

/// Whether the name of a file is that of a pose graph, packed or not.
pub(super) fn is_named(file: &Path) -> bool {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.ends_with(".g2o") || name.ends_with(".g2o.gz")
}

/// The minimum from the linear start.
pub(super) fn run(file: &Path) -> Result<ReportRun> {
    match g2o::read(read_text(file)?.as_bytes())? {
        G2o::Planar(graph) => minimum(&graph),
        G2o::Spatial(graph) => minimum(&graph),
    }
}

fn minimum<P: RigidPose>(graph: &PoseGraph<P>) -> Result<ReportRun> {
    let mut problem = graph.problem(Repair::Refuse)?;
    let start_cost = problem.graph.cost();
    let stopwatch = Stopwatch::start();
    problem.start_linearly(graph)?;
    let summary = problem.graph.optimize(&Params::default())?;
    Ok(ReportRun {
        metrics: vec![
            Metric::new("cost", summary.cost, ""),
            Metric::new("start_cost", start_cost, ""),
            Metric::new("iterations", summary.iterations as f64, ""),
        ],
        timings: vec![Metric::new("time_ms", stopwatch.elapsed().as_secs_f64() * 1e3, "ms")],
        ..ReportRun::default()
    })
}
