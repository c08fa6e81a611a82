use clap::ValueEnum;
use nalgebra::DefaultAllocator;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_slam_ekf::{
    Association, DataAssociation, EkfSlam, JointCompatibility, JointCompatibilityParams, KnownIdAssociation,
    LandmarkDim, LandmarkModel, MeasurementDim, NearestNeighbour, NearestNeighbourParams, Observation,
    RobotDim, SlamAlloc, SlamError,
};

/// How detections find their landmarks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum AssociationRule {
    /// By the identity that the sensor reads.
    Known,
    /// Individual-compatibility nearest neighbour with two thresholds.
    Nn,
    /// Joint compatibility branch and bound.
    Jcbb,
}

/// The rule of association that a run chose.
pub(crate) enum ChosenRule {
    Known(KnownIdAssociation),
    NearestNeighbour(NearestNeighbour),
    JointCompatibility(JointCompatibility),
}

impl ChosenRule {
    /// # Errors
    /// Returns an error if a threshold is out of range.
    pub(crate) fn new(
        rule: AssociationRule,
        nearest_neighbour: NearestNeighbourParams,
        joint_compatibility: JointCompatibilityParams,
    ) -> Result<Self, SlamError> {
        Ok(match rule {
            AssociationRule::Known => Self::Known(KnownIdAssociation),
            AssociationRule::Nn => Self::NearestNeighbour(NearestNeighbour::new(nearest_neighbour)?),
            AssociationRule::Jcbb => Self::JointCompatibility(JointCompatibility::new(joint_compatibility)?),
        })
    }

    pub(super) fn rule(&self) -> AssociationRule {
        match self {
            Self::Known(_) => AssociationRule::Known,
            Self::NearestNeighbour(_) => AssociationRule::Nn,
            Self::JointCompatibility(_) => AssociationRule::Jcbb,
        }
    }

    /// The identity of the next new landmark; `None` where the sensor reads identities.
    pub(super) fn next_id(&self) -> Option<u32> {
        match self {
            Self::Known(_) => None,
            Self::NearestNeighbour(rule) => Some(rule.next_id()),
            Self::JointCompatibility(rule) => Some(rule.next_id()),
        }
    }

    /// The same rule with this identity for the next new landmark.
    pub(super) fn numbering_from(self, next_id: Option<u32>) -> Self {
        match (self, next_id) {
            (Self::NearestNeighbour(rule), Some(id)) => Self::NearestNeighbour(rule.numbering_from(id)),
            (Self::JointCompatibility(rule), Some(id)) => Self::JointCompatibility(rule.numbering_from(id)),
            (rule, _) => rule,
        }
    }
}

impl<M: LandmarkModel> DataAssociation<M> for ChosenRule
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
