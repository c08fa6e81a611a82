use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use crate::ReferenceId;

/// An event of the localizer.
///
/// ```
/// use wayfix_appearance_cml::{LocalizerEvent, ReferenceId};
/// assert_ne!(LocalizerEvent::NewReference(ReferenceId(3)), LocalizerEvent::Forgotten(ReferenceId(3)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LocalizerEvent {
    /// A view has become a reference.
    NewReference(ReferenceId),
    /// A reference was removed from the map.
    Forgotten(ReferenceId),
    /// No component has the minimum weight of a unimodal belief any more.
    Lost,
    /// One component has it again.
    Found,
    /// The most probable pose contradicts odometry: the robot was kidnapped, or the estimate was wrong before.
    Relocated,
}

/// The result of one view.
///
/// ```
/// let nothing = wayfix_appearance_cml::ViewUpdateOutcome { events: Vec::new(), estimate: None, n_detections: 0, best_match: None };
/// assert!(nothing.estimate.is_none());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ViewUpdateOutcome {
    /// The events in order.
    pub events: Vec<LocalizerEvent>,
    /// The pose, if the belief is unimodal.
    pub estimate: Option<Gaussian<Pose2<f64>>>,
    /// Number of places that match the view.
    pub n_detections: usize,
    /// The pose at which this view matches the map best, with covariance in its body frame, before fusion: a measurement for other estimators.
    ///
    /// The belief limits the search, and at the border of the map it chooses the side. Matches with the same references share the errors of their poses.
    pub best_match: Option<Gaussian<Pose2<f64>>>,
}
