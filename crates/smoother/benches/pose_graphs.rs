//! Public pose graphs from files: `cargo bench -p wayfix-smoother --bench pose_graphs -- FILE.g2o[.gz] …`.
//!
//! Without files those of `pose_graphs` in the folder WAYFIX_DATA. A line each: cost, iterations, and the median computing time of five runs for the
//! linear start and the optimization, ordering and symbolic factorization included, reading and building the graph not.

#![allow(clippy::unwrap_used, missing_docs)]

use std::{
    env, fs,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
};

use flate2::bufread::MultiGzDecoder;
use wayfix_smoother::{
    Method, Params,
    g2o::{self, G2o, PoseGraph, Repair, RigidPose},
};

const N_RUNS: usize = 5;

fn main() {
    let mut files: Vec<PathBuf> =
        env::args().skip(1).filter(|a| !a.starts_with("--")).map(PathBuf::from).collect();
    if files.is_empty() {
        let Ok(data) = env::var("WAYFIX_DATA") else {
            return println!("no files, and WAYFIX_DATA is not set");
        };
        let entries = fs::read_dir(Path::new(&data).join("pose_graphs")).unwrap();
        files = entries
            .map(|entry| entry.unwrap().path())
            .filter(|p| p.to_string_lossy().contains(".g2o"))
            .collect();
        files.sort();
    }
    for file in files {
        let reader = BufReader::new(fs::File::open(&file).unwrap());
        let reader: Box<dyn BufRead> = if file.extension().is_some_and(|e| e == "gz") {
            Box::new(BufReader::new(MultiGzDecoder::new(reader)))
        } else {
            Box::new(reader)
        };
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        match g2o::read(reader) {
            Ok(G2o::Planar(graph)) => measure(&name, &graph),
            Ok(G2o::Spatial(graph)) => measure(&name, &graph),
            Err(error) => println!("{name}: {error}"),
        }
    }
}

fn measure<P: RigidPose>(name: &str, file: &PoseGraph<P>) {
    for method in [Method::LevenbergMarquardt, Method::GaussNewton, Method::Dogleg] {
        let mut times = Vec::new();
        let mut outcome = String::new();
        for _ in 0..N_RUNS {
            let mut problem = match file.problem(Repair::Refuse) {
                Ok(problem) => problem,
                Err(error) => return println!("{name}: {error}"),
            };
            let file_cost = problem.graph.cost();
            let begin = computing_ms();
            problem.start_linearly(file).unwrap();
            let start_ms = computing_ms() - begin;
            let result = problem.graph.optimize(&Params { method, ..Params::default() });
            times.push(computing_ms() - begin);
            outcome = match result {
                Ok(s) => format!(
                    "file {file_cost:.6e} start {:.6e} cost {:.9e} iterations {} {:?} (start {start_ms:.1} ms)",
                    s.start_cost, s.cost, s.iterations, s.stop
                ),
                Err(error) => error.to_string(),
            };
        }
        times.sort_by(f64::total_cmp);
        println!("{name:24} {method:?}: {outcome} median {:.1} ms", times[N_RUNS / 2]);
    }
}

/// Time that this thread has computed, in milliseconds, whatever else the machine does.
fn computing_ms() -> f64 {
    let schedule = fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    schedule.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-6
}
