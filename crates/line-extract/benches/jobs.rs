use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_line_extract::{
    LineExtractionParams, LineExtractor, PointDistanceReference, PolylineSimplifier, Scan, SplitMethod,
    douglas_peucker,
};

use crate::chains::Case;
use crate::harness::measure;
use crate::support::{Laser, office};

const SEED_SCAN: u64 = 61;

/// Our rows of `docs/performance.md`.
pub(crate) fn run() {
    scan("wayfix end point fit", SplitMethod::EndPointFit);
    scan("wayfix split and merge", SplitMethod::SplitAndMerge);
    for case in [Case::walk(1_000_000), Case::circle(1_000_000)] {
        simplify(&case, "wayfix", PolylineSimplifier::default());
        simplify(&case, "wayfix hulls only", PolylineSimplifier::hull_tree_only());
        measure(&case.name, "wayfix classic", 1, || {
            douglas_peucker(&case.points, case.epsilon, PointDistanceReference::Line).expect("a valid chain")
        });
    }
    for case in [Case::comb(100_000), Case::straight(100_000)] {
        simplify(&case, "wayfix", PolylineSimplifier::default());
    }
    for n in [100_000, 1_000_000] {
        simplify(&Case::zigzag(n), "wayfix", PolylineSimplifier::default());
        simplify(&Case::zigzag(n), "wayfix hulls only", PolylineSimplifier::hull_tree_only());
    }
}

/// 1081 beams over 270°, as of a Hokuyo UTM-30LX, in an office.
fn scan(program: &str, split: SplitMethod) {
    let params = LineExtractionParams { split_method: split, ..LineExtractionParams::default() };
    let laser = Laser::over(270.0, 1081);
    let mut rng = ChaCha8Rng::seed_from_u64(SEED_SCAN);
    let ranges = laser.noisy_ranges(&office(), &params.beam_noise, &mut rng);
    let Laser { angle_min, angle_increment, .. } = laser;
    let scan = Scan { angle_min, angle_increment, ranges: &ranges, max_range: 30.0 };
    let mut extractor = LineExtractor::new(params).expect("valid parameters");
    let walls = extractor.extract(&scan).expect("a valid scan").segments.len();
    println!("{program}: {walls} walls in the scan");
    measure("scan of 1081 beams to walls", program, 1000, || extractor.extract(&scan).expect("a valid scan"));
}

fn simplify(case: &Case, program: &str, mut simplifier: PolylineSimplifier) {
    let mut kept = Vec::new();
    measure(&case.name, program, 1, || {
        simplifier.simplify_into(&case.points, case.epsilon, &mut kept).expect("a valid chain");
    });
}
