/// Where the filter linearizes, and with that whether it stays consistent.
///
/// No sensor that sees landmarks from the robot can tell when robot and map move together. A filter that linearizes at its newest
/// estimate mixes derivatives taken at different places, in which that freedom has different directions: it learns something about the
/// common heading from nothing, and becomes overconfident on long loops. [Andrade-Cetto 2003, section 2.2; Huang et al. 2010]
///
/// The last two need a model that says what its symmetry is ([`LandmarkModel::symmetries`](crate::LandmarkModel::symmetries)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Linearization {
    /// The standard filter: every derivative at the newest estimate.
    #[default]
    Newest,
    /// First-estimates Jacobians: landmarks where they were first placed, the robot where it was predicted. [Huang et al. 2010, section 4]
    FirstEstimates,
    /// The right-invariant filter: derivatives at the newest estimate, but the errors it estimates are moved along with the world, so that
    /// the freedom has the same direction at every estimate. [Barrau & Bonnabel 2015; Zhang et al. 2017]
    Invariant,
}
