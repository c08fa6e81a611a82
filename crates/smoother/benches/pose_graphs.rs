//! Public pose graphs from files: `cargo bench -p wayfix-smoother --bench pose_graphs -- FILE.g2o[.gz] …`.
//!
//! Without files those of `pose_graphs` in the folder WAYFIX_DATA. A line each: cost, iterations, and the median computing time of five runs for the
//! linear start and the optimization, ordering and symbolic factorization included, reading and building the graph not.
//!
//! The speed of an iteration counts the operations of its factorization only. The limit is the numeric factorization by faer alone, of a matrix with
//! the same blocks, in faer's own order.

#![allow(clippy::unwrap_used, missing_docs)]

use std::{
    env, fs,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
};

use faer::{
    Par, Side, Spec,
    dyn_stack::{MemBuffer, MemStack},
    linalg::cholesky::llt::factor::LltRegularization,
    sparse::{
        SparseColMatRef, SymbolicSparseColMat,
        linalg::cholesky::{
            CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
            factorize_symbolic_cholesky,
        },
    },
};
use flate2::bufread::MultiGzDecoder;
use wayfix_smoother::{
    Method, Params,
    g2o::{self, G2o, PoseGraph, Repair, RigidPose},
};

const N_RUNS: usize = 5;
/// Long against the ticks in which some systems count computing time.
const ALONE_MS: f64 = 200.0;

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
    match faer_alone(file) {
        Some((flop, ms)) => println!("{name:24} faer alone: {}", speed(flop, ms)),
        None => println!("{name:24} faer alone: out of memory"),
    }
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
                    "file {file_cost:.6e} start {:.6e} cost {:.9e} iterations {} {:?} (start {start_ms:.1} ms, iteration {})",
                    s.start_cost,
                    s.cost,
                    s.iterations,
                    s.stop,
                    speed(s.factorization_flop, (times[times.len() - 1] - start_ms) / s.iterations as f64)
                ),
                Err(error) => error.to_string(),
            };
        }
        times.sort_by(f64::total_cmp);
        println!("{name:24} {method:?}: {outcome} median {:.1} ms", times[N_RUNS / 2]);
    }
}

fn speed(flop: f64, ms: f64) -> String {
    format!("{ms:.1} ms, {:.4} GFLOP, {:.2} GFLOP/s", flop * 1e-9, flop * 1e-6 / ms)
}

/// Operations and mean computing time of a numeric factorization by faer, of a diagonally dominant matrix with the blocks of the graph.
fn faer_alone<P: RigidPose>(file: &PoseGraph<P>) -> Option<(f64, f64)> {
    let (dim, first_point) = (P::COORDINATES.len(), file.poses.len());
    let point_dim = file.points.first().map_or(0, |(_, point)| P::coordinates(point).len());
    let rows = |vertex: usize| match vertex.checked_sub(first_point) {
        None => dim * vertex..dim * (vertex + 1),
        Some(point) => {
            let first = dim * first_point + point_dim * point;
            first..first + point_dim
        }
    };
    let of_poses = file.edges.iter().map(|edge| (edge.from, edge.to));
    let of_points = file.point_edges.iter().map(|edge| (edge.from, first_point + edge.to));
    let n_vertices = first_point + file.points.len();
    let itself = (0..n_vertices).map(|vertex| (vertex, vertex));
    let mut entries: Vec<(usize, usize)> = of_poses
        .chain(of_points)
        .chain(itself)
        .map(|(a, b)| (a.min(b), a.max(b)))
        .flat_map(|(a, b)| rows(b).flat_map(move |column| rows(a).map(move |row| (column, row))))
        .filter(|(column, row)| row <= column)
        .collect();
    entries.sort_unstable();
    entries.dedup();
    let n = rows(n_vertices).start;
    let mut starts = vec![0; n + 1];
    entries.iter().for_each(|(column, _)| starts[column + 1] += 1);
    (0..n).for_each(|column| starts[column + 1] += starts[column]);
    let values: Vec<f64> = entries.iter().map(|(c, r)| if c == r { 1e6 } else { 1.0 }).collect();
    let rows = entries.into_iter().map(|(_, row)| row).collect();
    let pattern = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
    let symbolic = factorize_symbolic_cholesky(
        pattern.as_ref(),
        Side::Upper,
        SymmetricOrdering::Amd,
        CholeskySymbolicParams::default(),
    )
    .ok()?;
    let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
    let mut memory = MemBuffer::try_new(scratch).ok()?;
    let mut factor = vec![0.0; symbolic.len_val()];
    let (begin, mut n_factorizations) = (computing_ms(), 0);
    while computing_ms() - begin < ALONE_MS {
        let matrix = SparseColMatRef::new(pattern.as_ref(), &values);
        let stack = MemStack::new(&mut memory);
        let (regularization, params) = (LltRegularization::default(), Spec::default());
        symbolic
            .factorize_numeric_llt(&mut factor, matrix, Side::Upper, regularization, Par::Seq, stack, params)
            .unwrap();
        n_factorizations += 1;
    }
    Some((flop(&symbolic), (computing_ms() - begin) / f64::from(n_factorizations)))
}

/// The sum of the squared numbers of entries in the columns of the factor.
fn flop(symbolic: &SymbolicCholesky<usize>) -> f64 {
    let squares = |entries: &mut dyn Iterator<Item = usize>| entries.map(|n| (n * n) as f64).sum();
    match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(columns) => {
            squares(&mut columns.col_ptr().windows(2).map(|ends| ends[1] - ends[0]))
        }
        SymbolicCholeskyRaw::Supernodal(nodes) => {
            let below = nodes.col_ptr_for_row_idx();
            let ends = nodes.supernode_begin().iter().zip(nodes.supernode_end()).enumerate();
            squares(&mut ends.flat_map(|(node, (begin, end))| {
                (1..=end - begin).map(move |k| k + below[node + 1] - below[node])
            }))
        }
    }
}

/// Time that this thread has computed, in milliseconds, whatever else the machine does.
fn computing_ms() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 * 1e3 + time.tv_nsec as f64 * 1e-6
}
