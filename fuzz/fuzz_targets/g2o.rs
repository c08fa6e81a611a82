//! The text of a pose graph: what is read can be written, read again, and optimized or refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use wayfix_smoother::{
    Params,
    g2o::{self, G2o, PoseGraph, Repair, RigidPose},
};

fuzz_target!(|input: &[u8]| {
    let Ok(graph) = g2o::read(input) else { return };
    let mut written = Vec::new();
    graph.write(&mut written).expect("memory takes everything");
    g2o::read(written.as_slice()).expect("what was written is read again");
    match graph {
        G2o::Planar(graph) => optimize(&graph),
        G2o::Spatial(graph) => optimize(&graph),
    }
});

fn optimize<P: RigidPose>(file: &PoseGraph<P>) {
    let Ok(mut problem) = file.problem(Repair::ClipEigenvalues) else { return };
    let Ok(_) = problem.start_linearly(file) else { return };
    match problem.graph.optimize(&Params { max_iterations: 5, ..Params::default() }) {
        Ok(summary) => assert!(summary.cost.is_finite()),
        Err(error) => assert!(!problem.named(file, error).to_string().is_empty()),
    }
}
