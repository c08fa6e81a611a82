use nalgebra::{Matrix2, Matrix3, Vector2};
use wayfix_estimation_traits::{Angle, Pose2, wrap_angle};
use wayfix_gaussian_core::{CircularMoments, Gaussian, symmetrize};

use super::{PlaceMatch, ViewDifferenceModel};
use crate::{AppearanceMapError, PoseHypothesis};

/// The observation as one hypothesis for each group of neighbouring places, between which the pose is interpolated.
///
/// Each group has its most similar place as leader. Its places weigh $`w\,e^{-(E^2 - E_0^2)/2h^2}`$ with the distance $`E_0`$ of the leader and a width
/// $`h`$ of half the distance of successive views: a sharp kernel, so that the estimate lies between the nearest places and not where references
/// are dense. (On the Sussex route 0.3 to 0.5 of that distance are equally good, 1 is worse.) The covariance has two parts: what the places themselves are uncertain by, and what the comparison is, which is
/// independent of all beliefs ([`PoseHypothesis::independent`]).
///
/// At the border of the map all places lie on one side, and their mean is biased towards it. There the leader only gives the distance of the
/// robot ([`ViewDifferenceModel::to_meters`]): the hypothesis moves by that distance at most towards a component of `belief` beyond the border.
///
/// # Errors
/// Returns an error if a place is not finite.
pub fn interpolate(
    place_matches: &[PlaceMatch],
    belief: &[Gaussian<Pose2<f64>>],
    scale: &ViewDifferenceModel,
) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
    groups(place_matches, scale).iter().map(|group| pose_of(group, belief, scale)).collect()
}

/// Maximum number of places that are interpolated: a point has six nearest neighbours in the densest lattice of the plane. Also the radius of
/// a group, in steps: along a lane of references that many lie within it.
pub(crate) const GROUP_SIZE: usize = 6;
/// σ of the heading from the comparison with a reference at the same place, rad. In rearranged simulated stores the best rotation has an error of 2° in the
/// mean, with a median of 0.8°.
pub(crate) const HEADING_SIGMA: f64 = 0.03;
/// Additional σ for a view that differs from its reference as much as one of a far place, rad. The best rotation follows objects that appear in
/// another direction from beside the reference: an offset of a quarter of their distance turns them by 0.25 rad.
const PARALLAX_SIGMA: f64 = 0.25;
/// Headings of one group differ by at most twice the largest σ, rad.
pub(super) const MAX_TURN: f64 = 2.0 * (HEADING_SIGMA + PARALLAX_SIGMA);

type Group<'a> = Vec<&'a PlaceMatch>;

/// Greedy: the most similar remaining place leads a group of its neighbours.
fn groups<'a>(place_matches: &'a [PlaceMatch], scale: &ViewDifferenceModel) -> Vec<Group<'a>> {
    let radius = GROUP_SIZE as f64 * scale.step();
    let mut left: Vec<&PlaceMatch> = place_matches.iter().collect();
    left.sort_by(|a, b| a.matched.comparison.distance.total_cmp(&b.matched.comparison.distance));
    let mut groups = Vec::new();
    while let Some(leader) = left.first().copied() {
        let at = leader.gaussian.mean();
        let belongs = |s: &&PlaceMatch| {
            let mean = s.gaussian.mean();
            let turn = wrap_angle(mean.heading() - at.heading()).abs();
            // The leader belongs even where its pose is not a number.
            std::ptr::eq(*s, leader)
                || ((mean.translation - at.translation).norm() <= radius && turn <= MAX_TURN)
        };
        let (group, others): (Vec<_>, Vec<_>) = left.into_iter().partition(belongs);
        groups.push(group);
        left = others;
    }
    groups
}

/// The places of a group that are interpolated.
fn nearest_of<'a, 'b>(whole: &'b Group<'a>) -> &'b [&'a PlaceMatch] {
    &whole[..whole.len().min(GROUP_SIZE)]
}

