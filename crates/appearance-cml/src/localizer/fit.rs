use wayfix_estimation_traits::{Pose2, wrap_angle};

use super::AppearanceLocalizer;
use super::belief::Belief;
use crate::{Descriptor, ReferenceSearch};

/// How a view fits the place where a belief puts the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    /// No reference is known to be there for certain, or hardly any elsewhere: nothing can be said.
    Unknown,
    /// References are there, and the view looks no more like them than like those of some other places.
    Missed,
    /// Some reference there is nearer to the view than all that it was compared with elsewhere.
    Recognized,
}

/// A heading that differs by more, and by more than the belief is in doubt, is not the same, rad.
pub(super) const HERE_TURN: f64 = 0.35;
/// σ of a belief within which it may be.
pub(super) const GATE_SIGMAS: f64 = 3.0;

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// How the view fits the heaviest hypothesis of a belief.
    ///
    /// What a distance is worth differs from view to view: before bare shelves many places of a map look alike. So a view is measured by what *it* finds
    /// in far places, by rank: at a wrong pose the best of $`k`$ references is nearer than $`n`$ others in $`k/(k+n)`$ of the views.
    pub(super) fn fit(&self, view: &D, belief: &Belief) -> Fit {
        let Some(heaviest) = belief.heaviest() else { return Fit::Unknown };
        let (at, sigmas) = (heaviest.mean(), heaviest.sigmas());
        let reach = self.map.match_radius(&self.params.map);
        let Some(limit) = self.map.least_distance_to_far(view, at, self.views) else { return Fit::Unknown };
        let is_here = |place: &Pose2<f64>| {
            (place.translation - at.translation).norm() <= reach + GATE_SIGMAS * sigmas.xy().norm()
                && wrap_angle(place.heading() - at.heading()).abs() <= HERE_TURN + GATE_SIGMAS * sigmas.z
        };
        let near =
            self.apart_from_trail(self.map.place_matches_near(view, std::slice::from_ref(heaviest), limit));
        if near.iter().any(|s| is_here(s.gaussian.mean())) {
            Fit::Recognized
        } else if self.map.has_confirmed_place_near(heaviest, reach, |id| !self.trail.holds(id)) {
            Fit::Missed
        } else {
            Fit::Unknown
        }
    }
}
