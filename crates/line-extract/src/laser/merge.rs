use super::LineExtractionParams;
use super::pieces::{Piece, outermost};

/// Joins collinear pieces, each with the nearest earlier one that it fits [chi-squared test of the difference of $`(ρ, α)`$].
pub(super) fn merge(pieces: &mut Vec<Piece>, params: &LineExtractionParams) {
    let mut kept = 0;
    for k in 0..pieces.len() {
        let joined = (0..kept).rev().find_map(|at| Some((at, join(&pieces[at], &pieces[k], params)?)));
        match joined {
            Some((at, piece)) => pieces[at] = piece,
            None => {
                pieces.swap(kept, k);
                kept += 1;
            }
        }
    }
    pieces.truncate(kept);
}

fn join(a: &Piece, b: &Piece, params: &LineExtractionParams) -> Option<Piece> {
    let cannot_be_one = gap(a, b) > params.merge_gap_m
        || a.estimate.mahalanobis_squared(&b.estimate).ok()? > params.merge_gate;
    if cannot_be_one {
        return None;
    }
    let moments = a.moments.with(&b.moments);
    let estimate = moments.line().ok()?;
    let ends = outermost(&estimate, [a.ends[0], a.ends[1], b.ends[0], b.ends[1]]);
    let beams = (a.beams.0.min(b.beams.0), a.beams.1.max(b.beams.1));
    Some(Piece { moments, estimate, ends, beams, bend: a.bend })
}

/// The gap between two pieces along the line of the first; negative for an overlap.
fn gap(a: &Piece, b: &Piece) -> f64 {
    let direction = a.estimate.line.direction();
    let interval = |piece: &Piece| {
        let [first, last] = piece.ends.map(|end| direction.dot(&end));
        (first.min(last), first.max(last))
    };
    let (a, b) = (interval(a), interval(b));
    (b.0 - a.1).max(a.0 - b.1)
}
