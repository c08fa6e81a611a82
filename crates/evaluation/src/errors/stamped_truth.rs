use wayfix_sensor_log::Stamp;

/// True values in the order of time. Of a long log those stay that estimates are compared with.
#[derive(Clone, Debug)]
pub(super) struct StampedTruth<T> {
    values: Vec<(Stamp, T)>,
    /// Number of values at which they are thinned next.
    thin_at: usize,
}

/// Number of values that are never thinned.
const MOST: usize = 1 << 17;
/// Estimates come at most this long after the record of their stamp, and truth after them, ns.
pub(super) const LONGEST_DELAY: u64 = 60_000_000_000;

impl<T> StampedTruth<T> {
    /// Adds a value, unless it goes back in time.
    pub(super) fn push(&mut self, stamp: Stamp, value: T) {
        if self.values.last().is_none_or(|(last, _)| *last < stamp) {
            self.values.push((stamp, value));
        }
    }

    /// Drops the values that are not next to one of `estimates`, once there are many. Estimates to come are at or after `now`, less a minute.
    pub(super) fn thin(&mut self, now: Stamp, estimates: impl Iterator<Item = Stamp>) {
        if self.values.len() < self.thin_at.max(MOST) {
            return;
        }
        let mut is_kept = vec![false; self.values.len()];
        for stamp in estimates {
            let after = self.at_or_after(stamp);
            is_kept.iter_mut().take(after + 1).skip(after.saturating_sub(1)).for_each(|kept| *kept = true);
        }
        let open = self.at_or_after(Stamp::from_nanoseconds(now.nanoseconds().saturating_sub(LONGEST_DELAY)));
        is_kept[0] = true; // where the truth begins
        is_kept[open.saturating_sub(1)..].fill(true);
        let mut is_kept = is_kept.into_iter();
        self.values.retain(|_| is_kept.next() == Some(true));
        self.thin_at = 2 * self.values.len();
    }

    /// Index of the first value at or after a stamp.
    pub(super) fn at_or_after(&self, stamp: Stamp) -> usize {
        self.values.partition_point(|(known, _)| *known < stamp)
    }

    /// All values.
    pub(super) fn values(&self) -> &[(Stamp, T)] {
        &self.values
    }
}

impl<T> Default for StampedTruth<T> {
    fn default() -> Self {
        Self { values: Vec::new(), thin_at: MOST }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn truth_stays_around_estimates_and_does_not_grow() {
        let at = |index: usize| Stamp::from_nanoseconds(1_000_000 * index as u64);
        let (mut truth, mut longest) = (StampedTruth::default(), 0);
        let n = 3_000_000;
        let estimates: Vec<usize> = (0..n).step_by(10_007).collect();
        for index in 0..n {
            truth.push(at(index), index);
            truth.push(at(index / 2), 0); // goes back
            truth.thin(
                at(index),
                estimates.iter().map(|index| at(*index)).take_while(|stamp| *stamp <= at(index)),
            );
            longest = longest.max(truth.values.len());
        }
        assert!(longest <= MOST + 1, "{longest}");
        for index in estimates {
            let after = truth.at_or_after(at(index));
            assert_eq!(truth.values[after].1, index);
            assert_eq!(truth.values[after.saturating_sub(1)].1, index.saturating_sub(1));
        }
        assert_eq!((truth.values[0].1, truth.values.last().map(|last| last.1)), (0, Some(n - 1)));
    }
}
