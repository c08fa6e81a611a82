use std::ops::Range;

use super::{area::CompressedCovariance, passive::OutsideBlock};

impl CompressedCovariance {
    /// Moves a landmark block into the area. Only its storage changes, not its value.
    pub(super) fn activate(&mut self, states: Range<usize>) {
        if self.rows[states.start].is_some() {
            return;
        }
        self.deferred.settle(states.clone(), &mut self.base);
        let OutsideBlock { with_local, own } = self.outside_block(states.clone());
        for state in states.clone() {
            self.lag[state] += self.influenced(state);
        }
        let (start, size) = (self.local.dimension(), states.len());
        self.local.extend_with_zeros(size);
        let mut local = self.local.matrix_mut();
        local.view_mut((0, start), (start, size)).copy_from(&with_local);
        local.view_mut((start, 0), (size, start)).copy_from(&with_local.transpose());
        local.view_mut((start, start), (size, size)).copy_from(&own);
        for (i, state) in states.clone().enumerate() {
            self.rows[state] = Some(start + i);
            self.area.push(state);
        }
        self.add_influences(&states.collect::<Vec<_>>());
    }
}
