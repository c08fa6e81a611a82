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
    /// Standard deviation of the angle between heading and direction of driving, rad.
    ///
    /// Ranges to beacons of unknown place do not tell it: another angle turns path and beacons about the start. It only widens covariances.
    /// Default 0.05: a sensor of heading that is mounted by hand.
    pub driving_direction_sigma: f64,
}

impl Default for RangeOnlyParams {
    fn default() -> Self {
        let start_noise =
            RangeOnlyNoise { translation_per_sqrt_meter: 0.04, heading_per_sqrt_meter: 0.01, range: 1.0 };
        Self { start_noise, calibration: CalibrationPrior::default(), driving_direction_sigma: 0.05 }
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
    /// Bias and scale of the receiver.
    pub calibration: Calibration,
    /// Standard deviations of bias and logarithm of the scale.
    pub calibration_sigma: Calibration,
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
    let sigma = params.driving_direction_sigma;
    if !(sigma >= 0.0 && sigma.is_finite()) {
        let (what, index, wanted) = ("parameter driving_direction_sigma", 0, "finite and not negative");
        return Err(SlamSmootherError::OutOfRange { what, index, value: sigma, wanted });
    }
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
    add_driving_direction(&mut estimate, params.driving_direction_sigma);
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
    let of_calibration = graph.calibration_covariance()?;
    let residuals = graph.range_residuals()?;
    let range_sigma = sigma_of(residuals.clone());
    Ok(RangeOnlyEstimate {
        pose_covariances: graph.pose_covariances(&chosen)?,
        beacons: graph.placed_beacons()?,
        unplaced,
        calibration: graph.calibration()?,
        calibration_sigma: of_calibration.diagonal().map(f64::sqrt).into(),
        noise: *graph.noise(),
        range_sigma,
        n_outliers: residuals.iter().filter(|residual| **residual > 3.0 * range_sigma).count(),
        n_ranges: graph.n_ranges(),
        poses: solution.poses,
    })
}

/// Adds what an unknown direction of driving does: path and beacons turn about the start, headings stay.
fn add_driving_direction(estimate: &mut RangeOnlyEstimate, sigma: f64) {
    let start = estimate.poses[0].translation;
    let moved = |place: Vector2<f64>| Vector2::new(start.y - place.y, place.x - start.x) * sigma;
    for (number, covariance) in &mut estimate.pose_covariances {
        let pose = estimate.poses[*number];
        let in_body = (pose.rotation_matrix().transpose() * moved(pose.translation)).push(0.0);
        *covariance += in_body * in_body.transpose();
    }
    for (place, covariance) in estimate.beacons.values_mut() {
        *covariance += moved(*place) * moved(*place).transpose();
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
