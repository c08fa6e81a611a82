//! The reader says what is wrong with a line, and the writer writes what was read.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use std::io::{BufReader, Read, Write};

use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_smoother::{
    Params,
    g2o::{self, G2o, G2oError, LineProblem, PoseGraph, Repair, RigidPose},
};

const PLANAR: &str = "# a square\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 1.5707963\n\nVERTEX_SE2 2 1 1 3.1415926\nVERTEX_XY 7 2 2\nFIX 1\n\
    EDGE_SE2 0 1 1 0 1.57 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 1.57 2 0.1 0 2 0 3\nEDGE_SE2 2 0 1 1 3.1 1 0 0 1 0 1\n\
    EDGE_SE2_XY 1 7 2 -1 1 0 1\nEDGE_SE2_XY 2 7 -1 -1 4 1 4\n";
const SPATIAL: &str = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0.7071068 0.7071068\nVERTEX_TRACKXYZ 5 1 2 3\n\
    PARAMS_SE3OFFSET 3 0.1 0.2 0.3 0 0 0.7071068 0.7071068\n\
    EDGE_SE3:QUAT 0 1 1 0 0.1 0 0 0.7 0.714 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n\
    EDGE_SE3_TRACKXYZ 1 5 3 1 2 3 2 0.5 0 1 0 1\n";

fn problem(text: &str) -> (usize, LineProblem) {
    match g2o::read(text.as_bytes()) {
        Err(G2oError::Line { line, problem }) => (line, problem),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn what_was_written_is_read_again() {
    for text in [PLANAR, SPATIAL] {
        let first = g2o::read(text.as_bytes()).unwrap();
        let mut written = Vec::new();
        first.write(&mut written).unwrap();
        let second = g2o::read(written.as_slice()).unwrap();
        let mut again = Vec::new();
        second.write(&mut again).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), String::from_utf8(again).unwrap());
    }
}

#[test]
fn landmarks_and_fixed_vertices_take_part() {
    let G2o::Planar(mut graph) = g2o::read(PLANAR.as_bytes()).unwrap() else { panic!("planar") };
    let mut problem = graph.problem(Repair::Refuse).unwrap();
    assert!(problem.start_linearly(&graph).unwrap());
    let summary = problem.graph.optimize(&Params::default()).unwrap();
    let before = graph.clone();
    problem.store(&mut graph).unwrap();
    assert_eq!(graph.poses[1], before.poses[1], "vertex 1 is fixed");
    assert!(graph.points[0] != before.points[0] && graph.poses[0] != before.poses[0]);
    assert!(summary.cost > 0.0 && summary.cost < 0.1, "{summary:?}");
}

#[test]
fn sensor_on_the_robot_is_taken_into_account() {
    let G2o::Spatial(graph) = g2o::read(SPATIAL.as_bytes()).unwrap() else { panic!("spatial") };
    // The sensor looks to the left: its x is the robot's y.
    let seen = graph.point_edges[0].measured;
    assert_abs_diff_eq!(seen, nalgebra::Vector3::new(0.1 - 2.0, 0.2 + 1.0, 3.3), epsilon = 1e-6);
    let information = &graph.point_edges[0].information;
    assert!(
        abs_diff_eq!(information[(1, 1)], 2.0, epsilon = 1e-6)
            && abs_diff_eq!(information[(0, 1)], -0.5, epsilon = 1e-6),
        "{information}"
    );
}

#[test]
fn graph_without_vertices_is_dead_reckoned() {
    let text = "EDGE_SE2 5 6 1 0 0 1 0 0 1 0 1\nEDGE_SE2 5 7 9 9 9 1 0 0 1 0 1\nEDGE_SE2 6 7 1 0 1 1 0 0 1 0 1\nEDGE_SE2_XY 7 9 1 0 1 0 1\n";
    let G2o::Planar(graph) = g2o::read(text.as_bytes()).unwrap() else { panic!("planar") };
    assert!(graph.is_dead_reckoned);
    let ids: Vec<_> = graph.poses.iter().map(|(id, _)| *id).collect();
    assert_eq!(ids, [5, 6, 7]);
    assert_abs_diff_eq!(graph.poses[2].1.x(), 2.0, epsilon = 1e-12);
    assert_abs_diff_eq!(graph.poses[2].1.heading(), 1.0, epsilon = 1e-12);
    assert_abs_diff_eq!(graph.points[0].1.x - 2.0, 1.0_f64.cos(), epsilon = 1e-12);
}

