use crate::{ReadReport, RowProblem, RowProblemKind, Stamp, TruePosition};

/// Limit of the two steps around a fix, m; if both are longer, the fix is a jump of the receiver.
const MAX_STEP_M: f64 = 30.0;

/// The fixes of `file`, each with its row, without jumps, which the report lists.
///
/// Only a fix between two others is tested: one long step may be a gap in reception.
pub(super) fn drop_jumps(
    file: &str,
    fixes: Vec<(u64, Stamp, TruePosition)>,
    report: &mut ReadReport,
) -> Vec<(Stamp, TruePosition)> {
    let steps: Vec<f64> = fixes.windows(2).map(|pair| step(&pair[0].2, &pair[1].2)).collect();
    let mut kept = Vec::with_capacity(fixes.len());
    for (index, (row, stamp, position)) in fixes.into_iter().enumerate() {
        let before = index.checked_sub(1).and_then(|index| steps.get(index));
        match (before, steps.get(index)) {
            (Some(before), Some(after)) if before.min(*after) > MAX_STEP_M => {
                let reason =
                    format!("fix {before:.0} m from the one before and {after:.0} m from the one after");
                let (file, kind) = (file.to_owned(), RowProblemKind::Inconsistent);
                report.leave_out(RowProblem { file, row, kind, reason }, 1);
            }
            _ => kept.push((stamp, position)),
        }
    }
    kept
}

fn step(from: &TruePosition, to: &TruePosition) -> f64 {
    (to.x - from.x).hypot(to.y - from.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x of the kept fixes, and the rows of the others.
    fn kept(xs: &[f64]) -> (Vec<f64>, Vec<u64>) {
        let fix = |(row, x): (usize, &f64)| (row as u64, Stamp::default(), TruePosition { x: *x, y: 0.0 });
        let mut report = ReadReport { rows_read: xs.len() as u64, ..Default::default() };
        let kept = drop_jumps("gps.csv", xs.iter().enumerate().map(fix).collect(), &mut report);
        assert_eq!(report.rows_read, kept.len() as u64);
        let rows = report.examples.iter().map(|problem| problem.row).collect();
        (kept.into_iter().map(|(_, position)| position.x).collect(), rows)
    }

    #[test]
    fn only_a_fix_far_from_both_neighbours_goes() {
        assert_eq!(kept(&[0.0, 1.0, 140.0, 2.0, 3.0]), (vec![0.0, 1.0, 2.0, 3.0], vec![2]));
        let gap = [0.0, 1.0, 140.0, 141.0];
        assert_eq!(kept(&gap), (gap.to_vec(), vec![]));
        let at_the_ends = [0.0, 31.0, 32.0, 63.0];
        assert_eq!(kept(&at_the_ends), (at_the_ends.to_vec(), vec![]));
        let thirty = [0.0, 30.0, 0.0];
        assert_eq!(kept(&thirty), (thirty.to_vec(), vec![]));
        assert_eq!(kept(&[]), (vec![], vec![]));
    }
}
