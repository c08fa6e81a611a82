use std::{collections::BTreeSet, ops::Range};

use super::{area::CompressedCovariance, work};

/// What the current look needed, and what it cost so far to have an area that is larger than needed.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    /// States that this look observed, and those of the robot.
    needed: BTreeSet<usize>,
    n_robot_states: usize,
    /// Rows that this look corrected with.
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
    /// Housekeeping after a look: works off some of the backlog, or starts the area anew when that pays.
    ///
    /// With its influences an area is twice as large as what it covers, and a correction costs the square: it pays from a quarter of the map down.
    ///
    /// Rent or buy: a too large area costs a little in every look, a new one costs once. Changing when the rents have
    /// added up to the price costs at most twice what is best, whatever comes. It waits for the backlog, which is worked off with
    /// as much work a look as the look itself was, so that no look is much longer than others.
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
