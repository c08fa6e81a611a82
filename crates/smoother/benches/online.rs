//! A planar pose graph edge by edge: `cargo bench -p wayfix-smoother --bench online -- [FILE.g2o[.gz]]`.
//!
//! Without a file `pose_graphs/manhattan.g2o.gz` of the folder WAYFIX_DATA. Each edge is added to the graph of all edges before it, and the graph is optimized.
//! Prints median, 99th percentile and largest computing time of a step, and the cost at the end beside that of the batch.

#![allow(clippy::unwrap_used, missing_docs)]

use std::{env, fs, io::BufReader, path::PathBuf};

use flate2::bufread::MultiGzDecoder;
use nalgebra::Matrix3;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_smoother::{
    Between, Graph, Params, VariableId,
    g2o::{self, G2o, PoseGraph, Repair},
};

fn main() {
    let given = env::args().skip(1).find(|argument| !argument.starts_with("--")).map(PathBuf::from);
    let stored = || Some(PathBuf::from(env::var_os("WAYFIX_DATA")?).join("pose_graphs/manhattan.g2o.gz"));
    let Some(file) = given.or_else(stored) else { return println!("no file, and WAYFIX_DATA is not set") };
    let reader = BufReader::new(fs::File::open(&file).unwrap());
    let is_compressed = file.extension().is_some_and(|extension| extension == "gz");
    let read = if is_compressed {
        g2o::read(BufReader::new(MultiGzDecoder::new(reader)))
    } else {
        g2o::read(reader)
    };
    let Ok(G2o::Planar(graph)) = read else { return println!("{}: no planar pose graph", file.display()) };

    let mut batch = graph.problem(Repair::Refuse).unwrap();
    batch.start_linearly(&graph).unwrap();
    let of_batch = batch.graph.optimize(&Params::default()).unwrap().cost;
    let (mut steps, of_replay) = replay(&graph);
    steps.sort_by(f64::total_cmp);
    let quantile = |share: f64| steps[((steps.len() - 1) as f64 * share) as usize];
    println!(
        "{}: {} steps, median {:.2} ms, 99 % {:.2} ms, largest {:.2} ms, sum {:.1} s",
        file.display(),
        steps.len(),
        quantile(0.5),
        quantile(0.99),
        quantile(1.0),
        steps.iter().sum::<f64>() * 1e-3
    );
    println!("cost {of_replay:.9e}, batch {of_batch:.9e}, relative {:.1e}", of_replay / of_batch - 1.0);
}

/// Computing time of each step, ms, and the cost at the end.
fn replay(file: &PoseGraph<Pose2<f64>>) -> (Vec<f64>, f64) {
    let mut edges: Vec<_> = file.edges.iter().collect();
    edges.sort_by_key(|edge| (edge.from.max(edge.to), edge.from.abs_diff(edge.to)));
    let mut graph = Graph::new();
    let mut poses: Vec<Option<VariableId<Pose2<f64>>>> = vec![None; file.poses.len()];
    let first = graph.add_variable(file.poses[0].1);
    graph.fix(first).unwrap();
    poses[0] = Some(first);
    let mut steps = Vec::with_capacity(edges.len());
    for edge in edges {
        let begin = computing_ms();
        let at = |id: Option<VariableId<Pose2<f64>>>| id.map(|id| *graph.value(id).unwrap());
        let new = match (at(poses[edge.from]), at(poses[edge.to])) {
            (Some(from), None) => Some((edge.to, from.compose(&edge.measured))),
            (None, Some(to)) => Some((edge.from, to.compose(&edge.measured.inverse()))),
            _ => None,
        };
        if let Some((place, value)) = new {
            poses[place] = Some(graph.add_variable(value));
        }
        let ids = (poses[edge.from].unwrap(), poses[edge.to].unwrap());
        let information = Matrix3::from_iterator(edge.information.iter().copied());
        graph.add(Between::new(edge.measured), ids, information).unwrap();
        graph.optimize(&Params::default()).unwrap();
        steps.push(computing_ms() - begin);
    }
    (steps, graph.cost())
}

/// Time that this thread has computed, in milliseconds, whatever else the machine does.
fn computing_ms() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 * 1e3 + time.tv_nsec as f64 * 1e-6
}
