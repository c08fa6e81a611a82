use wayfix_line_extract::{Distance, Simplifier, douglas_peucker};

use crate::chains::Case;
use crate::harness::measure;

/// Our rows of `docs/performance.md`.
pub(crate) fn run() {
    for case in [Case::walk(1_000_000), Case::circle(1_000_000)] {
        simplify(&case, "wayfix", Simplifier::default());
        simplify(&case, "wayfix hulls only", Simplifier::impatient());
        measure(&case.name, "wayfix classic", 1, || {
            douglas_peucker(&case.points, case.epsilon, Distance::Line).expect("a valid chain")
        });
    }
    for n in [100_000, 1_000_000] {
        simplify(&Case::zigzag(n), "wayfix", Simplifier::default());
        simplify(&Case::zigzag(n), "wayfix hulls only", Simplifier::impatient());
    }
}

fn simplify(case: &Case, program: &str, mut simplifier: Simplifier) {
    let mut kept = Vec::new();
    measure(&case.name, program, 1, || {
        simplifier.simplify_into(&case.points, case.epsilon, &mut kept).expect("a valid chain");
    });
}
