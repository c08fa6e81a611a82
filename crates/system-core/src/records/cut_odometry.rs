use std::{borrow::Borrow, collections::VecDeque, iter::Enumerate};

use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::{Record, RecordData, Stamp};

use crate::{IncrementPlausibilityCheck, VELOCITY_TIMEOUT};

/// A record of a log, or a part of one.
pub(crate) enum WholeOrPart<R> {
    Whole(R),
    Part(Record),
}

impl<R: Borrow<Record>> Borrow<Record> for WholeOrPart<R> {
    fn borrow(&self) -> &Record {
        match self {
            Self::Whole(record) => record.borrow(),
            Self::Part(record) => record,
        }
    }
}

/// The records of a log with their numbers, increments of odometry cut at the stamps of the records that ask for it: each part comes before its record, and leads to its
/// stamp.
///
/// The motion between two increments is even. After [`VELOCITY_TIMEOUT`] that is not known any more, and the increment stays whole. A record waits for the increment that
/// leads to it; nothing waits longer than that.
pub(crate) struct CutOdometry<R, I> {
    records: Enumerate<I>,
    is_cut_at: fn(&RecordData) -> bool,
    /// A part of an impossible increment may look possible: it stays whole.
    plausible: IncrementPlausibilityCheck,
    /// End of the last increment.
    since: Option<Stamp>,
    /// From the first record that waits on.
    waiting: VecDeque<(usize, R)>,
    ready: VecDeque<(usize, WholeOrPart<R>)>,
}

impl<R: Borrow<Record>, I: Iterator<Item = R>> CutOdometry<R, I> {
    pub(crate) fn new(records: I, is_cut_at: fn(&RecordData) -> bool) -> Self {
        let (waiting, ready) = (VecDeque::new(), VecDeque::new());
        let plausible = IncrementPlausibilityCheck::default();
        Self { records: records.enumerate(), is_cut_at, plausible, since: None, waiting, ready }
    }

    fn take(&mut self, number: usize, record: R) {
        let Record { stamp, data } = record.borrow();
        match (data, self.since) {
            (RecordData::OdometryIncrement(increment), since) => {
                let (increment, stamp) = (*increment, *stamp);
                self.since = Some(stamp);
                let is_possible = self.plausible.check(stamp, &increment).is_ok();
                match since.filter(|_| is_possible && !self.waiting.is_empty()) {
                    Some(since) => self.cut((number, record), (increment, since, stamp)),
                    None => self.pass((number, record)),
                }
            }
            (_, Some(since)) if stamp.seconds_since(since) > VELOCITY_TIMEOUT => {
                self.since = None;
                self.pass((number, record));
            }
            (data, Some(since)) if *stamp > since && (self.is_cut_at)(data) => {
                self.waiting.push_back((number, record));
            }
            _ if self.waiting.is_empty() => self.pass((number, record)),
            _ => self.waiting.push_back((number, record)),
        }
    }

    /// Nothing waits any longer.
    fn pass(&mut self, last: (usize, R)) {
        let all = self.waiting.drain(..).chain([last]);
        self.ready.extend(all.map(|(number, record)| (number, WholeOrPart::Whole(record))));
    }

    fn cut(&mut self, (number, whole): (usize, R), (increment, since, until): (Pose2<f64>, Stamp, Stamp)) {
        let (mut left, mut from) = (increment, since);
        let odometry = |stamp, part| {
            let data = RecordData::OdometryIncrement(part);
            (number, WholeOrPart::Part(Record { stamp, data }))
        };
        for (number, record) in self.waiting.drain(..) {
            let Record { stamp, data } = record.borrow();
            if (self.is_cut_at)(data) && (from < *stamp && *stamp <= until) {
                let share = stamp.seconds_since(from) / until.seconds_since(from);
                let part = Pose2::exp(&(left.log() * share));
                self.ready.push_back(odometry(*stamp, part));
                (left, from) = (part.inverse().compose(&left), *stamp);
            }
            self.ready.push_back((number, WholeOrPart::Whole(record)));
        }
        if from == since {
            self.ready.push_back((number, WholeOrPart::Whole(whole)));
        } else if from < until {
            self.ready.push_back(odometry(until, left));
        }
    }
}

impl<R: Borrow<Record>, I: Iterator<Item = R>> Iterator for CutOdometry<R, I> {
    type Item = (usize, WholeOrPart<R>);

