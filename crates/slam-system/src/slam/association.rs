use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_slam_ekf::{
    AnyAssociation, JointCompatibility, JointCompatibilityParams, KnownIdAssociation, NearestNeighbour,
    NearestNeighbourParams, SlamError,
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

impl AssociationRule {
    /// The rule with its thresholds.
    ///
    /// # Errors
    /// Returns an error if a threshold is out of range.
    pub(crate) fn with(
        self,
        nearest_neighbour: NearestNeighbourParams,
        joint_compatibility: JointCompatibilityParams,
    ) -> Result<AnyAssociation, SlamError> {
        Ok(match self {
            Self::Known => AnyAssociation::Known(KnownIdAssociation),
            Self::Nn => AnyAssociation::NearestNeighbour(NearestNeighbour::new(nearest_neighbour)?),
            Self::Jcbb => AnyAssociation::JointCompatibility(JointCompatibility::new(joint_compatibility)?),
        })
    }

    pub(super) fn of(association: &AnyAssociation) -> Self {
        match association {
            AnyAssociation::Known(_) => Self::Known,
            AnyAssociation::NearestNeighbour(_) => Self::Nn,
            AnyAssociation::JointCompatibility(_) => Self::Jcbb,
        }
    }
}
