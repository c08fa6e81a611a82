use std::collections::VecDeque;

use crate::{Record, Stamp};

/// Larger backward steps mean that the clock was set, s; smaller ones are messages out of order.
const CLOCK_WAS_SET: f64 = 1.0;
/// No recording pauses for longer, seconds: a stamp further ahead is wrong, unless the next ones continue from there.
const LONGEST_PAUSE: f64 = 86_400.0;
/// Number of successive stamps that confirm a clock that was set, as opposed to single wrong stamps.
const IN_A_ROW: usize = 10;

/// Tells wrong stamps, and a clock that is set back, from the stamps of one topic.
#[derive(Debug, Default)]
pub(in crate::mcap_log) struct TopicClock {
    latest: Option<Stamp>,
    /// Stamps of the last accepted records.
    passed: VecDeque<Stamp>,
    /// Records that do not follow the ones before, in a row.
    held: Vec<Record>,
}

/// Decision about a record and those held before it.
#[derive(Debug, Default, PartialEq)]
pub(in crate::mcap_log) struct Checked {
    /// Accepted records, in sequence.
    pub(in crate::mcap_log) passed: Vec<Record>,
    /// Their stamps are wrong.
    pub(in crate::mcap_log) wrong: Vec<Record>,
    /// The clock was set back from the first stamp to the second.
    pub(in crate::mcap_log) set_back: Option<(Stamp, Stamp)>,
}

impl TopicClock {
    pub(in crate::mcap_log) fn check(&mut self, record: Record) -> Checked {
        let stamp = record.stamp;
        let Some(latest) = self.latest else { return self.pass(record) };
        let ahead = stamp.seconds_since(latest);
        if (-CLOCK_WAS_SET..=LONGEST_PAUSE).contains(&ahead) {
            let wrong = std::mem::take(&mut self.held);
            return Checked { wrong, ..self.pass(record) };
        }
        let follows = self
            .held
            .last()
            .is_none_or(|last| (-CLOCK_WAS_SET..=LONGEST_PAUSE).contains(&stamp.seconds_since(last.stamp)));
        let wrong = if follows { Vec::new() } else { std::mem::take(&mut self.held) };
        self.held.push(record);
        if self.held.len() < IN_A_ROW {
            return Checked { wrong, ..Checked::default() };
        }
        let held = std::mem::take(&mut self.held);
        // If fewer records are ahead than are held here, the ones ahead were wrong.
        let first = held[0].stamp;
        let are_many_ahead = self.passed.iter().filter(|passed| **passed > first).count() >= IN_A_ROW;
        if ahead < 0.0 && are_many_ahead {
            let set_back = Some((latest, first));
            return Checked { wrong: [wrong, held].concat(), set_back, ..Checked::default() };
        }
        // A pause of the recording, or the last few stamps were wrong.
        self.latest = Some(stamp);
        held.iter().for_each(|record| self.note(record.stamp));
        Checked { passed: held, wrong, set_back: None }
    }

    /// The latest accepted stamp.
    pub(in crate::mcap_log) fn latest(&self) -> Option<Stamp> {
        self.latest
    }

    /// Releases the held records at the end of the log.
    pub(in crate::mcap_log) fn finish(&mut self) -> Vec<Record> {
        std::mem::take(&mut self.held)
    }

    fn note(&mut self, stamp: Stamp) {
        self.passed.push_back(stamp);
        if self.passed.len() > IN_A_ROW {
            self.passed.pop_front();
        }
    }

    fn pass(&mut self, record: Record) -> Checked {
        self.latest = self.latest.max(Some(record.stamp));
        self.note(record.stamp);
        Checked { passed: vec![record], ..Checked::default() }
    }
}

#[cfg(test)]
mod tests {
    use wayfix_estimation_traits::Pose2;

    use super::*;
    use crate::RecordData;

    fn checked(seconds: &[u64]) -> (Vec<u64>, Vec<u64>, Option<(u64, u64)>) {
        let (mut clock, mut passed, mut wrong, mut set_back) =
            (TopicClock::default(), Vec::new(), Vec::new(), None);
        let whole = |stamp: Stamp| stamp.nanoseconds() / 1_000_000_000;
        for second in seconds {
            let stamp = Stamp::from_nanoseconds(second * 1_000_000_000);
            let found = clock.check(Record { stamp, data: RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0)) });
            passed.extend(found.passed.iter().map(|record| whole(record.stamp)));
            wrong.extend(found.wrong.iter().map(|record| whole(record.stamp)));
            set_back = set_back.or(found.set_back.map(|(from, to)| (whole(from), whole(to))));
        }
        wrong.extend(clock.finish().iter().map(|record| whole(record.stamp)));
        (passed, wrong, set_back)
    }

    #[test]
    fn single_wrong_stamps_are_left_out() {
        let (passed, wrong, set_back) = checked(&[1000, 1001, 5, 1002, 9_000_000_000, 1003]);
        assert_eq!((passed, wrong, set_back), (vec![1000, 1001, 1002, 1003], vec![5, 9_000_000_000], None));
    }

    #[test]
    fn clock_that_is_set_back_is_told_with_its_stamps() {
        let first: Vec<u64> = (100..120).collect();
        let (passed, wrong, set_back) = checked(&[first.clone(), (50..62).collect()].concat());
        assert_eq!((passed, set_back), (first, Some((119, 50))));
        assert_eq!(wrong.len(), 12);
    }

    #[test]
    fn one_stamp_an_hour_ahead_does_not_cut_the_log() {
        let (before, after): (Vec<u64>, Vec<u64>) = ((1000..1030).collect(), (1030..1060).collect());
        let (passed, wrong, set_back) = checked(&[before, vec![4630], after].concat());
        assert_eq!((passed.len(), wrong.len(), set_back), (61, 0, None));
    }

    #[test]
    fn long_pause_and_wrong_first_stamps_are_passed() {
        let later: Vec<u64> = (1_000_000..1_000_020).collect();
        let (passed, wrong, set_back) = checked(&[vec![5], later.clone()].concat());
        assert_eq!((passed.len(), wrong.len(), set_back), (21, 0, None));
    }
}
