use wide::i16x16;

use super::descriptor::PanoramaDescriptor;
use super::lanes::{HARMONICS, Pairs, Sums, sixteen};

/// Cosines over the rings that are compared first: of the constant harmonic, and of the first eight.
const N_CONSTANT: usize = 16;
const N_SLOW: usize = 8;
/// Their numbers: of the constant harmonic, then cosine by cosine real and imaginary parts side by side.
const N_NUMBERS: usize = N_CONSTANT + N_SLOW * 2 * HARMONICS;

/// The slow changes of a view from top to bottom, and how much there is of everything else.
#[derive(Clone, Debug)]
pub(super) struct LowHarmonics {
    numbers: [i8; N_NUMBERS],
    scale: f32,
    energy: f32,
    /// The norm of all other whole numbers, rounded up.
    rest: f32,
}

/// The same of a view that is about to be compared with many, its products with a number and with its conjugate made ready.
#[derive(Clone, Debug)]
pub(super) struct LowHarmonicsProbe {
    constant: i16x16,
    cosines: [Pairs; N_SLOW],
    scale: f32,
    energy: f32,
    rest: f32,
}

/// More than what some twenty roundings of single precision lose.
const ROUNDING: f32 = 4e-6;

impl LowHarmonics {
    pub(super) fn new(view: &PanoramaDescriptor) -> Self {
        let mut numbers = [0; N_NUMBERS];
        for (number, constant) in numbers.iter_mut().zip(view.constant().iter().take(N_CONSTANT)) {
            *number = *constant;
        }
        let cosines = view.groups().next().into_iter().flat_map(|group| group.chunks_exact(2 * HARMONICS));
        for (pairs, lanes) in numbers[N_CONSTANT..].chunks_exact_mut(2 * HARMONICS).zip(cosines) {
            for (pair, lane) in pairs.iter_mut().zip(lanes) {
                *pair = *lane;
            }
        }
        let taken: f64 = numbers.iter().map(|q| f64::from(*q).powi(2)).sum();
        let scale = f64::from(view.scale());
        let rest = (view.energy() / (scale * scale) - taken).max(0.0).sqrt();
        Self {
            numbers,
            scale: view.scale(),
            energy: view.energy() as f32,
            rest: rest as f32 * (1.0 + ROUNDING),
        }
    }
}

impl LowHarmonicsProbe {
    pub(super) fn new(view: &PanoramaDescriptor) -> Self {
        let slow = LowHarmonics::new(view);
        let pairs = |cosine: usize| Pairs::new(&slow.numbers[N_CONSTANT + cosine * 2 * HARMONICS..]);
        Self {
            constant: sixteen(&slow.numbers),
            cosines: std::array::from_fn(pairs),
            scale: slow.scale,
            energy: slow.energy,
            rest: slow.rest,
        }
    }

    /// A lower bound of the squared distance; not a number where the scales of the views are beyond single precision.
    ///
    /// $`d^2 = |a|^2 + |b|^2 - 2 \max_φ ⟨a, b⟩_φ`$, and no rotation makes the product of the slow parts greater than the sum of the magnitudes of its harmonics,
    /// nor that of the others greater than the product of their norms. Sums of products of whole numbers are exact.
    #[inline]
    pub(super) fn squared_bound(&self, reference: &LowHarmonics) -> f32 {
        let (constant, cosines) = reference.numbers.split_at(N_CONSTANT);
        let mut sums = Sums::default();
        sums.add(&self.cosines, cosines);
        let constant = self.constant.dot(sixteen(constant)).reduce_add() as f32;
        let overlap = constant + sums.magnitude() + self.rest * reference.rest;
        let energies = self.energy + reference.energy;
        energies - 2.0 * self.scale * reference.scale * overlap - ROUNDING * energies.max(f32::MIN_POSITIVE)
    }
}
