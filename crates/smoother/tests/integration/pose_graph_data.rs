//! The public pose graphs in the folder `pose_graphs` of WAYFIX_DATA: the best known cost of each. Passes without that folder.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use approx::abs_diff_eq;
use std::{env, fs::File, io::BufReader, path::Path};

use flate2::bufread::MultiGzDecoder;
use wayfix_smoother::{
    Method, Params,
    g2o::{self, G2o, G2oError, PoseGraph, Repair, RigidPose},
};

/// Set, its best known cost with the digits that GTSAM from a linear start and published tables have, and cost of the file's start.
const BEST_KNOWN: [(&str, f64, f64); 11] = [
    ("smallGrid3D", 1035.85, 1.68e5),
    ("MIT", 41.207, 7.10e9),
    ("CSAIL", 40.5509, 2.14e6),
    ("intel", 45.0042, 554.0),
    ("manhattan", 3549.04, 2.70e10),
    ("kitti_00", 98.3221, 7.46e7),
    ("parking-garage", 1.268385, 1.67e4),
    ("sphere2500", 1351.40, 2.61e6),
    ("city10000", 511.987, 7.18e8),
    ("ais2klinik", 172.813, 1.31e6),
    ("torus3D", 24235.3, 4.80e6),
];

#[test]
fn every_set_reaches_its_best_known_cost() {
    for (set, best, start) in BEST_KNOWN {
        let Some(file) = read(set) else { return };
        for method in [Method::LevenbergMarquardt, Method::GaussNewton, Method::Dogleg] {
            let (file_cost, cost) = match file.as_ref().expect("the set is sound") {
                G2o::Planar(graph) => optimum(graph, method),
                G2o::Spatial(graph) => optimum(graph, method),
            };
            // Half a unit of the last of six digits, and 1e-6.
            assert!(
                abs_diff_eq!(cost / best, 1.0, epsilon = 1e-6 + 5e-6),
                "{set} by {method:?}: {cost}, best known {best}"
            );
            assert!(
                abs_diff_eq!(file_cost / start, 1.0, epsilon = 5e-3),
                "{set}: start {file_cost}, known {start}"
            );
        }
    }
}

#[test]
fn indefinite_matrices_of_cubicle_are_counted_and_repaired() {
    let Some(file) = read("cubicle") else { return };
    let Ok(G2o::Spatial(graph)) = file else { panic!("cubicle is in space") };
    let Err(G2oError::Indefinite { count, total, .. }) = graph.problem(Repair::Refuse) else {
        panic!("indefinite information must be refused")
    };
    assert_eq!((count, total), (5021, 16869));
    let mut problem = graph.problem(Repair::ClipEigenvalues).expect("repaired");
    assert_eq!(problem.n_repaired, 5021);
    problem.start_linearly(&graph).expect("fits into memory");
    let summary = problem.graph.optimize(&Params::default()).expect("positive semidefinite");
    assert!(summary.cost < summary.start_cost);
}

fn read(set: &str) -> Option<Result<G2o, G2oError>> {
    let data = env::var("WAYFIX_DATA").ok()?;
    let path = Path::new(&data).join("pose_graphs").join(format!("{set}.g2o.gz"));
    let file = File::open(path).ok()?;
    Some(g2o::read(BufReader::new(MultiGzDecoder::new(BufReader::new(file)))))
}

/// Cost at the start of the file and at the minimum.
fn optimum<P: RigidPose>(file: &PoseGraph<P>, method: Method) -> (f64, f64) {
    let mut problem = file.problem(Repair::Refuse).expect("positive definite");
    let file_cost = problem.graph.cost();
    assert!(problem.start_linearly(file).expect("fits into memory"), "connected");
    let summary = problem.graph.optimize(&Params { method, ..Params::default() }).expect("determined");
    (file_cost, summary.cost)
}
