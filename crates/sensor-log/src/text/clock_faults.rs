use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use crate::Stamp;

/// Fault of a row's stamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClockFault {
    /// The stamp is far from its neighbours.
    Outlier,
    /// The clock was set back by this many nanoseconds, and continues from there.
    SetBack(u64),
}

/// Maximum delay of a row in a logger: a minute.
const LONGEST_DELAY: u64 = 60 * 1_000_000_000;
/// No log has a longer pause in it: a day.
const LONGEST_PAUSE: u64 = 86_400 * 1_000_000_000;
/// NTP sets a clock that is off by more than 128 ms, and slews one that is off by less (RFC 5905, the step threshold).
const SMALLEST_STEP: u64 = 128_000_000;
/// One or two rows may be late; three ordered rows that repeat earlier times, or are at an end of the log, form a part.
const MIN_PART: usize = 3;

/// The faults of a clock, with the index of the first row of each, from the stamps of a log in row order.
///
/// Rows that are only out of order have no fault. A clock that jumps and returns leaves outliers in between; one that is set back repeats earlier
/// times, or leaves the range of the log permanently.
pub(super) fn clock_faults(stamps: &[Stamp]) -> Vec<(usize, ClockFault)> {
    let mut faults = outliers(stamps);
    let is_outlier: BTreeSet<usize> = faults.iter().map(|(index, _)| *index).collect();
    let kept =
        (0..stamps.len()).filter(|index| !is_outlier.contains(index)).map(|index| (index, stamps[index]));
    faults.extend(steps_back(&kept.collect::<Vec<_>>()));
    faults.sort_by_key(|(index, _)| *index);
    faults
}

/// Sections of rows without which the log is continuous, and short sections at its ends that no pause explains.
fn outliers(stamps: &[Stamp]) -> Vec<(usize, ClockFault)> {
    let parts = parts(stamps);
    let mut kept: Vec<(usize, usize)> = Vec::new();
    let mut position_of_end: BTreeMap<Stamp, usize> = BTreeMap::new();
    let mut out = Vec::new();
    for (start, end) in parts {
        // The clock returns to the end of an earlier part: everything in between is an outlier.
        let near = around(stamps[start], LONGEST_DELAY);
        if let Some(position) = position_of_end.range(near).map(|(_, position)| *position).max() {
            for part in kept.drain(position + 1..) {
                position_of_end.remove(&stamps[part.1 - 1]);
                out.push(part);
            }
        }
        position_of_end.insert(stamps[end - 1], kept.len());
        kept.push((start, end));
    }
    if let [first, second, ..] = kept[..]
        && is_alone(first, second, stamps[second.0].nanoseconds(), stamps[first.1 - 1].nanoseconds())
    {
        out.push(kept.remove(0));
    }
    if let [.., before, last] = kept[..]
        && is_alone(last, before, stamps[last.0].nanoseconds(), stamps[before.1 - 1].nanoseconds())
    {
        out.push(last);
    }
    out.into_iter().flat_map(|(start, end)| start..end).map(|index| (index, ClockFault::Outlier)).collect()
}

/// Whether a part is short beside its neighbour, and the step from one stamp to the other over their border goes back or is longer than any pause.
fn is_alone(part: (usize, usize), neighbour: (usize, usize), after: u64, before: u64) -> bool {
    let n_rows = part.1 - part.0;
    n_rows < MIN_PART
        && n_rows < neighbour.1 - neighbour.0
        && (after < before || after - before > LONGEST_PAUSE)
}

fn around(stamp: Stamp, nanoseconds: u64) -> RangeInclusive<Stamp> {
    let stamp = stamp.nanoseconds();
    let at = Stamp::from_nanoseconds;
    at(stamp.saturating_sub(nanoseconds))..=at(stamp.saturating_add(nanoseconds))
}

/// Stretches of rows, `start..end`, in which no stamp is more than [`LONGEST_DELAY`] from the one before.
fn parts(stamps: &[Stamp]) -> Vec<(usize, usize)> {
    let is_jump = |pair: &[Stamp]| pair[0].nanoseconds().abs_diff(pair[1].nanoseconds()) > LONGEST_DELAY;
    let jumps = stamps.windows(2).enumerate().filter_map(|(index, pair)| is_jump(pair).then_some(index + 1));
    let mut starts = vec![0];
    starts.extend(jumps);
    let ends = starts.iter().skip(1).copied().chain([stamps.len()]);
    starts.iter().copied().zip(ends).filter(|(start, end)| start < end).collect()
}

