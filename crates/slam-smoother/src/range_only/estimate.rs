use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix2, Matrix3, Vector2};
use wayfix_estimation_traits::Pose2;

use super::{
    Calibration, CalibrationPrior, RangeOnlyInput, RangeOnlyNoise,
    batch::{RangeGraph, Solution},
    input, noise,
    placement::{self, MIN_RANGES, Placement, Sample},
};
use crate::SlamSmootherError;

/// What is assumed before the ranges are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeOnlyParams {
    /// Noise at the start of the search; the result hardly depends on it.
    ///
    /// Default: odometry as in EKF-SLAM of a robot of which nothing is known, 0.04 m/√m and 0.01 rad/√m, and ranges right to within 1 m.
    pub start_noise: RangeOnlyNoise,
    /// Bias and scale of the receiver beforehand.
    pub calibration: CalibrationPrior,
}

impl Default for RangeOnlyParams {
    fn default() -> Self {
        let start_noise =
            RangeOnlyNoise { translation_per_sqrt_meter: 0.04, heading_per_sqrt_meter: 0.01, range: 1.0 };
        Self { start_noise, calibration: CalibrationPrior::default() }
    }
}

/// A beacon that has no place: its ranges are not used.
#[derive(Clone, Debug, PartialEq)]
pub struct UnplacedBeacon {
    /// Its identity.
    pub beacon: u32,
    /// How many ranges there are.
    pub n_ranges: usize,
    /// The places that fit equally well, as far as the path tells any.
    pub places: Vec<Vector2<f64>>,
}

/// The most likely path, beacons, calibration and noise.
#[derive(Clone, Debug)]
pub struct RangeOnlyEstimate {
    /// All poses.
    pub poses: Vec<Pose2<f64>>,
    /// Numbers of poses, and their covariances in the body frame.
    pub pose_covariances: Vec<(usize, Matrix3<f64>)>,
    /// Places of the beacons, with covariances.
    pub beacons: BTreeMap<u32, (Vector2<f64>, Matrix2<f64>)>,
    /// Beacons without a place.
    pub unplaced: Vec<UnplacedBeacon>,
    /// Bias and scale of the receiver, against odometry.
    pub calibration: Calibration,
    /// Standard deviations of bias and logarithm of the scale.
    pub calibration_sigma: Calibration,
    /// Standard deviation of what odometry may be wrong by throughout, along and across, as a share of the distance.
    ///
    /// No range tells it: odometry that is too long by a factor, or drives askew by an angle, scales or turns path and beacons about the start.
    /// The covariances hold it.
    pub odometry_error_sigma: f64,
    /// Noise by the likelihood of the measurements.
    pub noise: RangeOnlyNoise,
    /// Standard deviation of the residuals of the ranges by their median, m.
    pub range_sigma: f64,
    /// Ranges whose residual is beyond three of these; the kernel limits their weight.
    pub n_outliers: usize,
    /// Ranges that were used.
    pub n_ranges: usize,
}

/// Poses whose covariances are computed at most, evenly over the run.
const MAX_COVARIANCES: usize = 2000;

/// Path, beacons, calibration and noise by all measurements at once.
///
/// The run is solved in prefixes of growing length. In each, every beacon is placed anew by its ranges, from several starts, with the path so far;
/// a beacon waits while two places fit equally well. Then the noise is that under which the measurements are most likely.
///
/// # Errors
/// * [`SlamSmootherError::OutOfRange`], [`SlamSmootherError::UnknownPose`] for the input.
/// * [`SlamSmootherError::NoBeacon`] when no beacon can be placed.
/// * [`SlamSmootherError::Smoother`] when the problem cannot be solved.
pub fn estimate(
    input: &RangeOnlyInput,
    params: &RangeOnlyParams,
) -> Result<RangeOnlyEstimate, SlamSmootherError> {
    input.check()?;
    let mut noise = params.start_noise;
    let mut solution =
        Solution { poses: vec![input.start], beacons: BTreeMap::new(), calibration: Vector2::zeros() };
    let mut known_calibration = params.calibration.information();
    let mut graph = None;
    for n_poses in prefixes(input.n_poses()) {
        let n_known = solution.poses.len();
        input::extend(&mut solution.poses, &input.motions[n_known - 1..n_poses - 1]);
        place_all(input, &mut solution, known_calibration, &mut noise);
        if solution.beacons.is_empty() {
            continue;
        }
        let mut prefix = RangeGraph::new(input, &solution, &params.calibration, noise)?;
        prefix.optimize()?;
        solution = prefix.solution()?;
        noise.range = sigma_of(prefix.range_residuals()?);
        prefix.set_noise(noise)?;
        known_calibration = prefix.calibration_covariance()?.try_inverse().unwrap_or(known_calibration);
        graph = Some(prefix);
    }
    let beacons: BTreeSet<u32> = input.ranges.iter().map(|range| range.beacon).collect();
    let Some(mut graph) = graph else {
        let (n_beacons, n_ranges, min_ranges) = (beacons.len(), input.ranges.len(), MIN_RANGES);
        return Err(SlamSmootherError::NoBeacon { n_beacons, n_ranges, min_ranges });
    };
    noise::maximize_likelihood(&mut graph)?;
    let unplaced = unplaced(input, &graph.solution()?, graph.calibration_covariance()?, graph.noise());
    let mut estimate = finish(&mut graph, unplaced)?;
    add_odometry_error(&mut estimate);
    Ok(estimate)
}

