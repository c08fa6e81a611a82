use super::{PanoramaDescriptor, PanoramaLowerBoundTable, PanoramaQuery};
use crate::{LowerBoundedDistance, ViewDifference};

/// # Why this is a bound
/// Harmonics contribute separately, $`d² ≥ \sum_k d_k²`$ with $`d_k² = |a|² + |b|² - 2|⟨a, b⟩|`$ for the complex vectors $`a, b`$ over the rings,
/// since the best common rotation is no better than the best rotation of each harmonic. The bound is that sum; it gives up when even
/// parallel vectors of the remaining harmonics would not bring it below `enough`.
impl LowerBoundedDistance for PanoramaDescriptor {
    type Probe = PanoramaQuery;
    type Table = PanoramaLowerBoundTable;

    fn probe(&self) -> PanoramaQuery {
        PanoramaQuery::new(self)
    }

    fn bound(&self, probe: &PanoramaQuery, enough: f64) -> f64 {
        probe.bound(self, enough)
    }

    fn compare_with(&self, probe: &PanoramaQuery) -> ViewDifference {
        probe.compare(self)
    }

    fn is_comparable(&self, other: &Self) -> bool {
        self.has_shape_of(other)
    }
}
