//! Two scans laid on one another, with little and with much doubt about the heading: `cargo bench -p wayfix-scan-match`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`, the best of many.

use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Pose2;
use wayfix_scan_match::{InitialGuess, ScanMatchParams, ScanMatcher, ScanPointCloud};

const N_RUNS: usize = 200;

/// A room of 8 m by 6 m whose walls have niches, seen from `x` on its long axis and turned by `heading`.
fn scan(x: f64, heading: f64, n_beams: usize, increment: f64) -> ScanPointCloud {
    let range = |beam: usize| {
        let (sin, cos) = (heading - 3.13 + beam as f64 * increment).sin_cos();
        let to_wall = ((4.0 * cos.signum() - x) / cos).min(3.0 / sin.abs());
        let niche = if ((x + to_wall * cos) * 1.3).sin() > 0.5 { 0.4 } else { 0.0 };
        to_wall + niche / sin.abs().max(cos.abs())
    };
    let ranges: Vec<f64> = (0..n_beams).map(range).collect();
    ScanPointCloud::from_ranges(-3.13, increment, &ranges, 20.0).expect("a sound scan")
}

fn main() {
    let matcher = ScanMatcher::new(ScanMatchParams::default()).expect("the defaults are sound");
    for (n_beams, increment) in [(360, 0.0174), (1081, 0.0058)] {
        let (reference, cloud) = (scan(0.0, 0.0, n_beams, increment), scan(0.3, 0.1, n_beams, increment));
        for (heading_sigma, doubt) in [(0.02, "1 start"), (0.2, "7 starts")] {
            let sigmas = Vector3::new(0.05, 0.05, heading_sigma);
            let covariance = Matrix3::from_diagonal(&sigmas.component_mul(&sigmas));
            let guess =
                InitialGuess { pose: Pose2::new(0.27, 0.02, 0.12), covariance, alternative_poses: &[] };
            let align = || {
                #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
                let start = std::time::Instant::now();
                let found = matcher.align(&reference, &cloud, &guess).expect("enough points");
                assert!(found.pose.heading() > 0.05, "the compiler must not leave it out");
                start.elapsed().as_secs_f64()
            };
            let best = (0..N_RUNS).map(|_| align()).fold(f64::INFINITY, f64::min);
            println!("bench\talign, {n_beams} beams, {doubt}\twayfix\t{:.0}", best * 1e9);
        }
    }
}