fn finish(
    graph: &mut RangeGraph,
    unplaced: Vec<UnplacedBeacon>,
) -> Result<RangeOnlyEstimate, SlamSmootherError> {
    let solution = graph.solution()?;
    let n = solution.poses.len();
    let period = n.div_ceil(MAX_COVARIANCES).max(1);
    let chosen: Vec<usize> = (0..n).step_by(period).collect();
    let (calibration, of_calibration) = (graph.calibration()?, graph.calibration_covariance()?);
    let residuals = graph.range_residuals()?;
    let range_sigma = sigma_of(residuals.clone());
    Ok(RangeOnlyEstimate {
        pose_covariances: graph.pose_covariances(&chosen)?,
        beacons: graph.placed_beacons()?,
        unplaced,
        calibration,
        calibration_sigma: of_calibration.diagonal().map(f64::sqrt).into(),
        odometry_error_sigma: ((calibration.log_scale.powi(2) + of_calibration.m22) / 2.0).sqrt(),
        noise: *graph.noise(),
        range_sigma,
        n_outliers: residuals.iter().filter(|residual| **residual > 3.0 * range_sigma).count(),
        n_ranges: graph.n_ranges(),
        poses: solution.poses,
    })
}

/// Adds what an unknown scale and direction of odometry do: path and beacons scale and turn about the start, headings stay.
///
/// The ranges say by how much receiver and odometry differ in scale, $`λ`$, not which of them is wrong. When both err alike, each has a mean square
/// of $`λ^2 / 2`$; odometry counts as wrong by as much across as along. Both together are the same in all directions.
fn add_odometry_error(estimate: &mut RangeOnlyEstimate) {
    let (start, sigma) = (estimate.poses[0].translation, estimate.odometry_error_sigma);
    let variance = |place: &Vector2<f64>| (sigma * (place - start).norm()).powi(2);
    for (number, covariance) in &mut estimate.pose_covariances {
        let variance = variance(&estimate.poses[*number].translation);
        covariance.m11 += variance;
        covariance.m22 += variance;
    }
    for (place, covariance) in estimate.beacons.values_mut() {
        *covariance += Matrix2::identity() * variance(place);
    }
}

/// Lengths of the prefixes that are solved one after the other. The whole run comes twice: the second time beacons are placed by its better path.
fn prefixes(n_poses: usize) -> impl Iterator<Item = usize> {
    [8, 4, 2, 1, 1].into_iter().map(move |part| (n_poses / part).max(1))
}

/// Places every beacon by the path so far; those that cannot be placed keep what they have.
fn place_all(
    input: &RangeOnlyInput,
    solution: &mut Solution,
    information: Matrix2<f64>,
    noise: &mut RangeOnlyNoise,
) {
    let knows_none = solution.beacons.is_empty();
    for (id, samples) in samples(input, &solution.poses) {
        let placement = placement::place(&samples, solution.calibration, information, noise.range);
        if let Placement::Placed { beacon, calibration, range_sigma } = placement {
            if knows_none && solution.beacons.is_empty() {
                solution.calibration = calibration;
                noise.range = range_sigma;
            }
            solution.beacons.insert(id, beacon);
        }
    }
}

fn unplaced(
    input: &RangeOnlyInput,
    solution: &Solution,
    covariance: Matrix2<f64>,
    noise: &RangeOnlyNoise,
) -> Vec<UnplacedBeacon> {
    let information = covariance.try_inverse().unwrap_or_default();
    let mut unplaced = Vec::new();
    for (beacon, samples) in samples(input, &solution.poses) {
        if solution.beacons.contains_key(&beacon) {
            continue;
        }
        let placement = placement::place(&samples, solution.calibration, information, noise.range);
        let places = if let Placement::Ambiguous(places) = placement { places } else { Vec::new() };
        unplaced.push(UnplacedBeacon { beacon, n_ranges: samples.len(), places });
    }
    unplaced
}

/// The ranges to each beacon from the poses that are known.
fn samples(input: &RangeOnlyInput, poses: &[Pose2<f64>]) -> BTreeMap<u32, Vec<Sample>> {
    let mut samples: BTreeMap<u32, Vec<Sample>> = BTreeMap::new();
    for measured in &input.ranges {
        if let Some(pose) = poses.get(measured.pose) {
            let sample = Sample { position: pose.translation, range: measured.range };
            samples.entry(measured.beacon).or_default().push(sample);
        }
    }
    samples
}

/// Standard deviation of Gaussian residuals by the median of their absolute values; outliers up to half of them do no harm.
pub(super) fn sigma_of(mut absolute: Vec<f64>) -> f64 {
    absolute.sort_by(f64::total_cmp);
    let median = absolute.get(absolute.len() / 2).copied().unwrap_or(1.0);
    (1.4826 * median).max(1e-6)
}
