use super::{
    correlation::Correlation,
    descriptor::{MOST_GROUPS, PanoramaDescriptor},
};
use crate::Comparison;

/// Harmonics that are multiplied side by side.
pub(super) const HARMONICS: usize = 8;
/// Cosines of the first group after which a comparison may be given up.
pub(super) const SLOW: usize = 8;

/// A view that is about to be compared with many references.
///
/// Single precision is exact here: whole numbers of up to 127, and sums of at most 2 · 255 of their products, stay below $`2^{24}`$.
#[derive(Clone, Debug)]
pub struct PanoramaProbe {
    scale: f64,
    n_rings: u8,
    n_harmonics: usize,
    energy: f64,
    after_slow: f64,
    remaining: [f64; MOST_GROUPS],
    constant: Vec<f32>,
    /// As the lanes of the descriptor.
    groups: Vec<Vec<[f32; 2 * HARMONICS]>>,
}

/// $`\sum_r a_r \bar b_r`$ of the eight harmonics of a group, real and imaginary parts.
#[derive(Clone, Copy, Default)]
struct Sums {
    re: [f32; HARMONICS],
    im: [f32; HARMONICS],
}

impl Sums {
    /// Takes in some cosines of a view and as many of a reference.
    fn add(&mut self, own: &[[f32; 2 * HARMONICS]], other: &[i8]) {
        for (own, other) in own.iter().zip(other.chunks_exact(2 * HARMONICS)) {
            self.add_one(own, other);
        }
    }

    #[inline(always)]
    fn add_one(&mut self, own: &[f32; 2 * HARMONICS], other: &[i8]) {
        for lane in 0..HARMONICS {
            let (a_re, a_im) = (own[lane], own[HARMONICS + lane]);
            let (b_re, b_im) = (f32::from(other[lane]), f32::from(other[HARMONICS + lane]));
            self.re[lane] += a_re * b_re + a_im * b_im;
            self.im[lane] += a_im * b_re - a_re * b_im;
        }
    }

    /// The sum of their magnitudes, rounded up.
    fn magnitude(&self) -> f64 {
        let mut magnitudes = [0.0; HARMONICS];
        for (magnitude, (re, im)) in magnitudes.iter_mut().zip(self.re.iter().zip(&self.im)) {
            *magnitude = (re * re + im * im).sqrt();
        }
        f64::from(magnitudes.iter().sum::<f32>()) * (1.0 + ROUNDING)
    }
}

impl PanoramaProbe {
    pub(super) fn new(view: &PanoramaDescriptor) -> Self {
        let ring = |lanes: &[i8]| std::array::from_fn(|lane| f32::from(lanes[lane]));
        let group = |lanes: &[i8]| lanes.chunks_exact(2 * HARMONICS).map(ring).collect();
        Self {
            scale: f64::from(view.scale()),
            n_rings: view.n_rings(),
            n_harmonics: view.n_harmonics(),
            energy: view.energy(),
            after_slow: view.after_slow(),
            remaining: std::array::from_fn(|group| view.remaining(group)),
            constant: view.constant().iter().map(|q| f32::from(*q)).collect(),
            groups: view.groups().map(group).collect(),
        }
    }

    fn fits(&self, reference: &PanoramaDescriptor) -> bool {
        self.n_rings == reference.n_rings() && self.n_harmonics == reference.n_harmonics()
    }

    /// A lower bound of the distance that gives up after the slow cosines, or any group, whose rest cannot bring it below `enough`.
    pub(super) fn bound(&self, reference: &PanoramaDescriptor, enough: f64) -> f64 {
        if !self.fits(reference) {
            return f64::INFINITY;
        }
        let mut overlap = self.constant_product(reference);
        // Parallel vectors of what remains would add so much (Cauchy-Schwarz).
        let least =
            |overlap: f64, own: f64, other: f64| self.distance(reference, overlap + (own * other).sqrt());
        let mut bound = 0.0;
        for (index, (own, other)) in self.groups.iter().zip(reference.groups()).enumerate() {
            let slow = if index == 0 { SLOW.min(own.len()) } else { own.len() };
            let (own, own_rest) = own.split_at(slow);
            let (other, other_rest) = other.split_at(slow * 2 * HARMONICS);
            let mut sums = Sums::default();
            sums.add(own, other);
            if index == 0 {
                bound = least(overlap + sums.magnitude(), self.after_slow, reference.after_slow());
                if bound > enough {
                    break;
                }
                sums.add(own_rest, other_rest);
            }
            overlap += sums.magnitude();
            bound = least(overlap, self.remaining[index], reference.remaining(index));
            if bound > enough {
                break;
            }
        }
        bound
    }

