use std::{
    collections::BTreeMap,
    fs::{self, File},
    io::{BufWriter, Write},
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result, anyhow, ensure};
use flate2::{Compression, write::GzEncoder};
use wayfix_evaluation::{
    plot::{MapPlot, SvgPlot},
    report::{FullReport, MachineInfo, Metric, ReportRun, ReportSuite, RunSummary, table, table::TableStyle},
    terminal::{print, print_message},
};
use wayfix_sensor_log::read_text;
use wayfix_smoother::{
    Kernel, Method, Params, Stop,
    g2o::{self, G2o, G2oError, PoseGraph, Repair, RigidPose},
};
use wayfix_system_core::Stopwatch;

use super::outputs::create_folder;

/// Optimize a pose graph in the format of g2o: the poses that fit the measurements best.
///
/// The cost is Σ eᵀΩe over all edges, with e the logarithm in SE(2) or SE(3) of the difference between measurement and poses, and Ω the
/// information matrix of the edge. If the model is right, it is about the number of residuals of all edges minus the number of unknowns.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct Arguments {
    /// The graph: a .g2o file of 2-d or 3-d poses and landmarks; may be compressed with gzip.
    graph: PathBuf,
    /// Write the optimized graph to this file, as g2o text; compressed where the name ends with `.gz`.
    #[arg(long, value_name = "FILE")]
    graph_out: Option<PathBuf>,
    /// Folder for index.html, report.json and pictures before and after.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object instead of a table: `{"metrics": {name: number}, "events": {name: count}, "seed": n}`.
    #[arg(long)]
    json: bool,
    /// Start of the optimization: the poses of the file, or a linear solution for rotations and then positions, which does not depend on them
    /// [default: linear; with --kernel: file, since a wrong loop closure has its whole weight in the linear solution].
    #[arg(long, value_enum)]
    start: Option<Start>,
    /// Method of the optimization steps.
    #[arg(long, value_enum, default_value_t = StepMethod::LevenbergMarquardt)]
    method: StepMethod,
    /// Robust kernel: limits the weight of loop closures with a larger residual than 99 % of correct ones. Loop closures are edges between
    /// poses that do not follow each other.
    #[arg(long, value_enum)]
    kernel: Option<KernelName>,
    /// Maximum number of iterations.
    #[arg(long, value_name = "N", default_value_t = Params::default().max_iterations)]
    max_iterations: usize,
    /// A fixed vertex, in addition to those of FIX lines; may be repeated [default: the first pose, if the file fixes none].
    #[arg(long, value_name = "ID")]
    fix: Vec<u64>,
    /// Set negative eigenvalues of information matrices to 0 instead of refusing them.
    #[arg(long)]
    repair: bool,
}

