use nalgebra::DefaultAllocator;

use crate::{EkfSlam, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// Numbers for landmarks that a rule starts, each used once.
#[derive(Clone, Debug, Default)]
pub(super) struct NewIds {
    next: u32,
}

impl NewIds {
    /// Numbers from `next` on.
    pub(super) fn from(next: u32) -> Self {
        Self { next }
    }

    /// The smallest number that is still unused.
    pub(super) fn next(&self) -> u32 {
        self.next
    }

    pub(super) fn next_free<M: LandmarkModel>(&mut self, filter: &EkfSlam<M>) -> LandmarkId
    where
        DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
    {
        while filter.contains(LandmarkId(self.next)) {
            self.next = self.next.wrapping_add(1);
        }
        let free = LandmarkId(self.next);
        self.next = self.next.wrapping_add(1);
        free
    }
}
