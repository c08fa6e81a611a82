use super::PlaceMatch;
use crate::PoseHypothesis;

/// The observation as a sum over all places that look like the view, as printed.
///
/// Weights are those of the places times $`S`$. The sum leans to where references lie dense ([`interpolate`](super::interpolate) does so less).
/// [Gross et al. 2005, Sec. 2.2]
pub fn superpose(place_matches: &[PlaceMatch]) -> Vec<PoseHypothesis> {
    let weighted = |s: &PlaceMatch| PoseHypothesis::new(s.weight * s.similarity, s.gaussian.clone());
    place_matches.iter().map(weighted).collect()
}
