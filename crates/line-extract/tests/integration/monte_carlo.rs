//! Covariances against the scatter of what is estimated.

use crate::support;

use std::f64::consts::PI;

use approx::abs_diff_eq;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use wayfix_line_extract::nalgebra::{Matrix2, Vector2};
use wayfix_line_extract::{
    HessianLine, LineEstimate, LineExtractionParams, LineExtractor, LineFit, RangeBearingNoise, Scan,
    WallHypothesis, WallSegment, fit_line,
};

use crate::support::{Laser, room, wall};

const SEED_FIT: u64 = 51;
const SEED_ROOM: u64 = 52;
const SEED_WALL: u64 = 53;

const NOISE: RangeBearingNoise = RangeBearingNoise { sigma_range_m: 0.01, sigma_bearing_rad: 0.002 };

/// The truth as an estimate, so that the distance to it is the NEES.
fn exactly(rho: f64, alpha: f64) -> LineEstimate {
    LineEstimate { line: HessianLine::new(rho, alpha), covariance: Matrix2::zeros() }
}

/// Fits to echoes of a line between two bearings.
fn fits(rho: f64, alpha: f64, bearings: (f64, f64), runs: usize) -> Vec<LineFit> {
    const N: usize = 60;
    let mut rng = ChaCha8Rng::seed_from_u64(SEED_FIT);
    let mut normal = |sigma: f64| -> f64 { sigma * Distribution::<f64>::sample(&StandardNormal, &mut rng) };
    let mut run = || {
        let points: Vec<_> = (0..N)
            .map(|k| {
                let bearing = bearings.0 + (bearings.1 - bearings.0) * k as f64 / (N - 1) as f64;
                let range = rho / (bearing - alpha).cos() + normal(NOISE.sigma_range_m);
                let bearing = bearing + normal(NOISE.sigma_bearing_rad);
                Vector2::new(bearing.cos(), bearing.sin()) * range
            })
            .collect();
        let covariances: Vec<_> = points.iter().map(|p| NOISE.covariance(p)).collect();
        fit_line(&points, &covariances).expect("a line")
    };
    (0..runs).map(|_| run()).collect()
}

#[test]
fn the_covariance_of_a_fit_is_that_of_its_errors() {
    const RUNS: usize = 4000;
    // Ahead, aslant, behind with α at the wrap, and behind to the right.
    let cases = [(3.0, 0.2, -0.8, 1.0), (1.5, 1.0, 1.3, 2.3), (4.0, PI, 2.6, 3.6), (2.0, -2.0, -2.9, -1.9)];
    for (rho, alpha, from, to) in cases {
        let truth = exactly(rho, alpha);
        let fits = fits(rho, alpha, (from, to), RUNS);
        let nees: f64 = fits.iter().map(|fit| fit.estimate.mahalanobis_squared(&truth).expect("valid")).sum();
        // The mean of N chi-squared numbers with 2 degrees of freedom is 2 with deviation 2/√N; four of those, and 3 % for
        // what is of second order in the noise.
        let (mean, bound) = (nees / RUNS as f64, 8.0 / (RUNS as f64).sqrt() + 0.06);
        assert!(abs_diff_eq!(mean, 2.0, epsilon = bound), "NEES {mean} at ρ {rho}, α {alpha}, bound {bound}");
        // 58 degrees of freedom, variance 2 · 58.
        let residual: f64 = fits.iter().map(|fit| fit.chi_squared).sum::<f64>() / RUNS as f64;
        let bound = 4.0 * (116.0 / RUNS as f64).sqrt() + 0.03 * 58.0;
        assert!(abs_diff_eq!(residual, 58.0, epsilon = bound), "chi-squared {residual}, bound {bound}");
    }
}

#[test]
fn each_entry_of_the_covariance_is_the_scatter() {
    const RUNS: usize = 4000;
    let fits = fits(3.0, 0.2, (0.0, 1.2), RUNS);
    let error = |fit: &LineFit| Vector2::new(fit.estimate.line.rho() - 3.0, fit.estimate.line.alpha() - 0.2);
    let scatter =
        fits.iter().map(|fit| error(fit) * error(fit).transpose()).sum::<Matrix2<f64>>() / RUNS as f64;
    let stated = fits.iter().map(|fit| fit.estimate.covariance).sum::<Matrix2<f64>>() / RUNS as f64;
    // An entry's deviation is at most √(2/N) of the geometric mean of its variances; four of those, and 3 % second order.
    let bound = 4.0 * (2.0 / RUNS as f64).sqrt() + 0.03;
    for (i, j) in [(0, 0), (0, 1), (1, 1)] {
        let unit = (stated[(i, i)] * stated[(j, j)]).sqrt();
        let off = (scatter[(i, j)] - stated[(i, j)]) / unit;
        assert!(off.abs() < bound, "entry ({i}, {j}): {off} of its unit, bound {bound}");
    }
    assert!(
        stated[(0, 1)].abs() > 0.5 * (stated[(0, 0)] * stated[(1, 1)]).sqrt(),
        "the case has a correlation to check"
    );
}

