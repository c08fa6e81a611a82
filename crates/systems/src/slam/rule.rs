use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