fn pose_of(
    whole: &Group<'_>,
    belief: &[Gaussian<Pose2<f64>>],
    scale: &ViewDifferenceModel,
) -> Result<PoseHypothesis, AppearanceMapError> {
    let group = nearest_of(whole);
    let nearest = group[0].matched.comparison.distance;
    let shares = shares(group, scale.step_distance() / 2.0);
    let places = || group.iter().zip(&shares).map(|(s, share)| (s.gaussian.mean(), *share));
    let interpolated: Vector2<f64> = places().map(|(mean, share)| mean.translation * share).sum();
    let (heading, heading_variance) = turn_of(group, &shares, scale)?;
    let beyond = beyond_border(whole, &interpolated, belief, scale);
    let position = interpolated + beyond.unwrap_or_default();
    let mean = Pose2::new(position.x, position.y, heading);

    let spread: Matrix2<f64> =
        places().map(|(place, share)| outer(&(place.translation - interpolated)) * share).sum();
    let to_body = mean.rotation_matrix().transpose();
    // Interpolation about halves the error of the nearest place alone; beyond the border there is none.
    let gap = scale.to_meters(nearest) / if beyond.is_some() { 1.0 } else { 2.0 };
    let comparison = to_body * spread * to_body.transpose() / 2.0 + Matrix2::identity() * (gap * gap);
    let mut compared = comparison.to_homogeneous();
    compared[(2, 2)] = heading_variance;

    let mut learned = Matrix3::zeros();
    for (sighting, share) in group.iter().zip(&shares) {
        learned += sighting.gaussian.in_chart_at(&mean)?.covariance() * *share;
    }
    let mut covariance = compared + learned;
    symmetrize(&mut covariance);
    let weight: f64 = group.iter().zip(&shares).map(|(s, share)| s.weight * share).sum();
    let plane = |matrix: &Matrix3<f64>| matrix[(0, 0)] + matrix[(1, 1)];
    Ok(PoseHypothesis {
        // The root lets a place that was seen once count for half of a well-known one, so that a new map can be used.
        weight: group[0].similarity * weight.sqrt(),
        gaussian: Gaussian::new(mean, covariance)?,
        independent: plane(&compared) / plane(&covariance),
    })
}

/// The heading of a group, and the variance of the comparison.
fn turn_of(
    group: &[&PlaceMatch],
    shares: &[f64],
    scale: &ViewDifferenceModel,
) -> Result<(f64, f64), AppearanceMapError> {
    let headings: Vec<Angle<f64>> = group.iter().map(|s| s.gaussian.mean().rotation).collect();
    let moments = CircularMoments::from_weighted(&headings, shares)?;
    // Headings of a group lie within a fraction of a turn, so that they never cancel.
    let heading = moments.mean_direction().unwrap_or(headings[0]).radians();
    let sigma = HEADING_SIGMA + PARALLAX_SIGMA * scale.share_of_sill(group[0].matched.comparison.distance);
    Ok((heading, sigma * sigma + moments.standard_deviation().powi(2)))
}

/// From the interpolated position towards the nearest component of the belief, when that lies beyond all places that look like the view:
/// no further than the nearest of them can be away. `None` inside the map.
fn beyond_border(
    whole: &Group<'_>,
    interpolated: &Vector2<f64>,
    belief: &[Gaussian<Pose2<f64>>],
    scale: &ViewDifferenceModel,
) -> Option<Vector2<f64>> {
    let leader = whole[0].gaussian.mean().translation;
    let offset = |component: &Gaussian<Pose2<f64>>| component.mean().translation - leader;
    let towards = belief.iter().map(offset).min_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    let direction = towards.try_normalize(scale.step() / 2.0)?;
    let inside =
        |s: &&PlaceMatch| (s.gaussian.mean().translation - leader).dot(&direction) > scale.step() / 2.0;
    if whole.iter().any(inside) {
        return None;
    }
    let way = leader + towards - interpolated;
    let most = scale.to_meters(whole[0].matched.comparison.distance);
    Some(way * (most / way.norm()).min(1.0))
}

/// Kernel weights, adding up to one.
fn shares(group: &[&PlaceMatch], width: f64) -> Vec<f64> {
    let nearest = group[0].matched.comparison.distance;
    let kernel = |s: &&PlaceMatch| {
        let beyond = (s.matched.comparison.distance.powi(2) - nearest.powi(2)) / (2.0 * width * width);
        // Without a width only places as near as the leader count.
        let falling = if beyond.is_nan() { 1.0 } else { (-beyond).exp() };
        s.weight.max(f64::MIN_POSITIVE) * falling
    };
    let kernels: Vec<f64> = group.iter().map(kernel).collect();
    let sum: f64 = kernels.iter().sum();
    kernels.iter().map(|k| k / sum).collect()
}

fn outer(vector: &Vector2<f64>) -> Matrix2<f64> {
    vector * vector.transpose()
}
