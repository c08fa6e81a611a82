use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use super::{AppearanceMap, PlaceComponent};
use crate::{Descriptor, ReferenceId, ReferenceSearch};

/// Weight from which on a place was seen more than once: twice the learning rate, about.
const WELL_KNOWN: f64 = 0.5;

impl<D: Descriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// Whether it is well known what the robot would see there: whether a reference that counts, seen more than once, has a place within `radius` of
    /// the belief, and neither the place nor the belief is in doubt by more.
    pub(crate) fn has_confirmed_place_near(
        &self,
        belief: &Gaussian<Pose2<f64>>,
        radius: f64,
        counts: impl Fn(ReferenceId) -> bool,
    ) -> bool {
        let sigma = |gaussian: &Gaussian<Pose2<f64>>| gaussian.sigmas().xy().norm();
        let own = sigma(belief);
        let is_there =
            |place: &PlaceComponent| place.weight >= WELL_KNOWN && own.hypot(sigma(&place.gaussian)) < radius;
        self.has_place(belief.mean(), radius, |id, place| counts(id) && is_there(place))
    }

    /// Whether a reference that counts has a place within `radius` whose heading is known to `sigma`.
    pub(crate) fn has_known_heading_near(
        &self,
        at: &Pose2<f64>,
        (radius, sigma): (f64, f64),
        counts: impl Fn(ReferenceId) -> bool,
    ) -> bool {
        self.has_place(at, radius, |id, place| counts(id) && place.gaussian.sigmas().z <= sigma)
    }

    /// Whether some reference has a place within `radius` that will do.
    fn has_place(
        &self,
        at: &Pose2<f64>,
        radius: f64,
        will_do: impl Fn(ReferenceId, &PlaceComponent) -> bool,
    ) -> bool {
        let is_near =
            |place: &PlaceComponent| (place.gaussian.mean().translation - at.translation).norm() < radius;
        self.grid.near(&at.translation, radius).iter().any(|id| {
            let places = self.reference(*id).map_or(&[][..], |reference| &reference.places);
            places.iter().any(|place| is_near(place) && will_do(*id, place))
        })
    }
}
