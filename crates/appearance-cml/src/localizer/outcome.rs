use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use crate::ReferenceId;

/// Something that a user of the localizer may want to hear of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// A view has become a reference.
    NewReference(ReferenceId),
    /// A reference is no longer in the map.
    Forgotten(ReferenceId),
    /// The state was one place and is several, or too wide.
    Lost,
    /// The state is one place, and was not.
    Found,
    /// The state is one place, but not the one where odometry would have it: the robot was carried, or had been lost unnoticed.
    Relocated,
}

/// What one view has done.
#[derive(Clone, Debug, PartialEq)]
pub struct UpdateOutcome {
    /// In the order in which they happened.
    pub events: Vec<Event>,
    /// The pose, when the state is one place.
    pub estimate: Option<Gaussian<Pose2<f64>>>,
    /// How many places of the map looked like the view.
    pub n_sightings: usize,
}
