use nalgebra::DefaultAllocator;

use super::{Association, DataAssociation, JointCompatibility, KnownIdAssociation, NearestNeighbour};
use crate::{EkfSlam, LandmarkDim, LandmarkModel, MeasurementDim, Observation, RobotDim, SlamAlloc};

/// A rule of association that is chosen at run time.
#[derive(Clone, Debug)]
pub enum AnyAssociation {
    /// By the identity that the sensor reads.
    Known(KnownIdAssociation),
    /// The nearest compatible landmark.
    NearestNeighbour(NearestNeighbour),
    /// The largest compatible set of pairs.
    JointCompatibility(JointCompatibility),
}

impl AnyAssociation {
    /// The identity of the next new landmark; `None` where the sensor reads identities.
    pub fn next_id(&self) -> Option<u32> {
        match self {
            Self::Known(_) => None,
            Self::NearestNeighbour(rule) => Some(rule.next_id()),
            Self::JointCompatibility(rule) => Some(rule.next_id()),
        }
    }

    /// The same rule with this identity for the next new landmark.
    pub fn numbering_from(self, next_id: Option<u32>) -> Self {
        match (self, next_id) {
            (Self::NearestNeighbour(rule), Some(id)) => Self::NearestNeighbour(rule.numbering_from(id)),
            (Self::JointCompatibility(rule), Some(id)) => Self::JointCompatibility(rule.numbering_from(id)),
            (rule, _) => rule,
        }
    }
}

impl<M: LandmarkModel> DataAssociation<M> for AnyAssociation
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    fn associate(
        &mut self,
        filter: &EkfSlam<M>,
        observations: &[Observation<M::Measurement>],
    ) -> Vec<Association> {
        match self {
            Self::Known(rule) => rule.associate(filter, observations),
            Self::NearestNeighbour(rule) => rule.associate(filter, observations),
            Self::JointCompatibility(rule) => rule.associate(filter, observations),
        }
    }
}
