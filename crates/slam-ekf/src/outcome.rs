use nalgebra::{DMatrix, DefaultAllocator, allocator::Allocator};
use wayfix_estimation_traits::Manifold;

use crate::{Innovation, LandmarkId};

/// The outcome of one observation.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ObservationOutcome<Z: Manifold<Scalar = f64>>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// It corrected the state.
    Accepted {
        /// Its landmark.
        landmark: LandmarkId,
        /// Its innovation.
        innovation: Innovation<Z>,
        /// Factor on its noise because it is outside the gate; 1 inside.
        noise_scale: f64,
    },
    /// It was associated, but lies outside the gate: an outlier. The state is unchanged.
    Rejected {
        /// The associated landmark.
        landmark: LandmarkId,
        /// Its innovation.
        innovation: Innovation<Z>,
        /// The gate.
        threshold: f64,
    },
    /// It started a new landmark.
    Initialized {
        /// The landmark it started.
        landmark: LandmarkId,
    },
    /// It contradicted a tentative landmark and restarted it.
    Restarted {
        /// The landmark it started.
        landmark: LandmarkId,
    },
    /// It is neither certainly old nor certainly new, and was ignored.
    Ambiguous,
    /// The sensor read no identity and the association needs one.
    Unlabelled,
    /// An earlier observation of this step is of the same landmark.
    Duplicate {
        /// The landmark.
        landmark: LandmarkId,
    },
    /// NaN, infinite, or unusable for the model (a range that is not positive, an invalid noise covariance, a landmark that cannot start or
    /// cannot be observed from here).
    Unusable,
}

impl<Z: Manifold<Scalar = f64>> ObservationOutcome<Z>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// Its name in logs and reports.
    pub fn event_name(&self) -> &'static str {
        match self {
            Self::Accepted { noise_scale, .. } if *noise_scale > 1.0 => "observation_downweighted",
            Self::Accepted { .. } => "observation_accepted",
            Self::Rejected { .. } => "observation_rejected_by_gate",
            Self::Initialized { .. } => "new_landmark",
            Self::Restarted { .. } => "tentative_landmark_restarted",
            Self::Ambiguous => "observation_neither_known_nor_new",
            Self::Unlabelled => "observation_without_identity",
            Self::Duplicate { .. } => "observation_duplicate",
            Self::Unusable => "observation_unusable",
        }
    }
}

/// The outcome of every observation of a step, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct UpdateReport<Z: Manifold<Scalar = f64>>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// One outcome per observation.
    pub outcomes: Vec<ObservationOutcome<Z>>,
    /// Merged landmarks.
    pub merges: Vec<LandmarkMerge>,
}

/// Two landmarks of the map that were merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LandmarkMerge {
    /// The one that remains.
    pub kept: LandmarkId,
    /// The one that was removed.
    pub removed: LandmarkId,
}

/// The innovation of a measurement of the robot alone.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotInnovation {
    /// Normalized innovation squared.
    pub nis: f64,
    /// $`H`$ by the robot's tangent coordinates.
    pub jacobian: DMatrix<f64>,
    /// $`S`$: the innovation covariance.
    pub covariance: DMatrix<f64>,
}

impl<Z: Manifold<Scalar = f64>> UpdateReport<Z>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// Number of observations that corrected the state.
    pub fn n_accepted(&self) -> usize {
        self.count(|outcome| matches!(outcome, ObservationOutcome::Accepted { .. }))
    }
    /// Number of observations refused as outliers, duplicates or unusable.
    pub fn n_rejected(&self) -> usize {
        self.count(|outcome| {
            matches!(
                outcome,
                ObservationOutcome::Rejected { .. }
                    | ObservationOutcome::Duplicate { .. }
                    | ObservationOutcome::Unusable
            )
        })
    }
    /// Innovations of the observations that corrected the state.
    pub fn innovations(&self) -> impl Iterator<Item = &Innovation<Z>> {
        self.outcomes.iter().filter_map(|outcome| match outcome {
            ObservationOutcome::Accepted { innovation, .. } => Some(innovation),
            _ => None,
        })
    }
    fn count(&self, holds: impl Fn(&ObservationOutcome<Z>) -> bool) -> usize {
        self.outcomes.iter().filter(|outcome| holds(outcome)).count()
    }
}
