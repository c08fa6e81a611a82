use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, Mixture};

use super::Start;
use super::anywhere::Anywhere;
use crate::{AppearanceError, OdometryNoise, UnimodalParams, propagate, unimodal};

/// Where a robot may be, and how much of the weight is left for all other places.
#[derive(Clone, Debug)]
pub(super) struct Belief {
    /// The heaviest component first; `None` when the robot may be anywhere.
    pub(super) state: Option<Mixture<Pose2<f64>>>,
    pub(super) anywhere: Anywhere,
    /// Whether it began from nothing in a robot that knows to be lost, and so looks for places that look less alike as well.
    pub(super) is_of_lost: bool,
}

impl Belief {
    /// Nothing is known.
    pub(super) fn nowhere(is_of_lost: bool) -> Self {
        Self { state: None, anywhere: Anywhere::everything(), is_of_lost }
    }

    pub(super) fn of_start(start: Start) -> Result<Self, AppearanceError> {
        let state = start.into_state()?;
        let is_of_lost = state.is_none();
        let anywhere = if is_of_lost { Anywhere::everything() } else { Anywhere::nothing() };
        Ok(Self { state, anywhere, is_of_lost })
    }

    pub(super) fn components(&self) -> &[Gaussian<Pose2<f64>>] {
        self.state.as_ref().map_or(&[], Mixture::components)
    }

    pub(super) fn heaviest(&self) -> Option<&Gaussian<Pose2<f64>>> {
        // It comes first since the mixture is simplified after each view, and odometry changes no weight.
        self.components().first()
    }

    /// The pose, when the state is one place.
    pub(super) fn one_place(&self, params: &UnimodalParams) -> Option<&Gaussian<Pose2<f64>>> {
        let state = self.state.as_ref().filter(|_| self.anywhere.is_little());
        state.and_then(|state| unimodal(state, params))
    }

    /// After the robot has moved. [Gross et al. 2005, Eq. 1]
    pub(super) fn moved(
        &self,
        increment: &Pose2<f64>,
        noise: &OdometryNoise,
    ) -> Result<Self, AppearanceError> {
        let Some(state) = &self.state else { return Ok(self.clone()) };
        let moved = state.log_weights().iter().zip(state.components()).map(|(log_weight, component)| {
            propagate(component, increment, noise).map(|moved| (*log_weight, moved))
        });
        let moved: Result<Vec<_>, AppearanceError> = moved.collect();
        Ok(Self { state: Some(Mixture::from_log_weights(moved?)?), ..*self })
    }
}