#[test]
fn walls_of_a_room_are_within_their_two_sigma_ellipse() {
    const RUNS: usize = 500;
    let mut rng = ChaCha8Rng::seed_from_u64(SEED_ROOM);
    let laser = Laser::over(359.0, 360);
    let mut extractor =
        LineExtractor::new(LineExtractionParams { beam_noise: NOISE, ..LineExtractionParams::default() })
            .expect("valid");
    let (mut inside, mut n) = (0, 0);
    for _ in 0..RUNS {
        let ranges = laser.noisy_ranges(&room(), &NOISE, &mut rng);
        for segment in walls(&mut extractor, laser, &ranges) {
            let squared = room().iter().map(|wall| nees(&segment, wall)).fold(f64::INFINITY, f64::min);
            inside += usize::from(squared <= 4.0);
            n += 1;
        }
    }
    let rate = inside as f64 / n as f64;
    // 1 - exp(-2) = 0.865 of exact Gaussians; a tenth of that is left to the corners' points, which may be on the wrong wall.
    assert!(
        rate > 0.9 * 0.865 && rate < 0.865 + 4.0 * (0.865 * 0.135 / n as f64).sqrt() + 0.01,
        "{rate} of {n}"
    );
}

#[test]
fn two_scans_of_a_wall_are_compatible_at_the_two_sigma_rate() {
    const RUNS: usize = 4000;
    let mut rng = ChaCha8Rng::seed_from_u64(SEED_WALL);
    let laser = Laser::over(60.0, 121);
    let ahead = [wall(3.0, -4.0, 3.0, 4.0)];
    let mut extractor =
        LineExtractor::new(LineExtractionParams { beam_noise: NOISE, ..LineExtractionParams::default() })
            .expect("valid");
    let mut in_pieces = 0;
    let mut look = || {
        loop {
            let ranges = laser.noisy_ranges(&ahead, &NOISE, &mut rng);
            let seen = walls(&mut extractor, laser, &ranges);
            if let [whole] = seen[..] {
                return whole;
            }
            in_pieces += 1;
        }
    };
    let mut found = 0;
    for _ in 0..RUNS {
        let (first, second) = (look(), look());
        let (start, end) = (first.start, first.end);
        let hypothesis = WallHypothesis { estimate: first.estimate, start, end, n_sigma: 2.0, margin_m: 0.2 };
        let other = WallSegment { start, end, estimate: exactly(3.2, 0.0), ..second };
        assert_eq!(hypothesis.is_compatible(&other), Ok(false), "20 cm are some fifty deviations");
        let aside = Vector2::new(0.0, first.length() + 0.5);
        let elsewhere = WallSegment { start: start + aside, end: end + aside, ..second };
        assert_eq!(hypothesis.find(&[elsewhere]), Ok(None), "30 cm beyond the end of the band");
        let compatible = hypothesis.is_compatible(&second).expect("valid");
        assert_eq!(hypothesis.find(&[other, second]), Ok(compatible.then_some(1)));
        found += usize::from(compatible);
    }
    // An echo must be five deviations off the line through the end echoes, which are off as well, for a split: 121 chances of some
    // 4e-5. Not all of those are merged again, since a point that far off is evidence against it.
    assert!(in_pieces as f64 <= 0.005 * 2.0 * RUNS as f64, "{in_pieces} walls in pieces");
    // Binomial around 1 - exp(-2); 1 % for echoes left out at the ends and what is of second order.
    let (rate, expected) = (found as f64 / RUNS as f64, 1.0 - (-2.0_f64).exp());
    let bound = 4.0 * (expected * (1.0 - expected) / RUNS as f64).sqrt() + 0.01;
    assert!(abs_diff_eq!(rate, expected, epsilon = bound), "{rate}, expected {expected} ± {bound}");
}

fn walls(extractor: &mut LineExtractor, laser: Laser, ranges: &[f64]) -> Vec<WallSegment> {
    let Laser { angle_min, angle_increment, .. } = laser;
    let scan = Scan { angle_min, angle_increment, ranges, max_range: 20.0 };
    extractor.extract(&scan).expect("a valid scan").segments
}

fn nees(segment: &WallSegment, wall: &support::Wall) -> f64 {
    let along = (wall.1 - wall.0).normalize();
    let normal = Vector2::new(along.y, -along.x);
    let truth = exactly(normal.dot(&wall.0), normal.y.atan2(normal.x));
    segment.estimate.mahalanobis_squared(&truth).expect("valid")
}
