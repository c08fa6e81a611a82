use std::{collections::BTreeSet, ops::Range};

use nalgebra::DVector;

use super::area::CompressedCovariance;

impl CompressedCovariance {
    /// As [`JointCovariance::remove`](crate::covariance::JointCovariance::remove).
    pub(in crate::covariance) fn remove(&mut self, block: Range<usize>) {
        if self.influences.iter().any(|influence| block.contains(&influence.state)) {
            // The rest of the map depends on it: that has to be worked off first.
            let others: BTreeSet<usize> =
                self.area.iter().copied().filter(|state| !block.contains(state)).collect();
            self.restart(&others);
        }
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
        self.backlog.remove(&block);
        self.schedule.remove(&block);
        self.rows.drain(block.clone());
        self.lag = std::mem::replace(&mut self.lag, DVector::zeros(0)).remove_rows(block.start, block.len());
        self.area.retain(|state| !block.contains(state));
        for state in self.area.iter_mut().chain(self.influences.iter_mut().map(|v| &mut v.state)) {
            if *state >= block.end {
                *state -= block.len();
            }
        }
    }
}
