use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use crate::ReferenceId;

/// An event of the localizer.
///
/// ```
/// use wayfix_appearance_cml::{Event, ReferenceId};
/// assert_ne!(Event::NewReference(ReferenceId(3)), Event::Forgotten(ReferenceId(3)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// A view has become a reference.
    NewReference(ReferenceId),
    /// A reference was removed from the map.
    Forgotten(ReferenceId),
    /// The belief is no longer unimodal.
    Lost,
    /// The belief is unimodal again.
    Found,
    /// The most probable pose contradicts odometry: the robot was kidnapped, or the estimate was wrong before.
    Relocated,
}

/// The result of one view.
///
/// ```
/// let nothing = wayfix_appearance_cml::UpdateOutcome { events: Vec::new(), estimate: None, n_detections: 0 };
/// assert!(nothing.estimate.is_none());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct UpdateOutcome {
    /// The events in order.
    pub events: Vec<Event>,
    /// The pose, if the belief is unimodal.
    pub estimate: Option<Gaussian<Pose2<f64>>>,
    /// Number of places that match the view.
    pub n_detections: usize,
}
