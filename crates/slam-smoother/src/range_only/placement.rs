use nalgebra::{Matrix1, Matrix2, Vector2};
use wayfix_smoother::{Graph, Params};

use super::{
    Calibration,
    residuals::{RangeFrom, VectorPrior},
};
use crate::ROBUST_KERNEL;

/// Starts around the nearest pose: directions of the beacon.
const N_STARTS: usize = 16;
/// Ranges that are used at most, evenly over all: more hardly tell more about the side.
const MAX_RANGES: usize = 400;
/// Fewest ranges that place a beacon: two coordinates, bias and scale, and one to see whether they fit.
pub(super) const MIN_RANGES: usize = 5;
/// Chi-square with two degrees of freedom, 99.9 %: places whose costs differ by more are not equally good.
const DECISIVE: f64 = 13.8;

/// A range from a position that counts as known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) position: Vector2<f64>,
    pub(super) range: f64,
}

/// What the ranges to a beacon tell about its place.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Placement {
    Placed {
        beacon: Vector2<f64>,
        calibration: Vector2<f64>,
        range_sigma: f64,
    },
    /// Fewer than [`MIN_RANGES`].
    TooFewRanges,
    /// These places fit equally well, or a single one is spread too wide.
    Ambiguous(Vec<Vector2<f64>>),
}

struct Minimum {
    cost: f64,
    beacon: Vector2<f64>,
    calibration: Vector2<f64>,
    covariance: Option<Matrix2<f64>>,
}

/// Places a beacon by least squares from several starts; `calibration` is what is known of it, with its information.
pub(super) fn place(
    samples: &[Sample],
    calibration: Vector2<f64>,
    information: Matrix2<f64>,
    range_sigma: f64,
) -> Placement {
    if samples.len() < MIN_RANGES {
        return Placement::TooFewRanges;
    }
    let samples = thinned(samples);
    let mut sigma = range_sigma;
    let mut minima = Vec::new();
    // The second pass knows how well the ranges fit.
    for _ in 0..2 {
        minima = starts(&samples, calibration)
            .filter_map(|start| minimum(&samples, start, calibration, information, sigma))
            .collect();
        minima.sort_by(|a: &Minimum, b| a.cost.total_cmp(&b.cost));
        let Some(best) = minima.first() else { return Placement::Ambiguous(Vec::new()) };
        sigma = robust_sigma(&samples, best);
    }
    decide(&samples, &minima, sigma)
}

fn starts(samples: &[Sample], calibration: Vector2<f64>) -> impl Iterator<Item = Vector2<f64>> {
    let nearest = samples.iter().min_by(|a, b| a.range.total_cmp(&b.range)).copied();
    let around = move |at: Sample| {
        let distance = Calibration::from(calibration).distance_of(at.range).max(0.1 * at.range);
        (0..N_STARTS).map(move |k| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / N_STARTS as f64).sin_cos();
            at.position + Vector2::new(cos, sin) * distance
        })
    };
    nearest.into_iter().flat_map(around)
}

fn minimum(
    samples: &[Sample],
    start: Vector2<f64>,
    mean: Vector2<f64>,
    information: Matrix2<f64>,
    sigma: f64,
) -> Option<Minimum> {
    let mut graph = Graph::new();
    let (beacon, calibration) = (graph.add_variable(start), graph.add_variable(mean));
    graph.add(VectorPrior(mean), (calibration,), information).ok()?;
    for Sample { position, range } in samples.iter().copied() {
        let residual = RangeFrom { position, range };
        let id = graph.add(residual, (beacon, calibration), Matrix1::new(sigma.powi(-2))).ok()?;
        graph.set_kernel(id, ROBUST_KERNEL).ok()?;
    }
    let cost = graph.optimize(&Params::default()).ok()?.cost;
    let covariance = graph.marginals().and_then(|marginals| marginals.covariance(beacon)).ok();
    Some(Minimum {
        cost,
        beacon: *graph.value(beacon).ok()?,
        calibration: *graph.value(calibration).ok()?,
        covariance: covariance.map(|covariance| covariance.fixed_view::<2, 2>(0, 0).into_owned()),
    })
}

/// A single place, when all minima that are nearly as good are the same and the ranges hold it on both axes.
fn decide(samples: &[Sample], minima: &[Minimum], sigma: f64) -> Placement {
    let Some(best) = minima.first() else { return Placement::Ambiguous(Vec::new()) };
    let mut places: Vec<Vector2<f64>> = Vec::new();
    for minimum in minima.iter().filter(|minimum| minimum.cost < best.cost + DECISIVE) {
        if places.iter().all(|place| (place - minimum.beacon).norm() > sigma) {
            places.push(minimum.beacon);
        }
    }
    // Beyond this spread, the circle of a range is no straight line to within its noise: $`σ^2 / (2d) < σ_r`$.
    let nearest = samples.iter().map(|at| (at.position - best.beacon).norm()).fold(f64::INFINITY, f64::min);
    let spread = best.covariance.map(|covariance| covariance.symmetric_eigenvalues().max());
    let is_held = spread.is_some_and(|variance| variance < 2.0 * nearest.max(sigma) * sigma);
    if places.len() == 1 && is_held {
        let Minimum { beacon, calibration, .. } = best;
        Placement::Placed { beacon: *beacon, calibration: *calibration, range_sigma: sigma }
    } else {
        Placement::Ambiguous(places)
    }
}

/// From the median of the absolute residuals.
fn robust_sigma(samples: &[Sample], at: &Minimum) -> f64 {
    let calibration = Calibration::from(at.calibration);
    let residual =
        |sample: &Sample| (calibration.range_of((at.beacon - sample.position).norm()) - sample.range).abs();
    super::estimate::sigma_of(samples.iter().map(residual).collect())
}

fn thinned(samples: &[Sample]) -> Vec<Sample> {
    let n = samples.len().min(MAX_RANGES);
    (0..n).map(|k| samples[k * samples.len() / n]).collect()
}
