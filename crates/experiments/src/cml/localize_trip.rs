use anyhow::Result;
use nalgebra::Vector3;
use wayfix_appearance_cml::{LocalizerEvent, LocalizerParams, StartPosePrior};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;
use wayfix_system_core::Stopwatch;
use wayfix_systems::cml::{PanoramaLocalizer, PanoramaMap};

use super::SimulatedDrive;

/// Standard deviations of a pose surveyed by hand, m, m and rad.
const SURVEYED: [f64; 3] = [0.02, 0.02, 0.01];

/// Results of a drive, view by view.
#[derive(Clone, Debug, Default)]
pub(crate) struct SimulatedDriveResult {
    /// The heaviest hypothesis, if there is any.
    pub estimates: Vec<Option<Pose2<f64>>>,
    /// Distance from the truth, metres; infinite without an estimate.
    pub errors: Vec<f64>,
    /// References in the map.
    pub n_references: Vec<usize>,
    /// Computing time of prediction and update, seconds.
    pub step_s: Vec<f64>,
    /// Number of times that the belief lost its one dominant mode.
    pub n_lost: usize,
    /// Number of relocations of the estimate.
    pub n_relocated: usize,
}

/// Drives a localizer along a trip.
///
/// # Errors
/// Returns an error if it refuses a step.
pub(crate) fn localize_trip(
    localizer: &mut PanoramaLocalizer,
    trip: &SimulatedDrive,
) -> Result<SimulatedDriveResult> {
    let mut course = SimulatedDriveResult::default();
    for step in &trip.steps {
        let stopwatch = Stopwatch::start();
        if let Some(odometry) = &step.odometry {
            localizer.predict(odometry)?;
        }
        let outcome = step.view.clone().map(|view| localizer.update(view)).transpose()?;
        course.step_s.push(stopwatch.elapsed().as_secs_f64());
        for event in outcome.into_iter().flat_map(|outcome| outcome.events) {
            course.n_lost += usize::from(event == LocalizerEvent::Lost);
            course.n_relocated += usize::from(event == LocalizerEvent::Relocated);
        }
        let estimate = localizer.estimate().map(|estimate| *estimate.mean());
        let error = |pose: Pose2<f64>| (pose.translation - step.pose.translation).norm();
        course.errors.push(estimate.map_or(f64::INFINITY, error));
        course.estimates.push(estimate);
        course.n_references.push(localizer.map().len());
    }
    Ok(course)
}

/// A map taught with the true poses of a trip: "manually corrected odometric data".
pub(super) fn taught(trip: &SimulatedDrive) -> Result<PanoramaMap> {
    let mut teacher = PanoramaLocalizer::new(LocalizerParams::default(), StartPosePrior::Anywhere)?;
    for step in &trip.steps {
        if let Some(view) = &step.view {
            teacher.teach(view.clone(), &surveyed(step.pose)?)?;
        }
    }
    Ok(teacher.into_map())
}

/// A start that was measured by hand.
pub(super) fn known_start(trip: &SimulatedDrive) -> Result<StartPosePrior> {
    Ok(match trip.steps.first() {
        Some(first) => StartPosePrior::Known(surveyed(first.pose)?),
        None => StartPosePrior::Anywhere,
    })
}

pub(super) fn surveyed(pose: Pose2<f64>) -> Result<Gaussian<Pose2<f64>>> {
    Ok(Gaussian::from_sigmas(pose, &Vector3::from(SURVEYED))?)
}
