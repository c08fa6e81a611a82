use super::correlation::{Correlation, MOST_HARMONICS};
use crate::{AppearanceError, Comparison, Descriptor};

/// The spectrum of a panorama over the azimuth, in a byte a number: about a kilobyte for 25 rings and 16 harmonics.
///
/// The numbers are $`c = s q`$ with whole $`q`$ from −127 to 127 and one scale $`s`$ a view. What rounding does to a distance is below
/// $`s\sqrt{n/12}`$ in the mean, about 0.015 for views whose distances are from 0.1 to 1. Sums of products of whole numbers are exact, so that
/// a view is at distance 0 from itself, and every search that compares the stored numbers gives the same bits.
///
/// The distance is $`d² = \min_φ \sum_{rk} |a_{rk} e^{\mathrm i kφ} - b_{rk}|²`$: the root mean square difference of the cells of two normalized views
/// at the best rotation, as far as the harmonics go. It obeys the triangle inequality. Views of different shape are at infinite distance.
#[derive(Clone, Debug, PartialEq)]
pub struct PanoramaDescriptor {
    scale: f32,
    n_rings: u8,
    /// Harmonic by harmonic: the real parts of all rings, then (not for the constant one) their imaginary parts, each filled up with zeros
    /// to whole lanes.
    lanes: Box<[i8]>,
    /// Sums of squares of the whole numbers: of all, and of the harmonics from each checkpoint on.
    energy: u32,
    remaining: [u32; CHECKPOINTS.len()],
}

/// Harmonics before which a comparison may be given up.
const CHECKPOINTS: [usize; 5] = [2, 4, 6, 8, 11];

/// Numbers that are multiplied at once.
const LANES: usize = 8;

impl PanoramaDescriptor {
    /// From what [`scale`](Self::scale), [`n_rings`](Self::n_rings) and [`coefficients`](Self::coefficients) give.
    ///
    /// # Errors
    /// [`AppearanceError::Descriptor`] when the scale is not finite and positive, a coefficient is −128, or their number is not an odd multiple of the
    /// rings of at most 64 harmonics.
    pub fn from_parts(scale: f32, n_rings: u8, coefficients: Vec<i8>) -> Result<Self, AppearanceError> {
        let refused = AppearanceError::Descriptor { scale, n_rings, n_coefficients: coefficients.len() };
        let n_parts = coefficients.len().checked_div(usize::from(n_rings)).unwrap_or(0);
        let fits = n_parts * usize::from(n_rings) == coefficients.len();
        let is_spectrum = fits && n_parts % 2 == 1 && n_parts < 2 * MOST_HARMONICS;
        let is_sound = scale.is_finite() && scale > 0.0 && !coefficients.contains(&i8::MIN);
        if !is_spectrum || !is_sound {
            return Err(refused);
        }
        Ok(Self::whole(scale, n_rings, &coefficients))
    }

    /// The coefficients of all harmonics, rounded to what a byte holds.
    pub(super) fn quantized(n_rings: usize, spectrum: &[f64]) -> Self {
        let largest = spectrum.iter().fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
        let scale = ((largest / 127.0) as f32).max(f32::MIN_POSITIVE);
        let byte = |value: &f64| (value / f64::from(scale)).round().clamp(-127.0, 127.0) as i8;
        Self::whole(scale, n_rings as u8, &spectrum.iter().map(byte).collect::<Vec<_>>())
    }

    fn whole(scale: f32, n_rings: u8, coefficients: &[i8]) -> Self {
        let n = usize::from(n_rings);
        let padded = n.next_multiple_of(LANES);
        let filled =
            |part: &[i8]| part.iter().copied().chain(std::iter::repeat_n(0, padded - n)).collect::<Vec<_>>();
        let lanes: Box<[i8]> = coefficients.chunks_exact(n).flat_map(filled).collect();
        let energy_from = |k: usize| {
            let from = (2 * k).saturating_sub(1) * padded;
            lanes.get(from..).map_or(0, |rest| dot(rest, rest) as u32)
        };
        let (energy, remaining) = (energy_from(0), CHECKPOINTS.map(energy_from));
        Self { scale, n_rings, lanes, energy, remaining }
    }

    /// What a coefficient is to be multiplied with.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// How many rings there are.
    pub fn n_rings(&self) -> u8 {
        self.n_rings
    }

    /// Harmonics, the constant one included.
    pub fn n_harmonics(&self) -> usize {
        self.lanes.len() / self.padded() / 2 + 1
    }

    /// Harmonic by harmonic: the real parts of all rings, then, but for the constant one, their imaginary parts.
    pub fn coefficients(&self) -> Vec<i8> {
        let rings = |part: &[i8]| part[..usize::from(self.n_rings)].to_vec();
        self.lanes.chunks_exact(self.padded()).flat_map(rings).collect()
    }

    fn padded(&self) -> usize {
        usize::from(self.n_rings).next_multiple_of(LANES)
    }

    /// Whether two descriptors can be compared.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        self.n_rings == other.n_rings && self.lanes.len() == other.lanes.len()
    }

    /// The sum of the squares of all coefficients.
    pub fn energy(&self) -> f64 {
        let scale = f64::from(self.scale);
        scale * scale * f64::from(self.energy)
    }

    pub(super) fn constant(&self) -> &[i8] {
        &self.lanes[..self.padded()]
    }

    /// The most that the harmonics from `k` on can add to the correlation with another view (Cauchy-Schwarz), where `k` is a checkpoint.
    pub(super) fn remaining_overlap(&self, other: &Self, k: usize) -> Option<f64> {
        let index = CHECKPOINTS.iter().position(|checkpoint| *checkpoint == k)?;
        Some((f64::from(self.remaining[index]) * f64::from(other.remaining[index])).sqrt())
    }

    /// Real and imaginary parts of the harmonics from the first on.
    pub(super) fn harmonics(&self) -> impl Iterator<Item = (&[i8], &[i8])> {
        let n = self.padded();
        self.lanes[n..].chunks_exact(2 * n).map(move |parts| parts.split_at(n))
    }
}

impl Descriptor for PanoramaDescriptor {
    fn compare(&self, reference: &Self) -> Comparison {
        if !self.has_shape_of(reference) {
            return Comparison { distance: f64::INFINITY, rotation: 0.0 };
        }
        let mut products = [(0.0, 0.0); MOST_HARMONICS];
        let mut n = 0;
        for ((re, im), (reference_re, reference_im)) in self.harmonics().zip(reference.harmonics()) {
            products[n] = cross_product((re, im), (reference_re, reference_im));
            n += 1;
        }
        let constant = f64::from(dot(self.constant(), reference.constant()));
        let (rotation, maximum) = Correlation { constant, harmonics: &products[..n] }.maximum();
        let overlap = f64::from(self.scale) * f64::from(reference.scale) * maximum;
        let distance = (self.energy() + reference.energy() - 2.0 * overlap).max(0.0).sqrt();
        Comparison { distance, rotation }
    }
}

/// $`\sum_r a_r \bar b_r`$, real and imaginary part.
pub(super) fn cross_product(a: (&[i8], &[i8]), b: (&[i8], &[i8])) -> (f64, f64) {
    (f64::from(dot(a.0, b.0) + dot(a.1, b.1)), f64::from(dot(a.1, b.0) - dot(a.0, b.1)))
}

/// Of whole lanes. At most 64 · 127 numbers, of squares of 127: far from an overflow.
pub(super) fn dot(a: &[i8], b: &[i8]) -> i32 {
    let mut sums = [0; LANES];
    for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += i32::from(a[lane]) * i32::from(b[lane]);
        }
    }
    sums.iter().sum()
}