    fn next(&mut self) -> Option<Self::Item> {
        while self.ready.is_empty() {
            let Some((number, record)) = self.records.next() else {
                let rest = self.waiting.pop_front();
                return rest.map(|(number, record)| (number, WholeOrPart::Whole(record)));
            };
            self.take(number, record);
        }
        self.ready.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;

    fn at(milliseconds: u64, data: RecordData) -> Record {
        Record { stamp: Stamp::from_nanoseconds(milliseconds * 1_000_000), data }
    }

    fn odometry(milliseconds: u64, increment: Pose2<f64>) -> Record {
        at(milliseconds, RecordData::OdometryIncrement(increment))
    }

    /// What an increment is cut at, here.
    fn look(milliseconds: u64) -> Record {
        at(milliseconds, RecordData::Detections(Vec::new()))
    }

    fn is_look(data: &RecordData) -> bool {
        matches!(data, RecordData::Detections(_))
    }

    fn cut(records: &[Record]) -> Vec<(usize, Record)> {
        let records = CutOdometry::new(records.iter(), is_look);
        records.map(|(number, record)| (number, Borrow::<Record>::borrow(&record).clone())).collect()
    }

    #[test]
    fn parts_lead_to_the_records_and_together_as_far() {
        let arc = Pose2::new(1.0, 0.2, 0.5);
        let truth = at(125, RecordData::TruePose(arc));
        let log = [odometry(100, arc), look(120), truth.clone(), look(160), odometry(200, arc)];
        let all = cut(&log);
        let numbers: Vec<usize> = all.iter().map(|(number, _)| *number).collect();
        assert_eq!(numbers, [0, 4, 1, 2, 4, 3, 4]);
        assert_eq!([&all[0].1, &all[2].1, &all[3].1, &all[5].1], [&log[0], &log[1], &truth, &log[3]]);
        let parts = [1, 4, 6].map(|at| match all[at].1 {
            Record { stamp, data: RecordData::OdometryIncrement(part) } => (stamp, part),
            _ => unreachable!("no odometry"),
        });
        assert_eq!(parts.map(|(stamp, _)| stamp), [log[1].stamp, log[3].stamp, log[4].stamp]);
        assert_abs_diff_eq!(parts[0].1.log(), arc.log() * 0.2, epsilon = 1e-12);
        let together = parts.iter().fold(Pose2::identity(), |moved, (_, part)| moved.compose(part));
        assert_abs_diff_eq!(together.log(), arc.log(), epsilon = 1e-12);
    }

    #[test]
    fn odometry_of_the_stamp_of_a_record_moves_before_it() {
        let step = Pose2::new(1.0, 0.0, 0.0);
        let in_order = [odometry(100, step), odometry(200, step), look(200)];
        let numbered = |order: [usize; 3]| order.map(|at| (at, in_order[at].clone())).to_vec();
        assert_eq!(cut(&in_order), numbered([0, 1, 2]));
        let [first, second, look] = in_order.clone();
        let late = [first, look, second];
        let numbers: Vec<usize> = cut(&late).into_iter().map(|(number, _)| number).collect();
        assert_eq!(numbers, [0, 2, 1]);
    }

    #[test]
    fn what_no_motion_is_known_for_does_not_wait() {
        let step = Pose2::new(1.0, 0.0, 0.0);
        let unchanged = |log: &[Record]| {
            let numbered: Vec<(usize, Record)> = log.iter().cloned().enumerate().collect();
            assert_eq!(cut(log), numbered);
        };
        unchanged(&[look(0), look(50), odometry(100, step)]); // the first increment has no beginning
        unchanged(&[odometry(100, step), look(150), look(1200), odometry(1300, step)]); // a gap
        unchanged(&[odometry(100, step), look(150), look(160)]); // the end
        unchanged(&[odometry(100, step), look(150), odometry(120, step)]); // back in time
        for jump in [f64::INFINITY, 1e4] {
            unchanged(&[odometry(100, step), look(101), odometry(200, Pose2::new(jump, 0.0, 0.0))]);
        }
    }

    #[test]
    fn waiting_records_end_with_the_gap() {
        let log = [odometry(100, Pose2::identity())].into_iter().chain((0..100_000).map(|at| look(101 + at)));
        let mut records = CutOdometry::new(log, is_look);
        let mut most = 0;
        while records.next().is_some() {
            most = most.max(records.waiting.len());
        }
        assert!(most <= 1000, "{most}");
    }
}
