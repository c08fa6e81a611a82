/// The linearization points of the filter, which decide whether it stays consistent.
///
/// No measurement of landmarks from the robot changes when robot and map move together. A filter that linearizes at its newest estimate
/// combines Jacobians at different points, whose null spaces differ: it gains spurious information about the common heading and becomes
/// overconfident on long loops. [Andrade-Cetto 2005, Sec. 2.2; Huang et al. 2010]
///
/// The last two need a model with symmetries ([`LandmarkModel::symmetries`](crate::LandmarkModel::symmetries)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LinearizationPoint {
    /// The standard filter: every derivative at the newest estimate.
    #[default]
    Newest,
    /// First-estimates Jacobians: at the first estimate of each landmark and the prediction of the robot. [Huang et al. 2010, section 4]
    FirstEstimates,
    /// The right-invariant filter: derivatives at the newest estimate, with errors that move with the world, so that the null space is the
    /// same at every estimate. [Barrau & Bonnabel 2015; Zhang et al. 2017]
    Invariant,
}
