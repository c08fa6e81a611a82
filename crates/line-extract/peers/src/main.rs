//! Polyline simplification of Wayfix, geo and imageproc on the same chains, in one run.

#[path = "../../benches/chains.rs"]
mod chains;
#[path = "../../benches/harness.rs"]
mod harness;
#[path = "../../benches/jobs.rs"]
mod jobs;
#[path = "../../tests/integration/support/mod.rs"]
mod support;

use chains::Case;
use geo::{Coord, LineString, Simplify};
use harness::measure;
use imageproc::point::Point;

fn main() {
    jobs::run();
    // Not on the zigzag: both are recursive, one call a point, and overflow the stack.
    for case in [Case::walk(1_000_000), Case::circle(1_000_000)] {
        let chain = LineString::new(case.points.iter().map(|p| Coord { x: p.x, y: p.y }).collect());
        measure(&case.name, "geo 0.33", 1, || chain.simplify(case.epsilon));
        let chain: Vec<_> = case.points.iter().map(|p| Point::new(p.x, p.y)).collect();
        measure(&case.name, "imageproc 0.27", 1, || {
            imageproc::geometry::approximate_polygon_dp(&chain, case.epsilon, false)
        });
    }
}
