use super::{
    correlation::Correlation,
    descriptor::{MOST_GROUPS, PanoramaDescriptor},
};
use crate::Comparison;

/// Harmonics that are multiplied side by side.
pub(super) const HARMONICS: usize = 8;

/// A view that is about to be compared with many references.
///
/// Single precision is exact here: whole numbers of up to 127, and sums of at most 2 · 255 of their products, stay below $`2^{24}`$.
#[derive(Clone, Debug)]
pub struct PanoramaProbe {
    scale: f64,
    n_rings: u8,
    n_harmonics: usize,
    energy: f64,
    remaining: [f64; MOST_GROUPS],
    constant: Vec<f32>,
    /// As the lanes of the descriptor.
    groups: Vec<Vec<[f32; 2 * HARMONICS]>>,
}

/// Real and imaginary parts of the products of a group.
type Products = ([f32; HARMONICS], [f32; HARMONICS]);

impl PanoramaProbe {
    pub(super) fn new(view: &PanoramaDescriptor) -> Self {
        let ring = |lanes: &[i8]| std::array::from_fn(|lane| f32::from(lanes[lane]));
        let group = |lanes: &[i8]| lanes.chunks_exact(2 * HARMONICS).map(ring).collect();
        Self {
            scale: f64::from(view.scale()),
            n_rings: view.n_rings(),
            n_harmonics: view.n_harmonics(),
            energy: view.energy(),
            remaining: std::array::from_fn(|group| view.remaining(group)),
            constant: view.constant().iter().map(|q| f32::from(*q)).collect(),
            groups: view.groups().map(group).collect(),
        }
    }

    fn fits(&self, reference: &PanoramaDescriptor) -> bool {
        self.n_rings == reference.n_rings() && self.n_harmonics == reference.n_harmonics()
    }

    /// A lower bound of the distance that gives up after any group whose rest cannot bring it below `enough`.
    pub(super) fn bound(&self, reference: &PanoramaDescriptor, enough: f64) -> f64 {
        if !self.fits(reference) {
            return f64::INFINITY;
        }
        let mut overlap = self.constant_product(reference);
        let mut bound = 0.0;
        for (index, (own, other)) in self.groups.iter().zip(reference.groups()).enumerate() {
            let (re, im) = products(own, other);
            let mut magnitudes = [0.0; HARMONICS];
            for lane in 0..HARMONICS {
                magnitudes[lane] = (re[lane] * re[lane] + im[lane] * im[lane]).sqrt();
            }
            overlap += f64::from(magnitudes.iter().sum::<f32>()) * (1.0 + ROUNDING);
            // Parallel vectors of the remaining harmonics would add this (Cauchy-Schwarz).
            let most = overlap + (self.remaining[index] * reference.remaining(index)).sqrt();
            bound = self.distance(reference, most);
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
        let products = self.groups.iter().zip(reference.groups()).map(|(own, other)| products(own, other));
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
        let (mut re, mut im) = ([0.0; HARMONICS], [0.0; HARMONICS]);
        for (own, other) in own.chunks_exact(2 * HARMONICS).zip(other.chunks_exact(2 * HARMONICS)) {
            add_product(&ready(own), other, &mut re, &mut im);
        }
        (re, im)
    });
    let (rotation, maximum) = best_rotation(f64::from(constant), products, view.n_harmonics());
    let scales = f64::from(view.scale()) * f64::from(reference.scale());
    Comparison { distance: distance(scales, view.energy() + reference.energy(), maximum), rotation }
}

const INCOMPARABLE: Comparison = Comparison { distance: f64::INFINITY, rotation: 0.0 };

/// Where the correlation is largest, and how large.
fn best_rotation(constant: f64, products: impl Iterator<Item = Products>, n_harmonics: usize) -> (f64, f64) {
    let mut harmonics = [(0.0, 0.0); MOST_GROUPS * HARMONICS];
    for ((re, im), harmonics) in products.zip(harmonics.chunks_exact_mut(HARMONICS)) {
        for lane in 0..HARMONICS {
            harmonics[lane] = (f64::from(re[lane]), f64::from(im[lane]));
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

/// $`\sum_r a_r \bar b_r`$ of eight harmonics: a view's rings with those of a reference.
fn products(own: &[[f32; 2 * HARMONICS]], other: &[i8]) -> Products {
    let (mut re, mut im) = ([0.0; HARMONICS], [0.0; HARMONICS]);
    for (own, other) in own.iter().zip(other.chunks_exact(2 * HARMONICS)) {
        add_product(own, other, &mut re, &mut im);
    }
    (re, im)
}

#[inline(always)]
fn add_product(
    own: &[f32; 2 * HARMONICS],
    other: &[i8],
    re: &mut [f32; HARMONICS],
    im: &mut [f32; HARMONICS],
) {
    for lane in 0..HARMONICS {
        let (a_re, a_im) = (own[lane], own[HARMONICS + lane]);
        let (b_re, b_im) = (f32::from(other[lane]), f32::from(other[HARMONICS + lane]));
        re[lane] += a_re * b_re + a_im * b_im;
        im[lane] += a_im * b_re - a_re * b_im;
    }
}
