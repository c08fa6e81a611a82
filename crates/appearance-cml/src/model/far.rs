use wayfix_estimation_traits::Pose2;

use super::{AppearanceMap, PlaceComponent};
use crate::{Descriptor, ReferenceId, ReferenceSearch};

/// From how many steps on a place is far.
const FAR_STEPS: f64 = 20.0;
/// References of far places that a view is measured against: the best of the half dozen that are near a wrong pose is nearer than all of them once in
/// ten views or more seldom.
const N_FAR: usize = 64;

impl<D: Descriptor, S: ReferenceSearch<D>> AppearanceMap<D, S> {
    /// Distance of the view to some reference of a far place, another one with each `turn`; `None` when that one is near.
    pub(crate) fn distance_to_far(&self, view: &D, pose: &Pose2<f64>, turn: u32) -> Option<f64> {
        // Multiples of the golden section spread evenly over the numbers.
        let start = (u64::from(turn.wrapping_mul(0x9E37_79B9)) * u64::from(self.next_id())) >> 32;
        let (id, reference) = self.references().range(ReferenceId(start as u32)..).next()?;
        let far = FAR_STEPS * self.scale().step();
        let is_far =
            |place: &PlaceComponent| (place.gaussian.mean().translation - pose.translation).norm() > far;
        let reference = reference.places.iter().all(is_far).then(|| self.search().get(*id)).flatten()?;
        Some(view.compare(reference).distance)
    }

    /// The least distance of the view to [`N_FAR`] references of far places, others with each `turn`; `None` when hardly half of them are far.
    pub(crate) fn least_distance_to_far(&self, view: &D, pose: &Pose2<f64>, turn: u32) -> Option<f64> {
        let turns = (0..N_FAR as u32).map(|k| turn.wrapping_mul(N_FAR as u32).wrapping_add(k));
        let far: Vec<f64> = turns.filter_map(|turn| self.distance_to_far(view, pose, turn)).collect();
        (2 * far.len() >= N_FAR).then(|| far.into_iter().fold(f64::INFINITY, f64::min))
    }
}
