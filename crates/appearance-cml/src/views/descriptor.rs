use super::lanes::HARMONICS;
use super::probe::{N_LOW_HARMONICS, compare_once};
use crate::{AppearanceMapError, ViewDescriptor, ViewDifference};

/// Harmonics beside the constant one, in groups.
pub(super) const MOST_GROUPS: usize = 8;
/// Harmonics of a descriptor, the constant one included.
const MOST_HARMONICS: usize = MOST_GROUPS * HARMONICS;

/// The spectrum of a panorama over the azimuth, in a byte a number: less than a kilobyte for 25 rings and 16 harmonics.
///
/// The numbers are $`c = s q`$ with whole $`q`$ from −127 to 127 and one scale $`s`$ a view. What rounding does to a distance is below
/// $`s\sqrt{n/12}`$ in the mean, about 0.015 for views whose distances are from 0.1 to 1. Sums of products of whole numbers are exact, so that
/// a view is at distance 0 from itself, and every search that compares the stored numbers gives the same bits.
///
/// Over the rings they are cosines. The distance is $`d² = \min_φ \sum_{rk} |a_{rk} e^{\mathrm i kφ} - b_{rk}|²`$: the root mean square difference of the cells of two normalized views
/// at the best rotation, as far as the harmonics go. It obeys the triangle inequality. Views of different shape are at infinite distance.
///
/// ```
/// use wayfix_appearance_cml::{PanoramaDescriptor, ViewDescriptor};
/// let view = |re: i8, im: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, im]);
/// // At the best rotation 50 and 20 steps of the scale differ by 30.
/// assert!((view(50, 0)?.compare(&view(0, 20)?).distance - 0.3).abs() < 1e-6);
/// assert!(view(-128, 0).is_err());
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PanoramaDescriptor {
    scale: f32,
    n_rings: u8,
    n_harmonics: u8,
    /// The constant harmonic of all cosines; then, group by group of eight harmonics and cosine by cosine, eight pairs of real and imaginary parts.
    lanes: Box<[i8]>,
    /// Sums of squares of the whole numbers: of all, of what comes after the slow cosines of the first group, and after each group.
    energy: u32,
    energy_above_low_harmonics: u32,
    remaining: [u32; MOST_GROUPS],
}

impl PanoramaDescriptor {
    /// From what [`scale`](Self::scale), [`n_rings`](Self::n_rings) and [`coefficients`](Self::coefficients) give.
    ///
    /// # Errors
    /// [`AppearanceMapError::Descriptor`] when the scale is not finite and positive, a coefficient is −128, or their number is not an odd multiple of the
    /// rings of at most 64 harmonics.
    pub fn from_parts(scale: f32, n_rings: u8, coefficients: Vec<i8>) -> Result<Self, AppearanceMapError> {
        let refused = AppearanceMapError::Descriptor { scale, n_rings, n_coefficients: coefficients.len() };
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
        let (constant, rest) = coefficients.split_at(n);
        let n_harmonics = rest.len() / n / 2;
        let mut lanes = constant.to_vec();
        lanes.resize(n + n_harmonics.div_ceil(HARMONICS) * n * 2 * HARMONICS, 0);
        for (index, value) in rest.iter().enumerate() {
            let (harmonic, part, ring) = (index / (2 * n), index / n % 2, index % n);
            lanes[n + place(n, harmonic, part, ring)] = *value;
        }
        let energy = |lanes: &[i8]| lanes.iter().map(|q| u32::from(q.unsigned_abs()).pow(2)).sum();
        let after = |group: usize| lanes.get(n + (group + 1) * n * 2 * HARMONICS..).map_or(0, energy);
        let energy_above_low_harmonics =
            lanes.get(n + N_LOW_HARMONICS.min(n) * 2 * HARMONICS..).map_or(0, energy);
        let (energy, remaining) = (energy(&lanes), std::array::from_fn(after));
        Self {
            scale,
            n_rings,
            n_harmonics: n_harmonics as u8,
            lanes: lanes.into(),
            energy,
            energy_above_low_harmonics,
            remaining,
        }
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
        usize::from(self.n_harmonics) + 1
    }

