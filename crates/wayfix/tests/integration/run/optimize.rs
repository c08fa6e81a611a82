//! `wayfix optimize` from outside.

#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use std::fs;

use crate::common::{Scratch, wayfix};

/// A square whose last edge closes a loop that does not quite fit.
const SQUARE: &str = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1.2 0 1.5\nVERTEX_SE2 2 1 1 3.1\nVERTEX_SE2 3 0 1 -1.6\nVERTEX_XY 9 1 2\n\
    EDGE_SE2 0 1 1 0 1.57 10 0 0 10 0 10\nEDGE_SE2 1 2 1 0 1.57 10 0 0 10 0 10\nEDGE_SE2 2 3 1 0 1.57 10 0 0 10 0 10\n\
    EDGE_SE2 3 0 1.1 0 1.57 10 0 0 10 0 10\nEDGE_SE2_XY 0 9 1 2 10 0 10\n";

#[test]
fn optimized_graph_has_the_figures_and_is_its_own_optimum() {
    let scratch = Scratch::new();
    let (graph, better, out) =
        (scratch.file("square.g2o", SQUARE), scratch.path("better.g2o.gz"), scratch.path("out"));
    let [graph, better, out] = [&graph, &better, &out].map(|path| path.to_str().unwrap());
    let first = wayfix(["optimize", graph, "--json", "--graph-out", better, "--out", out]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    assert!(first.stderr.contains("no vertex is fixed: vertex 0 stays"), "{}", first.stderr);
    let (start, cost) = (first.metric("start_cost"), first.metric("cost"));
    assert!(cost > 0.0 && cost < 0.1 && start > 10.0 * cost, "{start} {cost}");
    assert!(first.metric("iterations") >= 1.0 && first.metric("time_ms") > 0.0);
    for file in ["index.html", "report.json", "before.svg", "after.svg"] {
        assert!(fs::metadata(format!("{out}/{file}")).unwrap().len() > 100, "{file}");
    }
    let packed = fs::read(better).unwrap();
    assert!(packed.starts_with(&[0x1f, 0x8b]), "not compressed");
    let cut = scratch.path("cut.g2o.gz");
    fs::write(&cut, &packed[..packed.len() / 2]).unwrap();
    let refused = wayfix(["optimize", cut.to_str().unwrap()]);
    assert_eq!(refused.code, 1);
    assert_eq!(refused.stderr.matches("deflate").count(), 1, "{}", refused.stderr);
    let again = wayfix(["optimize", better, "--json", "--start", "file"]);
    assert_abs_diff_eq!(again.metric("start_cost") / cost, 1.0, epsilon = 1e-9);
    assert!(again.metric("iterations") <= 2.0);
}

#[test]
fn methods_and_starts_agree() {
    let scratch = Scratch::new();
    let graph = scratch.file("square.g2o", SQUARE);
    let cost = |extra: [&str; 4]| {
        let arguments = ["optimize", graph.to_str().unwrap(), "--json"].into_iter().chain(extra);
        wayfix(arguments).metric("cost")
    };
    let expected = cost(["--start", "linear", "--method", "levenberg-marquardt"]);
    for method in ["gauss-newton", "dogleg", "levenberg-marquardt"] {
        for start in ["file", "linear"] {
            assert!(
                abs_diff_eq!(cost(["--start", start, "--method", method]) / expected, 1.0, epsilon = 1e-6),
                "{method} {start}"
            );
        }
    }
}

#[test]
fn kernels_limit_the_weight_of_a_wrong_closure() {
    let scratch = Scratch::new();
    let right = format!("{SQUARE}EDGE_SE2 0 2 1 1 3.14 10 0 0 10 0 10\n");
    let wrong = scratch.file("wrong.g2o", format!("{right}EDGE_SE2 1 3 9 -7 1 10 0 0 10 0 10\n"));
    let better = scratch.path("better.g2o");
    let far = |extra: &[&str]| {
        let [wrong, better] = [&wrong, &better].map(|path| path.to_str().unwrap());
        let arguments = ["optimize", wrong, "--json", "--graph-out", better];
        assert_eq!(wayfix(arguments.iter().chain(extra)).code, 0);
        let text = fs::read_to_string(better).unwrap();
        let line = text.lines().find(|line| line.starts_with("VERTEX_SE2 2 ")).unwrap();
        let at: Vec<f64> = line.split(' ').skip(2).map(|word| word.parse().unwrap()).collect();
        (at[0] - 1.0).hypot(at[1] - 1.0)
    };
    let squared = far(&[]);
    for kernel in ["huber", "cauchy", "geman-mcclure"] {
        assert!(
            far(&["--kernel", kernel]) < 0.5 * squared,
            "{kernel} {} {squared}",
            far(&["--kernel", kernel])
        );
    }
}

#[test]
fn a_run_that_is_cut_and_a_worse_end_are_said() {
    let scratch = Scratch::new();
    let graph = scratch.file("square.g2o", SQUARE);
    let solved = scratch.path("solved.g2o");
    let [graph, solved] = [&graph, &solved].map(|path| path.to_str().unwrap().to_owned());
    let cut = wayfix(["optimize", &graph, "--start", "file", "--max-iterations", "1", "--json"]);
    assert!(cut.stdout.contains("\"not_converged\":1"), "{}", cut.stdout);
    assert!(wayfix(["optimize", &graph, "--graph-out", &solved]).code == 0);
    let again = wayfix(["optimize", &solved, "--json"]);
    assert!(again.stdout.contains("\"not_converged\":0") && !again.stderr.contains("better minimum"));
}

#[test]
fn bad_graphs_are_refused_with_the_line_or_the_vertex() {
    let scratch = Scratch::new();
    let two_parts =
        format!("{SQUARE}VERTEX_SE2 20 0 0 0\nVERTEX_SE2 21 1 0 0\nEDGE_SE2 20 21 1 0 0 1 0 0 1 0 1\n");
    let indefinite =
        SQUARE.replace("EDGE_SE2 3 0 1.1 0 1.57 10 0 0 10 0 10", "EDGE_SE2 3 0 1.1 0 1.57 10 0 0 10 0 -10");
    let cases = [
        ("nan.g2o", SQUARE.replace("1.1 0 1.57", "nan 0 1.57"), "line 9: `nan` is not a finite number"),
        ("parts.g2o", two_parts.clone(), "3 directions"),
        ("parts.g2o", two_parts.clone(), "vertex 20"),
        ("indefinite.g2o", indefinite.clone(), "1 of 5 information matrices are indefinite"),
        ("empty.g2o", "\n".to_owned(), "no edges"),
    ];
    for (name, text, expected) in cases {
        let path = scratch.file(name, text);
        let outcome = wayfix(["optimize", path.to_str().unwrap()]);
        assert_eq!(outcome.code, 1, "{name}");
        assert!(outcome.stderr.contains(expected), "{name}: {}", outcome.stderr);
    }
    let path = scratch.file("parts.g2o", two_parts);
    let held = wayfix(["optimize", path.to_str().unwrap(), "--json", "--fix", "0", "--fix", "20"]);
    assert!(held.metric("cost") < 0.1, "{}", held.stderr);
    let path = scratch.file("indefinite.g2o", indefinite);
    let repaired = wayfix(["optimize", path.to_str().unwrap(), "--json", "--repair"]);
    assert!(
        repaired.code == 0 && repaired.stderr.contains("1 information matrices are indefinite"),
        "{}",
        repaired.stderr
    );
    assert_eq!(repaired.json()["events"]["repaired_information"], 1);
    assert_eq!(wayfix(["optimize", "absent.g2o"]).code, 1);
}
