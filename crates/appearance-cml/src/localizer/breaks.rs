use super::AppearanceLocalizer;
use crate::{Descriptor, ReferenceSearch};

/// A view that is strange to the one before, over no more than a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Break {
    /// Way since then, m.
    pub(super) way: f64,
    /// Whether nothing was known before it.
    pub(super) exploring: bool,
    /// Whether the view before was as strange to the one before it. Who is carried sees one such step; at a corner or past the end of a shelf there may be
    /// several in a row.
    pub(super) repeated: bool,
}

/// Steps between two views up to which they look alike, unless there is a break.
const MOST_STEPS: f64 = 1.5;

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// Whether the view is as strange to the one before as one of a far place, although the wheels say that it is a step away. Who is carried sees it, or
    /// is blind meanwhile; who drives into an aisle that was rearranged does not.
    pub(super) fn is_break(&self, view: &D) -> bool {
        let scale = self.map.scale();
        let is_near = self.motion.increment.translation.norm() <= MOST_STEPS * scale.step();
        let strange = |last: &D| view.compare(last).distance > scale.distinct_view_distance();
        is_near && self.last_seen.as_ref().is_some_and(strange)
    }
}