    /// Harmonic by harmonic: the real parts, then, but for the constant one, the imaginary parts; each as cosines over the rings, the slowest first.
    pub fn coefficients(&self) -> Vec<i8> {
        let mut coefficients = self.constant().to_vec();
        for harmonic in 1..self.n_harmonics() {
            let (re, im) = self.harmonic(harmonic);
            coefficients.extend(re);
            coefficients.extend(im);
        }
        coefficients
    }

    /// A view between two, `share` of the way to the other, if they can be compared: what might be seen in between where both face the same way.
    pub fn blend(&self, other: &Self, share: f64) -> Option<Self> {
        let value = |own: &Self, q: i8| f64::from(own.scale) * f64::from(q);
        let between = |(a, b): (i8, i8)| (1.0 - share) * value(self, a) + share * value(other, b);
        let spectrum: Vec<f64> =
            self.coefficients().into_iter().zip(other.coefficients()).map(between).collect();
        self.has_shape_of(other).then(|| Self::quantized(usize::from(self.n_rings), &spectrum))
    }

    /// Whether two descriptors can be compared.
    pub(crate) fn has_shape_of(&self, other: &Self) -> bool {
        self.n_rings == other.n_rings && self.n_harmonics == other.n_harmonics
    }

    /// The sum of the squares of all coefficients.
    pub fn energy(&self) -> f64 {
        let scale = f64::from(self.scale);
        scale * scale * f64::from(self.energy)
    }

    pub(super) fn constant(&self) -> &[i8] {
        &self.lanes[..usize::from(self.n_rings)]
    }

    /// Real and imaginary parts of a harmonic from the first on, cosine by cosine.
    pub(super) fn harmonic(&self, harmonic: usize) -> (Vec<i8>, Vec<i8>) {
        let n = usize::from(self.n_rings);
        let part = |part| (0..n).map(|ring| self.lanes[n + place(n, harmonic - 1, part, ring)]).collect();
        (part(0), part(1))
    }

    /// Group by group, what a probe multiplies.
    pub(super) fn groups(&self) -> impl Iterator<Item = &[i8]> {
        let n = usize::from(self.n_rings);
        self.lanes[n..].chunks_exact(n * 2 * HARMONICS)
    }

    /// Sum of squares of what comes after the slow cosines of the first group.
    pub(super) fn energy_above_low_harmonics(&self) -> f64 {
        f64::from(self.energy_above_low_harmonics)
    }

    /// Sum of squares of the harmonics after a group.
    pub(super) fn remaining(&self, group: usize) -> f64 {
        f64::from(self.remaining[group])
    }
}

impl ViewDescriptor for PanoramaDescriptor {
    fn compare(&self, reference: &Self) -> ViewDifference {
        compare_once(self, reference)
    }
}

/// Where a part (real or imaginary) of a harmonic, counted from the first that is not constant, is among the groups.
fn place(n_rings: usize, harmonic: usize, part: usize, ring: usize) -> usize {
    let (group, lane) = (harmonic / HARMONICS, harmonic % HARMONICS);
    ((group * n_rings + ring) * HARMONICS + lane) * 2 + part
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn a_blend_lies_between_its_views() {
        let view = |first: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![10, first, 40]).unwrap();
        let (a, b) = (view(-100), view(100));
        let blend = a.blend(&b, 0.25).unwrap();
        // Steps of a byte are 0.5 / 127 here, and half of one is 0.00197.
        let value = |at: usize| f64::from(blend.scale()) * f64::from(blend.coefficients()[at]);
        for (at, expected) in [(0, 0.1), (1, -0.5), (2, 0.4)] {
            assert_abs_diff_eq!(value(at), expected, epsilon = 0.002);
        }
        assert!(a.blend(&PanoramaDescriptor::from_parts(0.01, 1, vec![10]).unwrap(), 0.5).is_none());
    }

    #[test]
    fn coefficients_come_back_for_any_number_of_rings_and_harmonics() {
        for n_rings in [1, 2, 7, 25, 64] {
            for n_harmonics in [1, 2, 8, 9, 10, 16, 17, 64] {
                let n = n_rings * (2 * n_harmonics - 1);
                let coefficients: Vec<i8> = (0..n).map(|i| (i % 251) as i16 - 125).map(|q| q as i8).collect();
                let view = PanoramaDescriptor::from_parts(0.01, n_rings as u8, coefficients.clone()).unwrap();
                assert_eq!((view.coefficients(), view.n_harmonics()), (coefficients, n_harmonics));
            }
        }
    }
}
