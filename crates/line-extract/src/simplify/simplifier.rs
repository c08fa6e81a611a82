use nalgebra::Vector2;

use super::baseline::Baseline;
use super::chain::Chain;
use super::hull_tree::HullTree;
use super::scan::Scanner;
use super::split::{split_all, split_loop};
use crate::LineExtractionError;

/// Number of tests per point, in units of $`\log_2 n`$, before hulls are built.
const SCAN_BUDGET: usize = 2;

/// Cost of an exact comparison in fast tests: about 100 ns.
const EXACT_COMPARISON_COST: usize = 100;

/// The indices of [`douglas_peucker`](crate::douglas_peucker) with [`PointDistanceReference::Line`](crate::PointDistanceReference), in $`O(n \log^2 n)`$ for every
/// chain. [Andrade-Cetto 2005, Tables 1, 2]
///
/// While splits are balanced, a test of every point is fastest. After $`2 n \log_2 n`$ tests, convex
/// hulls of the chain's blocks are built for the rest: the farthest point of a block is a vertex of its hull, found by bisection. This is the
/// idea of [Hershberger & Snoeyink 1992], whose path hulls require a chain that does not cross itself; hulls of index ranges do not. All
/// comparisons are exact, hence the same indices.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_line_extract::{PointDistanceReference, douglas_peucker, simplify};
///
/// // Each split takes one point off: testing all of them every time would take 5e9 tests.
/// let tooth = |k: i32| if k % 2 == 0 { 0.0 } else { 1e3 - 1e-2 * f64::from(k) };
/// let zigzag: Vec<_> = (0..100_000).map(|k| Vector2::new(f64::from(k), tooth(k))).collect();
/// assert_eq!(simplify(&zigzag, 1e-6)?.len(), zigzag.len());
/// assert_eq!(simplify(&zigzag[..500], 400.0)?, douglas_peucker(&zigzag[..500], 400.0, PointDistanceReference::Line)?);
/// # Ok::<(), wayfix_line_extract::LineExtractionError>(())
/// ```
///
/// # Errors
/// Returns [`LineExtractionError::Epsilon`] for a tolerance that is negative or not finite, [`LineExtractionError::Point`] for a point that is not finite or beyond
/// 1e150.
pub fn simplify(points: &[Vector2<f64>], epsilon: f64) -> Result<Vec<usize>, LineExtractionError> {
    let mut kept = Vec::new();
    PolylineSimplifier::default().simplify_into(points, epsilon, &mut kept)?;
    Ok(kept)
}

/// [`simplify()`] for many chains one after the other, with memory that is used again.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_line_extract::PolylineSimplifier;
///
/// let mut simplifier = PolylineSimplifier::default();
/// let mut kept = Vec::new();
/// for height in [0.1, 0.0] {
///     let chain = [Vector2::new(0.0, 0.0), Vector2::new(1.0, height), Vector2::new(2.0, 0.0)];
///     simplifier.simplify_into(&chain, 0.05, &mut kept)?;
///     assert_eq!(kept.len(), if height > 0.05 { 3 } else { 2 });
/// }
/// # Ok::<(), wayfix_line_extract::LineExtractionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PolylineSimplifier {
    scan_budget: usize,
    ends: Vec<usize>,
    scanner: Scanner,
}

impl Default for PolylineSimplifier {
    fn default() -> Self {
        Self { scan_budget: SCAN_BUDGET, ends: Vec::new(), scanner: Scanner::default() }
    }
}

impl PolylineSimplifier {
    /// Queries the hulls from the beginning, which is slower on simple chains and faster on the worst ones.
    pub fn hull_tree_only() -> Self {
        Self { scan_budget: 0, ..Self::default() }
    }

    /// Replaces `kept` by the indices that [`simplify()`] returns.
    ///
    /// # Errors
    /// Returns the errors of [`simplify()`]; `kept` is then unchanged.
    pub fn simplify_into(
        &mut self,
        points: &[Vector2<f64>],
        epsilon: f64,
        kept: &mut Vec<usize>,
    ) -> Result<(), LineExtractionError> {
        let chain = Chain::new(points, epsilon)?;
        let n = points.len();
        // Hulls store indices of 32 bits; a chain beyond that (64 GB) is scanned to the end.
        let looks_each = self.scan_budget * n.max(2).ilog2() as usize;
        let mut looks = u32::try_from(n).map_or(usize::MAX, |_| n.saturating_mul(looks_each));
        let mut hulls = None;
        let scanner = &mut self.scanner;
        scanner.n_exact_comparisons = 0;
        split_all(n, &mut self.ends, kept, |start, end| {
            if points[start] == points[end] {
                return split_loop(&chain, start, end);
            }
            let line = Baseline::new(&points[start], &points[end], &chain.extent);
            let range = start + 1..end;
            let split = if looks >= range.len() + EXACT_COMPARISON_COST * scanner.n_exact_comparisons {
                looks -= range.len();
                scanner.farthest(points, range, &line, epsilon)
            } else {
                hulls.get_or_insert_with(|| HullTree::new(points)).farthest(points, range, &line, scanner)
            }?;
            (line.distance(&points[split]) > epsilon).then_some(split)
        });
        Ok(())
    }

    /// Splits ranges as [`split_all`] does.
    pub(crate) fn split_where(
        &mut self,
        n: usize,
        kept: &mut Vec<usize>,
        find: impl FnMut(usize, usize) -> Option<usize>,
    ) {
        split_all(n, &mut self.ends, kept, find);
    }
}
