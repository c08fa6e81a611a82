use super::{PanoramaDescriptor, PanoramaLowerBoundTable, PanoramaQuery};
use crate::{LowerBoundedDistance, ViewDifference};

/// Harmonics whose phases between rings count; of the others only how strong they are.
const PHASED_HARMONICS: usize = 8;
/// Cosines over the rings that a harmonic is reduced to: its slow changes from top to bottom, which hold most of it.
const N_COSINES: usize = 5;
/// As many of the constant harmonic, which has no phase to be rid of.
const N_CONSTANT_COSINES: usize = 8;

/// # Why these are bounds
/// Harmonics contribute separately, $`d² ≥ \sum_k d_k²`$ with $`d_k² = |a|² + |b|² - 2|⟨a, b⟩|`$ for the complex vectors $`a, b`$ over the rings,
/// since the best common rotation is no better than the best rotation of each harmonic. The second stage is that sum; it gives up when even
/// parallel vectors of the remaining harmonics would not bring it below `enough`.
///
/// The first cosines part $`a`$ into $`a'`$ and a rest, $`d_k² ≥ d'^2 + (|a^⊥| - |b^⊥|)²`$. For $`a'`$,
/// with $`c = |⟨a', b'⟩| / |a'||b'|`$, half the squared Frobenius distance of $`a'a'^*/|a'|`$ and $`b'b'^*/|b'|`$ and half of $`(|a'| - |b'|)²`$ sum to
/// $`(|a'| - |b'|)² + |a'||b'|(1 - c²) ≤ (|a'| - |b'|)² + 2|a'||b'|(1 - c) = d'^2`$. All of these are coordinates of a Euclidean space.
impl LowerBoundedDistance for PanoramaDescriptor {
    type Probe = PanoramaQuery;
    type Table = PanoramaLowerBoundTable;

    fn invariants(&self) -> Vec<f64> {
        let scale = f64::from(self.scale());
        let (mut invariants, rest) = slow_and_rest(self.constant(), N_CONSTANT_COSINES, scale);
        invariants.push(rest.sqrt());
        for k in 1..self.n_harmonics() {
            let n_cosines = if k < PHASED_HARMONICS { N_COSINES } else { 0 };
            let (re, im) = self.harmonic(k);
            let (re, re_rest) = slow_and_rest(&re, n_cosines, scale);
            let (im, im_rest) = slow_and_rest(&im, n_cosines, scale);
            push_outer_product(&re, &im, &mut invariants);
            invariants.push((re_rest + im_rest).sqrt());
        }
        invariants
    }

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

/// The first cosines, and the energy of all others.
fn slow_and_rest(values: &[i8], n: usize, scale: f64) -> (Vec<f64>, f64) {
    let (slow, rest) = values.split_at(n.min(values.len()));
    let value = |q: &i8| scale * f64::from(*q);
    (slow.iter().map(value).collect(), rest.iter().map(|q| value(q).powi(2)).sum())
}

/// Coordinates of $`aa^*/|a|`$ and of $`|a|`$, weighed so that squared distances are half of theirs.
fn push_outer_product(re: &[f64], im: &[f64], coordinates: &mut Vec<f64>) {
    let norm = re.iter().chain(im).map(|x| x * x).sum::<f64>().sqrt();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let scale = if norm > 0.0 { norm.recip() } else { 0.0 };
    for i in 0..re.len() {
        coordinates.push(half * scale * (re[i] * re[i] + im[i] * im[i]));
        for j in 0..i {
            coordinates.push(scale * (re[i] * re[j] + im[i] * im[j]));
            coordinates.push(scale * (im[i] * re[j] - re[i] * im[j]));
        }
    }
    if !re.is_empty() {
        coordinates.push(half * norm);
    }
}