#[test]
fn each_bad_line_is_named() {
    let cases = [
        (
            "EDGE_SE2 0 1 1 0 0 1 0 0 1 0",
            LineProblem::Count { tag: "EDGE_SE2".into(), expected: 11, got: 10 },
        ),
        ("VERTEX_SE2 3 0 zero 0", LineProblem::NotANumber("zero".into())),
        ("VERTEX_SE2 3 0 nan 0", LineProblem::NotANumber("nan".into())),
        ("VERTEX_SE2 3 0 1e999 0", LineProblem::NotANumber("1e999".into())),
        ("VERTEX_SE2 -3 0 0 0", LineProblem::NotANumber("-3".into())),
        ("VERTEX_SE2 1 0 0 0", LineProblem::DuplicateVertex(1)),
        ("VERTEX_XY 1 0 0", LineProblem::DuplicateVertex(1)),
        ("EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1", LineProblem::SelfEdge(1)),
        ("EDGE_SE2 0 9 1 0 0 1 0 0 1 0 1", LineProblem::MissingVertex(9)),
        ("EDGE_SE2 0 7 1 0 0 1 0 0 1 0 1", LineProblem::WrongVertex(7)),
        ("EDGE_SE2_XY 0 1 1 0 1 0 1", LineProblem::WrongVertex(1)),
        ("FIX 12", LineProblem::MissingVertex(12)),
        ("VERTEX_CAM 4 0 0", LineProblem::UnknownTag("VERTEX_CAM".into())),
        ("VERTEX_SE3:QUAT 3 0 0 0 0 0 0 1", LineProblem::MixedDimensions),
    ];
    let n_lines = PLANAR.lines().count();
    for (line, expected) in cases {
        assert_eq!(problem(&format!("{PLANAR}{line}\n")), (n_lines + 1, expected), "{line}");
    }
    let no_rotation = problem("VERTEX_SE3:QUAT 3 0 0 0 0 0 0 0\n");
    assert_eq!(no_rotation, (1, LineProblem::NotARotation(0.0)));
    assert!(matches!(g2o::read("\n# nothing\n".as_bytes()), Err(G2oError::Empty)));
    assert!(matches!(g2o::read("VERTEX_SE2 0 0 0 0\n".as_bytes()), Err(G2oError::Empty)));
    assert!(matches!(g2o::read(&b"VERTEX_SE2 0 0 0 0\n\xff\xfe\n"[..]), Err(G2oError::Read { line: 1, .. })));
}

#[test]
fn truncated_compression_is_an_error() {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(PLANAR.as_bytes()).unwrap();
    let whole = encoder.finish().unwrap();
    for n_bytes in [10, whole.len() / 2, whole.len() - 4] {
        let reader = flate2::read::MultiGzDecoder::new(whole[..n_bytes].take(u64::MAX));
        assert!(matches!(g2o::read(BufReader::new(reader)), Err(G2oError::Read { .. })), "{n_bytes}");
    }
}

#[test]
fn parts_that_never_meet_are_named_by_their_vertices() {
    let text =
        format!("{PLANAR}VERTEX_SE2 20 0 0 0\nVERTEX_SE2 21 1 0 0\nEDGE_SE2 20 21 1 0 0 1 0 0 1 0 1\n");
    let G2o::Planar(graph) = g2o::read(text.as_bytes()).unwrap() else { panic!("planar") };
    let mut problem = graph.problem(Repair::Refuse).unwrap();
    assert!(!problem.start_linearly(&graph).unwrap(), "no linear start without a fixed pose in each part");
    let error = problem.graph.optimize(&Params::default()).unwrap_err();
    let named = problem.named(&graph, error).to_string();
    assert!(named.contains("3 directions") && named.contains("θ of vertex 20"), "{named}");

    let lonely = format!("{PLANAR}VERTEX_SE2 20 0 0 0\n");
    let G2o::Planar(graph) = g2o::read(lonely.as_bytes()).unwrap() else { panic!("planar") };
    let mut problem = graph.problem(Repair::Refuse).unwrap();
    let error = problem.graph.optimize(&Params::default()).unwrap_err();
    assert!(problem.named(&graph, error).to_string().contains("no edge leads to 1 vertex: 20"));
}

