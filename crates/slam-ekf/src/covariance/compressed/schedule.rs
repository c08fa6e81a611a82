use std::{collections::BTreeSet, ops::Range};

use super::{area::CompressedCovariance, work};

/// The states that the current scan needs, and the cost so far of an area that is larger than needed.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    /// States observed by this scan, and those of the robot.
    needed: BTreeSet<usize>,
    n_robot_states: usize,
    /// Rows of this scan's corrections.
    n_rows: usize,
    /// Multiply-adds that a smaller area would have saved since it was chosen.
    rent: f64,
}

impl Schedule {
    pub(super) fn for_robot_states(n: usize) -> Self {
        Self { needed: (0..n).collect(), n_robot_states: n, n_rows: 0, rent: 0.0 }
    }

    pub(super) fn note_landmark(&mut self, states: Range<usize>) {
        self.needed.extend(states);
    }

    pub(super) fn note_rows(&mut self, n: usize) {
        self.n_rows += n;
    }

    pub(super) fn remove(&mut self, block: &Range<usize>) {
        let moved = |state: usize| if state >= block.end { state - block.len() } else { state };
        self.needed =
            self.needed.iter().filter(|state| !block.contains(state)).map(|state| moved(*state)).collect();
    }
}

impl CompressedCovariance {
    /// Housekeeping after a scan: works off some of the backlog, or chooses a new area if that costs less.
    ///
    /// With its influences an area has twice its number of states, and a correction costs the square: it pays up to a quarter of the map.
    ///
    /// Rent or buy: a too large area costs a little in every scan, a new one costs once. A change when the sum of the rents reaches the
    /// price costs at most twice the optimum. It waits for the backlog, which is worked off with as much work per scan as the scan itself
    /// took, so no scan takes much longer than others.
    pub(in crate::covariance) fn end_update(&mut self) {
        let Schedule { n_rows, n_robot_states, .. } = self.schedule;
        let needed = std::mem::replace(&mut self.schedule.needed, (0..n_robot_states).collect());
        self.schedule.n_rows = 0;
        let n = self.rows.len();
        let is_compression_worth_it = 4 * needed.len() <= n;
        let best = if is_compression_worth_it { 2 * needed.len() } else { n };
        let cost = work::correction(self.local.dimension(), n_rows);
        self.schedule.rent += (cost - work::correction(best, n_rows)).max(0.0);
        if !self.deferred.is_done() {
            self.deferred.advance(cost, &mut self.base);
        } else if self.schedule.rent > self.price() {
            if is_compression_worth_it {
                self.restart(&needed);
            } else {
                self.activate_all();
            }
            self.schedule.rent = 0.0;
        }
    }

    fn price(&self) -> f64 {
        work::global_update(self.rows.len(), self.area.len(), self.influences.len())
    }
}
