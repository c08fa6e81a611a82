use nalgebra::{DefaultAllocator, allocator::Allocator};
use wayfix_estimation_traits::Manifold;

use crate::{Innovation, LandmarkId};

/// What became of one observation.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Outcome<Z: Manifold<Scalar = f64>>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// It corrected the state.
    Accepted {
        /// The landmark it was of.
        landmark: LandmarkId,
        /// What it said.
        innovation: Innovation<Z>,
        /// Factor by which its noise was enlarged because it fits badly; 1 when it fits.
        noise_scale: f64,
    },
    /// It was associated, but lies outside the gate: an outlier. The state is untouched.
    Rejected {
        /// The landmark it was said to be of.
        landmark: LandmarkId,
        /// What it said.
        innovation: Innovation<Z>,
        /// The NIS that would have passed.
        threshold: f64,
    },
    /// It started a new landmark.
    Initialized {
        /// The landmark it started.
        landmark: LandmarkId,
    },
    /// It was so far from a tentative landmark that it started that landmark anew.
    Restarted {
        /// The landmark it started.
        landmark: LandmarkId,
    },
    /// It is neither certainly old nor certainly new, so nothing was done with it.
    Ambiguous,
    /// The sensor read no identity and the association needs one.
    Unlabelled,
    /// The same landmark was observed before in this step.
    Duplicate {
        /// The landmark.
        landmark: LandmarkId,
    },
    /// NaN, infinite, or a measurement the model cannot use (a range that is not positive, a noise that is no covariance, a landmark
    /// that cannot start or cannot be seen from here).
    Unusable,
}

/// What became of every observation of a step, in the order they came.
#[derive(Clone, Debug, PartialEq)]
pub struct StepReport<Z: Manifold<Scalar = f64>>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// One outcome an observation.
    pub outcomes: Vec<Outcome<Z>>,
    /// Landmarks that were found to be one.
    pub merges: Vec<Merge>,
}

/// Two landmarks of the map that were found to be one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Merge {
    /// The one that stays.
    pub kept: LandmarkId,
    /// The one that left the map.
    pub removed: LandmarkId,
}

impl<Z: Manifold<Scalar = f64>> StepReport<Z>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// How many observations corrected the state.
    pub fn n_accepted(&self) -> usize {
        self.count(|outcome| matches!(outcome, Outcome::Accepted { .. }))
    }
    /// How many observations were refused as outliers, duplicates or unusable.
    pub fn n_rejected(&self) -> usize {
        self.count(|outcome| {
            matches!(outcome, Outcome::Rejected { .. } | Outcome::Duplicate { .. } | Outcome::Unusable)
        })
    }
    /// Innovations of the observations that corrected the state.
    pub fn innovations(&self) -> impl Iterator<Item = &Innovation<Z>> {
        self.outcomes.iter().filter_map(|outcome| match outcome {
            Outcome::Accepted { innovation, .. } => Some(innovation),
            _ => None,
        })
    }
    fn count(&self, holds: impl Fn(&Outcome<Z>) -> bool) -> usize {
        self.outcomes.iter().filter(|outcome| holds(outcome)).count()
    }
}
