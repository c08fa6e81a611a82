//! Data association: one rule per file, all behind [`DataAssociation`].

mod any;
mod candidates;
mod joint_compatibility;
mod joint_innovation;
mod joint_search;
mod known_ids;
mod nearest_neighbour;
mod new_ids;

use nalgebra::DefaultAllocator;

pub use any::AnyAssociation;
pub use joint_compatibility::{JointCompatibility, JointCompatibilityParams};
pub use known_ids::KnownIdAssociation;
pub use nearest_neighbour::{NearestNeighbour, NearestNeighbourParams};

use new_ids::NewIds;

use crate::{
    EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, Observation, RobotDim, SlamAlloc,
};

/// The association of an observation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Association {
    /// A landmark or anchor of the map.
    Matched(LandmarkId),
    /// Certainly not in the map: starts a landmark with this identity.
    New(LandmarkId),
    /// Neither certainly old nor certainly new.
    Ambiguous,
    /// No identity was read, and this rule needs one.
    Unlabelled,
}

/// A rule that associates each observation of one scan with a landmark.
///
/// **Laws**: one association per observation, in order; it depends only on the filter's state and the rule's own state; the filter gates
/// afterwards, so a rule need not.
pub trait DataAssociation<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Associates the usable observations of one scan.
    fn associate(
        &mut self,
        filter: &EkfSlam<M>,
        observations: &[Observation<M::Measurement>],
    ) -> Vec<Association>;
}