    pub(super) fn compare(&self, reference: &PanoramaDescriptor) -> Comparison {
        if !self.fits(reference) {
            return INCOMPARABLE;
        }
        let products = self.groups.iter().zip(reference.groups()).map(|(own, other)| {
            let mut sums = Sums::default();
            sums.add(own, other);
            sums
        });
        let (rotation, maximum) = best_rotation(self.constant_product(reference), products, self.n_harmonics);
        Comparison { distance: self.distance(reference, maximum), rotation }
    }

    fn constant_product(&self, reference: &PanoramaDescriptor) -> f64 {
        let (own, other) =
            (self.constant.chunks_exact(HARMONICS), reference.constant().chunks_exact(HARMONICS));
        let rest = own.remainder().iter().zip(other.remainder()).map(|(a, b)| a * f32::from(*b)).sum::<f32>();
        // Side by side: a single sum would wait for itself at each step.
        let mut sums = [0.0; HARMONICS];
        for (own, other) in own.zip(other) {
            for lane in 0..HARMONICS {
                sums[lane] += own[lane] * f32::from(other[lane]);
            }
        }
        f64::from(sums.iter().sum::<f32>() + rest)
    }

    fn distance(&self, reference: &PanoramaDescriptor, overlap: f64) -> f64 {
        distance(self.scale * f64::from(reference.scale()), self.energy + reference.energy(), overlap)
    }
}

/// Compares two views once, where making one of them ready is not worth it: the same bits.
pub(super) fn compare_once(view: &PanoramaDescriptor, reference: &PanoramaDescriptor) -> Comparison {
    if !view.has_shape_of(reference) {
        return INCOMPARABLE;
    }
    let constant = view.constant().iter().zip(reference.constant());
    let constant = constant.map(|(a, b)| i32::from(*a) * i32::from(*b)).sum::<i32>();
    let ready = |lanes: &[i8]| std::array::from_fn(|lane| f32::from(lanes[lane]));
    let products = view.groups().zip(reference.groups()).map(|(own, other)| {
        let mut sums = Sums::default();
        for (own, other) in own.chunks_exact(2 * HARMONICS).zip(other.chunks_exact(2 * HARMONICS)) {
            sums.add_one(&ready(own), other);
        }
        sums
    });
    let (rotation, maximum) = best_rotation(f64::from(constant), products, view.n_harmonics());
    let scales = f64::from(view.scale()) * f64::from(reference.scale());
    Comparison { distance: distance(scales, view.energy() + reference.energy(), maximum), rotation }
}

const INCOMPARABLE: Comparison = Comparison { distance: f64::INFINITY, rotation: 0.0 };

/// Where the correlation is largest, and how large.
fn best_rotation(constant: f64, products: impl Iterator<Item = Sums>, n_harmonics: usize) -> (f64, f64) {
    let mut harmonics = [(0.0, 0.0); MOST_GROUPS * HARMONICS];
    for (sums, harmonics) in products.zip(harmonics.chunks_exact_mut(HARMONICS)) {
        for (harmonic, (re, im)) in harmonics.iter_mut().zip(sums.re.iter().zip(&sums.im)) {
            *harmonic = (f64::from(*re), f64::from(*im));
        }
    }
    Correlation { constant, harmonics: &harmonics[..n_harmonics - 1] }.maximum()
}

/// The distance of views whose energies add up to so much and whose whole numbers overlap so much.
fn distance(scales: f64, energies: f64, overlap: f64) -> f64 {
    (energies - 2.0 * scales * overlap).max(0.0).sqrt()
}

/// More than what square roots and sums of single precision lose: eight sums, a root and a product of 6e-8 each.
const ROUNDING: f64 = 1e-6;