#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Start {
    File,
    Linear,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum StepMethod {
    GaussNewton,
    LevenbergMarquardt,
    Dogleg,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum KernelName {
    Huber,
    Cauchy,
    /// From a convex start: graduated non-convexity.
    GemanMcclure,
}

impl KernelName {
    fn kernel(self, n_rows: usize) -> Kernel {
        // Square root of the 99 % quantile of χ² with 3 and 6 degrees of freedom.
        let c = if n_rows == 3 { 3.368 } else { 4.100 };
        match self {
            Self::Huber => Kernel::Huber { k: c },
            Self::Cauchy => Kernel::Cauchy { c },
            Self::GemanMcclure => Kernel::GemanMcClure { c },
        }
    }
}

/// Two costs that differ less, absolutely or relatively, are those of one minimum.
const SAME_COST: f64 = 1e-6;

const EXAMPLES: &str = "\
Lines of the file:
  VERTEX_SE2 id x y θ                              EDGE_SE2 i j x y θ I11 I12 I13 I22 I23 I33
  VERTEX_SE3:QUAT id x y z qx qy qz qw             EDGE_SE3:QUAT i j x y z qx qy qz qw I11 I12 … I66
  VERTEX_XY id x y                                 EDGE_SE2_XY i j x y I11 I12 I22
  VERTEX_TRACKXYZ id x y z                         EDGE_SE3_TRACKXYZ i j sensor x y z I11 … I33
  FIX id …                                         PARAMS_SE3OFFSET sensor x y z qx qy qz qw
Without VERTEX lines the poses come from dead reckoning along the edges.

Figures:
  start_cost   cost at the poses of the file      cost         cost at the end
  iterations   linearizations                     time_ms      start and optimization, without reading and building the graph
  factorization_gflop   10⁹ additions and multiplications of the sparse Cholesky factorization in each iteration

Examples:
  wayfix optimize manhattan.g2o.gz
  wayfix optimize torus3D.g2o --graph-out torus3D-optimized.g2o --out results
  wayfix optimize with-wrong-closures.g2o --kernel geman-mcclure
  wayfix optimize two-floors.g2o --fix 0 --fix 1000
  wayfix optimize cubicle.g2o.gz --repair --json";

pub(super) fn main(arguments: Arguments) -> Result<ExitCode> {
    let path = &arguments.graph;
    ensure!(!path.is_dir(), "{} is a folder; give a graph, a .g2o file", path.display());
    arguments.out.as_deref().map_or(Ok(()), create_folder)?;
    let text = read_text(path)?;
    let file = g2o::read(text.as_bytes()).with_context(|| path.display().to_string())?;
    drop(text);
    match file {
        G2o::Planar(graph) => optimize(graph, &arguments),
        G2o::Spatial(graph) => optimize(graph, &arguments),
    }
}

fn optimize<P: RigidPose>(mut file: PoseGraph<P>, arguments: &Arguments) -> Result<ExitCode> {
    let name = arguments.graph.display().to_string();
    let mut warnings = Vec::new();
    for id in &arguments.fix {
        let is_there = file.poses.iter().any(|(known, _)| known == id)
            || file.points.iter().any(|(known, _)| known == id);
        ensure!(is_there, "{name}: there is no vertex {id} to fix");
    }
    file.fixed.extend(&arguments.fix);
    if let (true, Some((id, _))) = (file.fixed.is_empty(), file.poses.first()) {
        warnings.push(format!("no vertex is fixed: vertex {id} stays where it is"));
    }
    if file.is_dead_reckoned {
        warnings.push("no VERTEX lines: the start is dead reckoning".to_owned());
    }
    let repair = if arguments.repair { Repair::ClipEigenvalues } else { Repair::Refuse };
    let mut problem = file.problem(repair).map_err(|error| match error {
        G2oError::Indefinite { .. } => anyhow!("{name}: {error}; --repair does that"),
        other => anyhow!(other).context(name.clone()),
    })?;
    if problem.n_repaired > 0 {
        let n = problem.n_repaired;
        warnings.push(format!(
            "{n} information matrices are indefinite: their negative eigenvalues are set to 0"
        ));
    }
    if let Some(name) = arguments.kernel {
        let edges = file.edges.iter().zip(&problem.edges);
        for (_, id) in edges.filter(|(edge, _)| edge.from.abs_diff(edge.to) != 1) {
            problem.graph.set_kernel(*id, name.kernel(P::COORDINATES.len()))?;
        }
    }
    let start_cost = problem.graph.cost();
    let params = Params {
        method: match arguments.method {
            StepMethod::GaussNewton => Method::GaussNewton,
            StepMethod::LevenbergMarquardt => Method::LevenbergMarquardt,
            StepMethod::Dogleg => Method::Dogleg,
        },
        max_iterations: arguments.max_iterations,
        graduated: matches!(arguments.kernel, Some(KernelName::GemanMcclure)),
        ..Params::default()
    };

    let stopwatch = Stopwatch::start();
    let default = if arguments.kernel.is_some() { Start::File } else { Start::Linear };
    let is_linear_wanted = arguments.start.unwrap_or(default) == Start::Linear;
    let is_linear = is_linear_wanted && problem.start_linearly(&file)?;
    let result = problem.graph.optimize(&params);
    let seconds = stopwatch.elapsed().as_secs_f64();
    let summary = result.map_err(|error| problem.named(&file, error)).with_context(|| name.clone())?;
    let is_cut = summary.stop == Stop::IterationLimit;
    if is_cut {
        warnings.push(format!("not converged after {} iterations", summary.iterations));
    }
    if !is_cut && summary.cost - start_cost > SAME_COST * (1.0 + start_cost) {
        warnings.push(format!(
            "the cost at the end, {:.6}, is higher than that of the poses of the file, {start_cost:.6}: there is a better minimum (try another --start or --kernel)",
            summary.cost
        ));
    }
    if !is_linear && is_linear_wanted {
        warnings.push("there is no linear start: edges between poses do not reach all of them".to_owned());
    }

    let before = picture(&file, format!("Before: cost {start_cost:.6}"));
    problem.store(&mut file)?;
    let run = ReportRun {
        name,
        metrics: vec![
            Metric::new("cost", summary.cost, ""),
            Metric::new("start_cost", start_cost, ""),
            Metric::new("iterations", summary.iterations as f64, ""),
            Metric::new("factorization_gflop", summary.factorization_flop * 1e-9, "GFLOP"),
            Metric::new("n_poses", file.poses.len() as f64, ""),
            Metric::new("n_landmarks", file.points.len() as f64, ""),
            Metric::new("n_edges", (file.edges.len() + file.point_edges.len()) as f64, ""),
        ],
        seconds,
        timings: vec![Metric::new("time_ms", seconds * 1e3, "ms")],
        events: BTreeMap::from([
            ("repaired_information".to_owned(), problem.n_repaired as u64),
            ("not_converged".to_owned(), u64::from(is_cut)),
        ]),
        warnings,
        ..ReportRun::default()
    };
    if let Some(path) = &arguments.graph_out {
        write_graph(&file, path).with_context(|| format!("cannot write {}", path.display()))?;
    }
    let after = picture(&file, format!("After: cost {:.6}", summary.cost));
    show(run, arguments, [before, after])?;
    Ok(ExitCode::SUCCESS)
}

fn write_graph<P: RigidPose>(file: &PoseGraph<P>, path: &Path) -> Result<()> {
    let to = BufWriter::new(File::create(path)?);
    if path.extension().is_some_and(|extension| extension == "gz") {
        let mut packed = GzEncoder::new(to, Compression::default());
        file.write(&mut packed)?;
        packed.finish()?.flush()?;
    } else {
        file.write(to)?;
    }
    Ok(())
}

/// Poses in the order of the file, with the edges that close loops beneath.
fn picture<P: RigidPose>(file: &PoseGraph<P>, title: String) -> MapPlot {
    let at = |pose: &P| {
        let position = pose.translation_part();
        (position.x, position.y)
    };
    let closures = file.edges.iter().filter(|edge| edge.from.abs_diff(edge.to) != 1);
    let ends = |edge: &g2o::Edge<P>| vec![at(&file.poses[edge.from].1), at(&file.poses[edge.to].1)];
    let landmark = |point: &P::Point| {
        let coordinates = P::coordinates(point);
        (coordinates[0], coordinates[1])
    };
    MapPlot {
        title,
        estimate: file.poses.iter().map(|(_, pose)| at(pose)).collect(),
        surroundings: closures.map(ends).collect(),
        references: file.points.iter().map(|(_, point)| landmark(point)).collect(),
        ..MapPlot::default()
    }
}

fn show(mut run: ReportRun, arguments: &Arguments, maps: [MapPlot; 2]) -> Result<()> {
    for warning in &run.warnings {
        print_message(format!("note: {warning}"));
    }
    let figures = if arguments.json {
        serde_json::to_string(&RunSummary::new(&run, 0))? + "\n"
    } else {
        table::run(&run, TableStyle::of_stdout())
    };
    if let Some(out) = &arguments.out {
        run.figures = maps.iter().map(MapPlot::draw).collect::<Result<Vec<SvgPlot>, _>>()?;
        write_report(out, run)?;
    }
    print(figures)?;
    Ok(())
}

fn write_report(out: &Path, run: ReportRun) -> Result<()> {
    for (name, figure) in ["before.svg", "after.svg"].iter().zip(&run.figures) {
        let path = out.join(name);
        fs::write(&path, figure.standalone()).with_context(|| format!("cannot write {}", path.display()))?;
    }
    let suites = vec![ReportSuite { name: "optimize".to_owned(), runs: vec![run] }];
    FullReport { suites, seed: 0, commit: None, machine: MachineInfo::detect(), pending: Vec::new() }
        .write(out)?;
    print_message(format!("wrote index.html, report.json, before.svg and after.svg to {}", out.display()));
    Ok(())
}
