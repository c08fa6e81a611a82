use std::collections::VecDeque;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::Stamp;

use super::{ReferencePath, stamped_truth::LONGEST_DELAY};

/// Results of a log that wait for the truth at their stamps.
#[derive(Clone, Debug)]
pub struct TruthQueue<T>(VecDeque<(Stamp, T)>);

impl<T> TruthQueue<T> {
    /// Adds the next result.
    pub fn push(&mut self, stamp: Stamp, result: T) {
        self.0.push_back((stamp, result));
    }

    /// The next result, with its true pose if there is one. With `now`, the stamp of the latest record, `None` while the truth may still come: at
    /// most a minute.
    pub fn pop(&mut self, now: Option<Stamp>, truth: &ReferencePath) -> Option<(T, Option<Pose2<f64>>)> {
        let (stamp, _) = self.0.front()?;
        let is_late = |now: Stamp| now.nanoseconds() > stamp.nanoseconds() + LONGEST_DELAY;
        if now.is_some_and(|now| truth.last_stamp() < Some(*stamp) && !is_late(now)) {
            return None;
        }
        self.0.pop_front().map(|(stamp, result)| (result, truth.at(stamp)))
    }
}

impl<T> Default for TruthQueue<T> {
    fn default() -> Self {
        Self(VecDeque::new())
    }
}

#[cfg(test)]
mod tests {
    use std::iter;

    use wayfix_sensor_log::{Record, RecordData};

    use super::*;

    #[test]
    fn each_result_gets_its_truth_and_few_wait() {
        let at = |number: u64| Stamp::from_nanoseconds(100_000_000 * number);
        let (mut queue, mut truth) = (TruthQueue::default(), ReferencePath::default());
        let (mut longest, mut results) = (0, Vec::new());
        let n = 400_000;
        for number in 0..n {
            queue.push(at(number), number);
            // Truth comes two records later, and for three hours not at all.
            if let Some(stamp) = number.checked_sub(2).filter(|number| !(10_000..118_000).contains(number)) {
                let data = RecordData::TruePose(Pose2::new(stamp as f64, 0.0, 0.0));
                truth.take(&Record { stamp: at(stamp), data }, iter::empty());
            }
            results.extend(iter::from_fn(|| queue.pop(Some(at(number)), &truth)));
            longest = longest.max(queue.0.len());
        }
        results.extend(iter::from_fn(|| queue.pop(None, &truth)));
        assert!(longest < 610, "{longest}");
        assert!((0..n).eq(results.iter().map(|(number, _)| *number)), "all, in order");
        for (number, truth) in results {
            let is_true = !(10_000..118_000).contains(&number) && number < n - 2;
            assert_eq!(truth.map(|truth| truth.x()), is_true.then_some(number as f64));
        }
    }
}
