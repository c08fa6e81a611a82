use std::ops::Range;

use nalgebra::DVector;

use super::area::CompressedCovariance;

impl CompressedCovariance {
    /// As [`JointCovariance::remove`](crate::covariance::JointCovariance::remove). The influences remain, because they also belong to the rest of the map.
    pub(in crate::covariance) fn remove(&mut self, block: Range<usize>) {
        if let Some(row) = self.rows[block.start] {
            let removed = row..row + block.len();
            self.local.remove(removed.clone());
            for own in self.rows.iter_mut().flatten().chain(self.influences.iter_mut().map(|v| &mut v.row)) {
                if *own >= removed.end {
                    *own -= removed.len();
                }
            }
        }
        self.base.remove(block.clone());
        self.deferred.remove(&block);
        self.schedule.remove(&block);
        self.rows.drain(block.clone());
        for influence in &mut self.influences {
            influence.loadings.drain(block.clone());
        }
        self.lag = std::mem::replace(&mut self.lag, DVector::zeros(0)).remove_rows(block.start, block.len());
        self.area.retain(|state| !block.contains(state));
        for state in self.area.iter_mut().filter(|state| **state >= block.end) {
            *state -= block.len();
        }
    }
}
