use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use super::Start;
use super::anywhere::Anywhere;
use crate::{AppearanceMapError, OdometryNoise, UnimodalParams, propagate, unimodal};

/// Where a belief looks for what the robot sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outlook {
    /// Where it puts the robot, and nowhere else: what agrees with no hypothesis is passed over.
    Nearby,
    /// In the whole map, when nothing nearby is seen.
    Map,
    /// In the whole map, and for places that look less alike as well, until it believes in one: it began from nothing in a robot that knows to be lost.
    Lost,
}

/// Where a robot may be, and how much of the weight is left for all other places.
#[derive(Clone, Debug)]
pub(super) struct Belief {
    /// The heaviest component first; `None` when the robot may be anywhere.
    pub(super) state: Option<GaussianMixture<Pose2<f64>>>,
    pub(super) anywhere: Anywhere,
    pub(super) outlook: Outlook,
}

impl Belief {
    /// Nothing is known.
    pub(super) fn nowhere(outlook: Outlook) -> Self {
        Self { state: None, anywhere: Anywhere::everything(), outlook }
    }

    pub(super) fn of_start(start: Start) -> Result<Self, AppearanceMapError> {
        let state = start.into_state()?;
        Ok(match state {
            Some(_) => Self { state, anywhere: Anywhere::nothing(), outlook: Outlook::Map },
            None => Self::nowhere(Outlook::Lost),
        })
    }

    /// The heaviest hypothesis alone, looked for where it is.
    pub(super) fn heaviest_alone(&self) -> Self {
        let alone =
            |heaviest: &Gaussian<_>| GaussianMixture::from_log_weights(vec![(0.0, heaviest.clone())]).ok();
        let state = self.heaviest().and_then(alone);
        Self { state, anywhere: Anywhere::nothing(), outlook: Outlook::Nearby }
    }

    pub(super) fn components(&self) -> &[Gaussian<Pose2<f64>>] {
        self.state.as_ref().map_or(&[], GaussianMixture::components)
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
    ) -> Result<Self, AppearanceMapError> {
        let Some(state) = &self.state else { return Ok(self.clone()) };
        let moved = state.log_weights().iter().zip(state.components()).map(|(log_weight, component)| {
            propagate(component, increment, noise).map(|moved| (*log_weight, moved))
        });
        let moved: Result<Vec<_>, AppearanceMapError> = moved.collect();
        Ok(Self { state: Some(GaussianMixture::from_log_weights(moved?)?), ..*self })
    }
}
