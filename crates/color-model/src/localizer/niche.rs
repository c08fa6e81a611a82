use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_particle::{NormalizedWeights, Resampler, SystematicResampler};

use super::{candidate::Candidate, hypothesis::is_same_place, weighed::softened};
use crate::ColorModelError;

/// Candidates about one place.
///
/// Places are refined apart and compared afterwards: together, those that are good from afar would have taken over before the others are
/// near enough to their own peaks.
pub(crate) struct Niche(pub(crate) Vec<Candidate>);

impl Niche {
    /// The best of many candidates that are apart from each other, `most` of them.
    pub(crate) fn apart(mut candidates: Vec<Candidate>, most: usize) -> Vec<Self> {
        candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        let mut niches: Vec<Self> = Vec::new();
        for candidate in candidates {
            let place = candidate.trajectory.newest;
            if niches.len() < most
                && !niches.iter().any(|niche| is_same_place(&niche.0[0].trajectory.newest, &place))
            {
                niches.push(Self(vec![candidate]));
            }
        }
        niches
    }

    /// Keeps the best, `most` of them, and those that descend from known places; the best first, and of those that met at one place the best.
    pub(crate) fn retain_best(niches: &mut Vec<Self>, most: usize) {
        niches.sort_by(|a, b| b.best().total_cmp(&a.best()));
        let mut kept: Vec<Self> = Vec::new();
        for niche in niches.drain(..) {
            let has_met = |other: &Self| other.is_at(&niche.place());
            if niche.known().is_some() || kept.len() < most && !kept.iter().any(has_met) {
                kept.push(niche);
            }
        }
        *niches = kept;
    }

    /// Which of the places that were pursued before the search it descends from, if any.
    pub(crate) fn known(&self) -> Option<usize> {
        self.0.iter().find_map(|candidate| candidate.known.map(|known| known.index))
    }

    /// The score of the best.
    pub(crate) fn best(&self) -> f64 {
        self.0.iter().map(|candidate| candidate.score).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether a pose is where the best is.
    pub(crate) fn is_at(&self, pose: &Pose2<f64>) -> bool {
        is_same_place(&self.place(), pose)
    }

    pub(crate) fn best_candidate(&self) -> Option<&Candidate> {
        self.0.iter().max_by(|a, b| a.score.total_cmp(&b.score))
    }

    /// Where the best is.
    fn place(&self) -> Pose2<f64> {
        self.best_candidate().map_or_else(Pose2::identity, |candidate| candidate.trajectory.newest)
    }

    /// The next generation, of `n` candidates.
    pub(crate) fn resampled<R: rand::Rng + ?Sized>(
        &self,
        n: usize,
        least_effective: f64,
        rng: &mut R,
    ) -> Result<Vec<Candidate>, ColorModelError> {
        let equal = NormalizedWeights::from_linear(vec![1.0; self.0.len()])?;
        let scores: Vec<f64> = self.0.iter().map(|candidate| candidate.score).collect();
        let (weights, _) = softened(&scores, &equal, least_effective * scores.len() as f64)?;
        let ancestors = SystematicResampler.ancestors(&weights, n.max(1), rng)?;
        Ok(ancestors.iter().map(|&at| self.0[at].clone()).collect())
    }
}
