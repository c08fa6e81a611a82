//! Polyline simplification: the convex-hull variant against plain Douglas-Peucker.

use std::f64::consts::TAU;

use anyhow::Result;
use nalgebra::Vector2;
use rand::{Rng, RngExt};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_line_extract::{PointDistanceReference, douglas_peucker, simplify};
use wayfix_system_core::Stopwatch;

use wayfix_evaluation::report::{Metric, ReportRun};

type Chain = Vec<Vector2<f64>>;

/// Compares plain Douglas-Peucker with the convex-hull variant on `n_polylines` random chains of four kinds, and times the worst case of the plain one.
///
/// # Errors
/// Returns an error if a chain is invalid.
pub(crate) fn simplification(n_polylines: u32, seed: u64) -> Result<ReportRun> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut n_differ, mut kept, mut points, mut excess) = (0, 0, 0, f64::NEG_INFINITY);
    for k in 0..n_polylines {
        let chain = random_chain(k, &mut rng);
        let epsilon = rng.random_range(0.01..2.0);
        let indices = simplify(&chain, epsilon)?;
        n_differ += u32::from(indices != douglas_peucker(&chain, epsilon, PointDistanceReference::Line)?);
        kept += indices.len();
        points += chain.len();
        excess = farthest(&chain, &indices).map_or(excess, |farthest| excess.max(farthest - epsilon));
    }
    let metrics = vec![
        Metric::new("n_polylines", f64::from(n_polylines), ""),
        Metric::new("n_polylines_simplified_differently", f64::from(n_differ), ""),
        Metric::new("kept_point_share", kept as f64 / points as f64, ""),
        Metric::new("tolerance_excess_m", excess, "m"),
    ];
    let timings = vec![
        timed("simplify_zigzag_100000_ms", || simplify(&zigzag(100_000), 1e-6).map(drop))?,
        timed("classic_zigzag_5000_ms", || {
            douglas_peucker(&zigzag(5_000), 1e-6, PointDistanceReference::Line).map(drop)
        })?,
    ];
    Ok(ReportRun { metrics, timings, ..ReportRun::default() })
}

/// Distance of the farthest point from the line through the kept points on both sides; `None` if all were kept.
fn farthest(chain: &[Vector2<f64>], kept: &[usize]) -> Option<f64> {
    let pieces = kept.windows(2).filter_map(|pair| {
        let (from, to) = (chain[pair[0]], chain[pair[1]]);
        let along = to - from;
        let apart = |point: &Vector2<f64>| match along.norm() {
            0.0 => (point - from).norm(),
            length => along.perp(&(point - from)).abs() / length,
        };
        chain[pair[0] + 1..pair[1]].iter().map(apart).reduce(f64::max)
    });
    pieces.reduce(f64::max)
}

/// A random walk (which crosses itself), spiral, comb or zigzag, in turn; m.
fn random_chain<R: Rng + ?Sized>(k: u32, rng: &mut R) -> Chain {
    let n = rng.random_range(2..400);
    let size = rng.random_range(0.5..5.0);
    match k % 4 {
        0 => {
            let mut at = Vector2::zeros();
            (0..n)
                .map(|_| {
                    at += Vector2::new(rng.sample(StandardNormal), rng.sample(StandardNormal)) * size;
                    at
                })
                .collect()
        }
        1 => {
            let turns = rng.random_range(0.5..8.0);
            let at = |share: f64| Vector2::new((TAU * turns * share).cos(), (TAU * turns * share).sin());
            (1..=n)
                .map(|k| f64::from(k) / f64::from(n))
                .map(|share| at(share) * (share * 10.0 * size))
                .collect()
        }
        2 => (0..n).map(|k| Vector2::new(0.1 * f64::from(k), f64::from(k % 2) * size)).collect(),
        _ => zigzag(n).into_iter().map(|point| point * (0.01 * size)).collect(),
    }
}

/// Spikes of decreasing size: every split takes off one point.
fn zigzag(n: u32) -> Chain {
    let height = |k: u32| f64::from(k % 2) * 1e3 * (1.0 - f64::from(k) / f64::from(n));
    (0..n).map(|k| Vector2::new(f64::from(k), height(k))).collect()
}

fn timed<E>(name: &str, work: impl FnOnce() -> Result<(), E>) -> Result<Metric, E> {
    let stopwatch = Stopwatch::start();
    work()?;
    Ok(Metric::new(name, 1e3 * stopwatch.elapsed().as_secs_f64(), "ms"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_off_the_kept_line_is_measured() {
        let corner = [(0.0, 0.0), (1.0, 0.25), (2.0, 0.0), (2.0, 2.0)].map(|(x, y)| Vector2::new(x, y));
        assert_eq!(farthest(&corner, &[0, 2, 3]), Some(0.25));
        assert_eq!(farthest(&corner, &[0, 1, 2, 3]), None);
        let there_and_back = [(0.0, 0.0), (3.0, 4.0), (0.0, 0.0)].map(|(x, y)| Vector2::new(x, y));
        assert_eq!(farthest(&there_and_back, &[0, 2]), Some(5.0));
    }
}
