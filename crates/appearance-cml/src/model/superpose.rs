use super::PlaceMatch;
use crate::PoseHypothesis;

/// The observation as a sum over all matching places, as published.
///
/// Weights are those of the places times $`S`$. The sum is biased to dense references ([`interpolate`](super::interpolate) is less so).
/// [Gross et al. 2005, Sec. 2.2]
pub fn superpose(place_matches: &[PlaceMatch]) -> Vec<PoseHypothesis> {
    let weighted = |s: &PlaceMatch| PoseHypothesis::new(s.weight * s.similarity, s.gaussian.clone());
    place_matches.iter().map(weighted).collect()
}