#[test]
fn numbers_that_overflow_are_named_by_their_line() {
    let text = format!("{PLANAR}EDGE_SE2 0 2 1e300 0 0 1 0 0 1 0 1\n");
    let G2o::Planar(graph) = g2o::read(text.as_bytes()).unwrap() else { panic!("planar") };
    let error = graph.problem(Repair::Refuse).err().unwrap();
    let sensor = "PARAMS_SE3OFFSET 1 1e300 0 0 0 0 0.6 0.8\nVERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_TRACKXYZ 1 0 0 0\n";
    let edge = "EDGE_SE3_TRACKXYZ 0 1 1 1.7e308 1.7e308 0 1 0 0 1 0 1\n";
    let expected = (4, LineProblem::NotFinite("the measurement in the body frame"));
    assert_eq!(self::problem(&format!("{sensor}{edge}")), expected);
    let line_of_it = PLANAR.lines().count() + 1;
    let is_named = |error: &G2oError| matches!(error, G2oError::Line { line, problem: LineProblem::NotFinite(_) } if *line == line_of_it);
    assert!(is_named(&error), "{error}");
}

#[test]
fn many_loose_parts_have_no_false_counts() {
    let part = |at: usize| {
        let (one, other) = (2 * at + 100, 2 * at + 101);
        format!(
            "VERTEX_SE2 {one} 0 0 0\nVERTEX_SE2 {other} 1 0 0\nEDGE_SE2 {one} {other} 1 0 0 1 0 0 1 0 1\n"
        )
    };
    let text: String = std::iter::once(PLANAR.to_owned()).chain((0..60).map(part)).collect();
    let G2o::Planar(graph) = g2o::read(text.as_bytes()).unwrap() else { panic!("planar") };
    let mut problem = graph.problem(Repair::Refuse).unwrap();
    let error = problem.graph.optimize(&Params::default()).unwrap_err();
    let named = problem.named(&graph, error).to_string();
    assert!(named.contains("at least ") && !named.contains("move with it"), "{named}");
}

#[test]
fn indefinite_information_is_counted_and_repaired_on_request() {
    let text = PLANAR.replace("EDGE_SE2 2 0 1 1 3.1 1 0 0 1 0 1", "EDGE_SE2 2 0 1 1 3.1 1 2 0 1 0 1");
    let G2o::Planar(graph) = g2o::read(text.as_bytes()).unwrap() else { panic!("planar") };
    let error = graph.problem(Repair::Refuse).err().unwrap();
    let G2oError::Indefinite { count: 1, total: 5, first_line: 10, smallest } = error else {
        panic!("{error}")
    };
    assert_abs_diff_eq!(smallest, -1.0, epsilon = 1e-12);
    let mut repaired = graph.problem(Repair::ClipEigenvalues).unwrap();
    assert_eq!(repaired.n_repaired, 1);
    assert!(repaired.graph.optimize(&Params::default()).unwrap().cost < 1.0);
}

/// What the fuzz target does, on seeded changes of two files: bytes replaced, lines dropped and repeated.
#[test]
fn damaged_text_is_refused_or_solved() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let letters = b"0123456789.-e \nEDGFIX#";
    let (mut n_read, mut n_solved) = (0, 0);
    for trial in 0..4000 {
        let mut lines: Vec<String> = [PLANAR, SPATIAL][trial % 2].lines().map(str::to_owned).collect();
        for _ in 0..rng.random_range(1..4) {
            let line = rng.random_range(0..lines.len());
            match rng.random_range(0..4) {
                0 => drop(lines.remove(line)),
                1 => lines.push(lines[line].clone()),
                _ if lines[line].is_empty() => {}
                _ => {
                    let place = rng.random_range(0..lines[line].len());
                    let letter = char::from(letters[rng.random_range(0..letters.len())]);
                    lines[line].replace_range(place..=place, &letter.to_string());
                }
            }
        }
        let Ok(file) = g2o::read(lines.join("\n").as_bytes()) else { continue };
        n_read += 1;
        n_solved += match file {
            G2o::Planar(graph) => solved(&graph),
            G2o::Spatial(graph) => solved(&graph),
        };
    }
    assert!(
        n_read > 400 && n_solved > 200,
        "{n_read} read, {n_solved} solved: the changes should not spoil all"
    );
}

fn solved<P: RigidPose>(file: &PoseGraph<P>) -> usize {
    let Ok(mut problem) = file.problem(Repair::ClipEigenvalues) else { return 0 };
    problem.start_linearly(file).unwrap();
    match problem.graph.optimize(&Params::default()) {
        Ok(summary) => {
            assert!(
                summary.cost.is_finite() && summary.cost <= summary.start_cost * (1.0 + 1e-9),
                "{summary:?}"
            );
            1
        }
        Err(error) => {
            assert!(!problem.named(file, error).to_string().is_empty());
            0
        }
    }
}
