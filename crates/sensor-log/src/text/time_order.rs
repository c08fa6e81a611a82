use std::io::BufRead;

use super::Lines;
use super::clock_faults::{ClockFault, clock_faults};
use super::row::RowError;
use crate::{LogError, ReadReport, RowProblem, RowProblemKind, Stamp};

/// Content of a row of a text file, with its line and its time.
pub(super) struct Timed<T> {
    pub(super) row: u64,
    pub(super) stamp: Stamp,
    pub(super) item: T,
}

/// The rows that `read_row` accepts, [in time order](in_time_order); the others go into the report.
pub(super) fn rows_in_time_order<R: BufRead, T>(
    lines: Lines<R>,
    report: &mut ReadReport,
    mut read_row: impl FnMut(&str) -> Result<(Stamp, T), RowError>,
) -> Result<Vec<Timed<T>>, LogError> {
    let file = lines.file_name();
    let mut rows = Vec::new();
    lines.for_each_numbered_row(report, |row, text| {
        let (stamp, item) = read_row(text)?;
        rows.push(Timed { row, stamp, item });
        Ok(())
    })?;
    Ok(in_time_order(&file, rows, report))
}

/// The rows of a file in time order. Skips rows whose stamp is far from all others. If the clock is set back, the longest stretch is read. Sorts
/// rows that are only out of order. All of it is reported.
pub(super) fn in_time_order<T>(file: &str, rows: Vec<Timed<T>>, report: &mut ReadReport) -> Vec<Timed<T>> {
    let stamps: Vec<Stamp> = rows.iter().map(|row| row.stamp).collect();
    let mut faults = clock_faults(&stamps).into_iter().peekable();
    let mut stretches = vec![Vec::new()];
    let mut cuts = Vec::new();
    for (index, row) in rows.into_iter().enumerate() {
        match faults.next_if(|(at, _)| *at == index) {
            Some((_, ClockFault::Outlier)) => {
                let reason = format!("{} is far from the times of the rows around it", row.stamp);
                report.leave_out(
                    RowProblem {
                        file: file.to_owned(),
                        row: row.row,
                        kind: RowProblemKind::BadStamp,
                        reason,
                    },
                    1,
                );
                continue;
            }
            Some((_, ClockFault::SetBack(nanoseconds))) => {
                cuts.push(format!("by {:.3} s at line {}", nanoseconds as f64 * 1e-9, row.row));
                stretches.push(Vec::new());
            }
            None => {}
        }
        if let Some(stretch) = stretches.last_mut() {
            stretch.push(row);
        }
    }
    let mut rows = longest(file, stretches, &cuts, report);
    for pair in rows.windows(2) {
        let (before, after) = (&pair[0], &pair[1]);
        if after.stamp < before.stamp {
            let reason = format!("{} comes after {}; sorted into its place", after.stamp, before.stamp);
            report.add(RowProblem {
                file: file.to_owned(),
                row: after.row,
                kind: RowProblemKind::OutOfOrder,
                reason,
            });
        }
    }
    rows.sort_by_key(|row| row.stamp);
    rows
}

/// The longest stretch, of several of the same length the first; the others are left out.
fn longest<T>(
    file: &str,
    mut stretches: Vec<Vec<Timed<T>>>,
    cuts: &[String],
    report: &mut ReadReport,
) -> Vec<Timed<T>> {
    let n_rows = |stretch: &Vec<Timed<T>>| stretch.len();
    let Some(best) = (0..stretches.len()).rev().max_by_key(|index| n_rows(&stretches[*index])) else {
        return Vec::new();
    };
    let kept = stretches.swap_remove(best);
    let n_out: usize = stretches.iter().map(n_rows).sum();
    if let (Some(first), Some(begin), Some(end)) =
        (stretches.iter().flatten().next(), kept.first(), kept.last())
    {
        let cuts = cuts.join(", ");
        let (begin, end) = (begin.row, end.row);
        let reason = format!("the clock is set back {cuts}; {n_out} rows before or after are left out");
        report.leave_out(
            RowProblem { file: file.to_owned(), row: first.row, kind: RowProblemKind::TooLate, reason },
            n_out as u64,
        );
        report.warn(
            "clock_set_back",
            format!(
                "{file}: the clock is set back {cuts}. Only the longest stretch is read, lines {begin} to {end}; {n_out} rows are left out. Cut the file at these lines to read the other stretches"
            ),
        );
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorted(seconds: &[f64]) -> (Vec<u64>, ReadReport) {
        let row = |(item, s): (usize, &f64)| {
            let stamp = Stamp::from_seconds(*s).unwrap();
            Timed { row: item as u64 + 1, stamp, item: item as u64 + 1 }
        };
        let mut report = ReadReport { rows_read: seconds.len() as u64, ..Default::default() };
        let rows = in_time_order("rows.txt", seconds.iter().enumerate().map(row).collect(), &mut report);
        (rows.into_iter().map(|row| row.item).collect(), report)
    }

    #[test]
    fn a_row_out_of_order_is_sorted_and_counted() {
        let (rows, report) = sorted(&[1.0, 3.0, 2.0, 4.0]);
        assert_eq!(rows, [1, 3, 2, 4]);
        assert_eq!((report.rows_read, report.problems[&RowProblemKind::OutOfOrder]), (4, 1));
        assert!(report.warnings.is_empty());
    }

    #[test]
    fn a_row_years_off_is_left_out_and_counted() {
        let (rows, report) = sorted(&[1.3e9, 1.3e9 + 1.0, 5.0, 1.3e9 + 2.0]);
        assert_eq!(rows, [1, 2, 4]);
        assert_eq!((report.rows_read, report.n_problems()), (3, 1));
        assert_eq!((report.examples[0].row, report.examples[0].kind), (3, RowProblemKind::BadStamp));
    }

    #[test]
    fn of_a_clock_that_is_set_back_the_longest_stretch_is_read() {
        let (rows, report) = sorted(&[1.0, 2.0, 3.0, 4.0, 1.5, 2.5, 3.5, 4.5, 5.5]);
        assert_eq!(rows, [5, 6, 7, 8, 9]);
        assert_eq!((report.rows_read, report.problems[&RowProblemKind::TooLate]), (5, 4));
        assert_eq!((report.examples.len(), report.examples[0].row), (1, 1));
        assert_eq!(report.warnings[0].name, "clock_set_back");
        let (rows, _) = sorted(&[1.0, 2.0, 3.0, 4.0, 1.5, 2.5, 3.5, 4.5]);
        assert_eq!(rows, [1, 2, 3, 4]);
    }
}