/// Rows at which the clock was set back.
fn steps_back(rows: &[(usize, Stamp)]) -> Vec<(usize, ClockFault)> {
    let mut steps = Vec::new();
    let mut before: BTreeSet<Stamp> = BTreeSet::new();
    for (position, (index, stamp)) in rows.iter().enumerate() {
        let last = position.checked_sub(1).map_or(*stamp, |last| rows[last].1);
        let step = last.nanoseconds().saturating_sub(stamp.nanoseconds());
        if step > LONGEST_DELAY || (step > SMALLEST_STEP && repeats(&rows[position..], &before)) {
            steps.push((*index, ClockFault::SetBack(step)));
            before.clear();
        }
        before.insert(*stamp);
    }
    steps
}

/// Whether the first rows repeat earlier times: stamps of `before` lie between theirs.
///
/// Rows that are only late fill a gap.
fn repeats(rows: &[(usize, Stamp)], before: &BTreeSet<Stamp>) -> bool {
    let Some(latest) = before.last() else { return false };
    let mut distinct = rows.iter().map(|(_, stamp)| *stamp);
    let Some(mut last) = distinct.next() else { return false };
    let mut n_repeated = 1;
    for stamp in distinct {
        if stamp == last {
            continue;
        }
        if stamp < last || stamp >= *latest || before.range(last..=stamp).next().is_none() {
            return false;
        }
        n_repeated += 1;
        if n_repeated == MIN_PART {
            return true;
        }
        last = stamp;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(seconds: &[f64]) -> Vec<(usize, ClockFault)> {
        let stamps: Vec<Stamp> = seconds.iter().filter_map(|s| Stamp::from_seconds(*s)).collect();
        assert_eq!(stamps.len(), seconds.len());
        clock_faults(&stamps)
    }

    const OUTLIER: ClockFault = ClockFault::Outlier;

    fn set_back(seconds: u64) -> ClockFault {
        ClockFault::SetBack(seconds * 1_000_000_000)
    }

    #[test]
    fn rows_in_order_with_pauses_have_no_fault() {
        assert_eq!(faults(&[]), []);
        assert_eq!(faults(&[1.3e9]), []);
        assert_eq!(faults(&[1.0, 1.0, 1.0, 1.0]), []);
        assert_eq!(faults(&[1.0, 2.0, 3000.0, 3001.0, 3001.5, 70_000.0]), []);
        let weeks: Vec<f64> = (0..5).map(|week| f64::from(week) * 604_800.0).collect();
        assert_eq!(faults(&weeks), []);
    }

    #[test]
    fn rows_that_are_late_have_no_fault() {
        assert_eq!(faults(&[1.0, 2.0, 3.0, 5.0, 6.0, 4.0, 7.0]), []);
        assert_eq!(faults(&[100.5, 100.0]), []);
        // A block that was written late fills its gap.
        assert_eq!(faults(&[1.0, 2.0, 6.0, 7.0, 8.0, 3.0, 4.0, 5.0, 9.0]), []);
    }

    #[test]
    fn rows_years_off_are_outliers_wherever_they_are() {
        let (t, years) = (1.3e9, 3e8);
        assert_eq!(faults(&[5.0, t, t + 1.0]), [(0, OUTLIER)]);
        assert_eq!(faults(&[t, t + 1.0, 5.0, t + 2.0]), [(2, OUTLIER)]);
        assert_eq!(faults(&[t, t + 1.0, t + years, 5.0, t + 2.0]), [(2, OUTLIER), (3, OUTLIER)]);
        assert_eq!(faults(&[t, t + 1.0, 5.0]), [(2, OUTLIER)]);
        assert_eq!(faults(&[t, t + 1.0, t + 2.0, t + years, t + years]), [(3, OUTLIER), (4, OUTLIER)]);
        assert_eq!(faults(&[t + 7200.0, t, t + 1.0, t + 2.0]), [(0, OUTLIER)]);
        assert_eq!(faults(&[t, t + 1.0, t - 7200.0]), [(2, OUTLIER)]);
        // A clock that is wrong by an hour for a while.
        assert_eq!(faults(&[t, t + 1.0, t + 3602.0, t + 3603.0, t + 4.0]), [(2, OUTLIER), (3, OUTLIER)]);
    }

    #[test]
    fn a_clock_that_is_set_back_repeats_its_times() {
        let mut drive: Vec<f64> = (0..20).map(f64::from).collect();
        drive.extend((0..20).map(|k| f64::from(k) + 14.5));
        assert_eq!(faults(&drive), [(20, ClockFault::SetBack(4_500_000_000))]);
        let mut all_of_it: Vec<f64> = (0..20).map(f64::from).collect();
        all_of_it.extend((0..20).map(f64::from));
        assert_eq!(faults(&all_of_it), [(20, set_back(19))]);
    }

    #[test]
    fn a_clock_that_is_set_back_for_good_leaves_the_range() {
        assert_eq!(faults(&[1000.0, 1001.0, 1002.0, 5.0, 6.0, 7.0]), [(3, set_back(997))]);
        assert_eq!(faults(&[1.3e9, 1.3e9 + 1.0, 5.0, 6.0, 7.0]), [(0, OUTLIER), (1, OUTLIER)]);
    }
}
