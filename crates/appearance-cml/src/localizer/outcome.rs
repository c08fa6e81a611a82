use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use crate::ReferenceId;

/// An event of the localizer.
///
/// ```
/// # use nalgebra::{Matrix2, Vector2};
/// # use wayfix_appearance_cml::{AppearanceLocalizer, LinearSearch, LocalizerEvent};
/// # use wayfix_appearance_cml::{LocalizerParams, PanoramaDescriptor, PositionFix, StartPosePrior};
/// # let view = || PanoramaDescriptor::from_parts(0.01, 1, vec![3, 20, 0]);
/// # let mut robot = AppearanceLocalizer::<PanoramaDescriptor, LinearSearch<_>>::new(LocalizerParams::default(), StartPosePrior::Anywhere)?;
/// let fix = PositionFix { position: Vector2::new(3.0, 4.0), covariance: Matrix2::identity() * 1e-4, weight: 0.9 };
/// assert_eq!(robot.update_with(view()?, &[&fix])?.events, [LocalizerEvent::Found]); // 0.9 of the belief is there, 0.8 suffice
/// assert!(robot.update_with(view()?, &[&fix])?.events.is_empty()); // reported once
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
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
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{AppearanceLocalizer, LinearSearch, LocalizerParams, PanoramaDescriptor, StartPosePrior};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let view = PanoramaDescriptor::from_parts(0.01, 1, vec![3, 20, 0])?;
/// # let start = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 0.0), &Vector3::new(0.02, 0.02, 0.01))?;
/// # let start = StartPosePrior::Known(start);
/// let mut robot = AppearanceLocalizer::<PanoramaDescriptor, LinearSearch<_>>::new(LocalizerParams::default(), start)?;
/// let outcome = robot.update(view)?; // the first one: nothing in the map can match
/// assert_eq!((outcome.n_detections, outcome.best_match), (0, None));
/// assert_eq!(outcome.estimate.map(|pose| pose.mean().x()), Some(1.0)); // from the start alone
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
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
