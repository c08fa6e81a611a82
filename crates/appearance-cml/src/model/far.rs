use wayfix_estimation_traits::{Pose2, wrap_angle};
use wayfix_gaussian_core::Gaussian;

use super::interpolate::MAX_TURN;
use super::{AppearanceMap, AppearanceMapParams, PlaceComponent};
use crate::{ReferenceId, ReferenceSearch, ViewDescriptor};

/// Number of references of the whole map that a view is compared with. With the half dozen references of one place, a view of another place
/// recognizes it in one case of ten.
pub(crate) const N_FAR: usize = 64;

/// A view compared with the references of one place and of far places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlaceTest {
    /// Whether a reference of the place, with its heading, is nearer to the view than all those of far places.
    pub(crate) is_recognized: bool,
    /// Probability of that in a view of another place: $`k/(k+n)`$, because there the ranks of $`k + n`$ references are exchangeable.
    pub(crate) chance: f64,
}

impl<D: ViewDescriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// Differences of the view from `n` references, spread evenly over the map. They are others with each `turn`.
    pub(crate) fn sample(&self, view: &D, turn: u32, n: usize) -> Vec<(ReferenceId, f64)> {
        // The bit-reversed numbers of van der Corput spread any stretch of successive numbers evenly.
        let id = |k: usize| {
            let reversed = turn.wrapping_mul(n as u32).wrapping_add(k as u32).reverse_bits();
            ReferenceId(((u64::from(reversed) * u64::from(self.next_id())) >> u32::BITS) as u32)
        };
        let reference = |k: usize| self.references().range(id(k)..).next().map(|(id, _)| *id);
        let difference = |id: ReferenceId| Some((id, view.compare(self.search().get(id)?).distance));
        (0..n).filter_map(reference).filter_map(difference).collect()
    }

    /// Those of a [`sample`](Self::sample) whose places are all far from `pose`.
    pub(crate) fn far_from<'a>(
        &'a self,
        pose: &'a Pose2<f64>,
        sample: &'a [(ReferenceId, f64)],
    ) -> impl Iterator<Item = f64> + 'a {
        let far = self.scale().far_distance();
        let is_far = move |place: &PlaceComponent| distance(place, pose) > far;
        let are_far = move |id: ReferenceId| self.reference(id).is_some_and(|r| r.places.iter().all(is_far));
        sample.iter().filter(move |(id, _)| are_far(*id)).map(|(_, difference)| *difference)
    }

    /// Tests the view at a hypothesis; `None` if the map has no places there or far away, or if the pose is too uncertain.
    ///
    /// The references of the hypothesis lie within half of the match radius.
    pub(crate) fn test_place(
        &self,
        view: &D,
        hypothesis: &Gaussian<Pose2<f64>>,
        sample: &[(ReferenceId, f64)],
        params: &AppearanceMapParams,
    ) -> Option<PlaceTest> {
        let at = hypothesis.mean();
        let (mut n_far, mut nearest_far) = (0, f64::INFINITY);
        for difference in self.far_from(at, sample) {
            (n_far, nearest_far) = (n_far + 1, nearest_far.min(difference));
        }
        let radius = self.match_radius(params) / 2.0;
        let sigma = |gaussian: &Gaussian<Pose2<f64>>| gaussian.sigmas().xy().norm();
        let own = sigma(hypothesis);
        let is_there = |place: &PlaceComponent| {
            distance(place, at) <= radius && own.hypot(sigma(&place.gaussian)) <= radius
        };
        let place = |id: ReferenceId| self.reference(id)?.places.iter().find(|place| is_there(place));
        let near: Vec<ReferenceId> =
            self.near(hypothesis, radius).into_iter().filter(|id| place(*id).is_some()).collect();
        let is_recognized = self.search().within_among(view, &near, nearest_far).iter().any(|matched| {
            let Some(place) = place(matched.id) else { return false };
            let heading = place.gaussian.mean().heading() + matched.comparison.rotation;
            wrap_angle(heading - at.heading()).abs() <= MAX_TURN + 2.0 * hypothesis.sigmas().z
        });
        let n_near = near.len();
        let chance = n_near as f64 / (n_near + n_far) as f64;
        (n_near > 0 && n_far > 0).then_some(PlaceTest { is_recognized, chance })
    }
}

fn distance(place: &PlaceComponent, pose: &Pose2<f64>) -> f64 {
    (place.gaussian.mean().translation - pose.translation).norm()
}
