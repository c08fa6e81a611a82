use super::{
    correlation::Correlation,
    descriptor::{MOST_GROUPS, PanoramaDescriptor},
    lanes::{HARMONICS, Pairs, Sums},
    low_harmonics::LowHarmonicsProbe,
};
use crate::ViewDifference;

/// Cosines of the first group after which a comparison may be given up.
pub(super) const N_LOW_HARMONICS: usize = 8;

/// A view that is about to be compared with many references.
///
/// Its products with a reference are exact.
///
/// ```
/// use wayfix_appearance_cml::{LowerBoundedDistance, PanoramaDescriptor, PanoramaQuery, ViewDescriptor};
/// let view = |re: i8, im: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, im]);
/// let seen = view(50, 10)?;
/// let query: PanoramaQuery = seen.probe();
/// for reference in [view(20, 0)?, view(0, -90)?] {
///     assert_eq!(reference.compare_with(&query), seen.compare(&reference)); // to the bit
/// }
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PanoramaQuery {
    scale: f64,
    n_rings: u8,
    n_harmonics: usize,
    energy: f64,
    energy_above_low_harmonics: f64,
    remaining: [f64; MOST_GROUPS],
    slow: LowHarmonicsProbe,
    constant: Vec<f32>,
    /// As the lanes of the descriptor.
    groups: Vec<Vec<Pairs>>,
}

impl PanoramaQuery {
    pub(super) fn new(view: &PanoramaDescriptor) -> Self {
        let group = |lanes: &[i8]| lanes.chunks_exact(2 * HARMONICS).map(Pairs::new).collect();
        Self {
            scale: f64::from(view.scale()),
            n_rings: view.n_rings(),
            n_harmonics: view.n_harmonics(),
            energy: view.energy(),
            energy_above_low_harmonics: view.energy_above_low_harmonics(),
            remaining: std::array::from_fn(|group| view.remaining(group)),
            slow: LowHarmonicsProbe::new(view),
            constant: view.constant().iter().map(|q| f32::from(*q)).collect(),
            groups: view.groups().map(group).collect(),
        }
    }

    pub(super) fn slow(&self) -> &LowHarmonicsProbe {
        &self.slow
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
            let slow = if index == 0 { N_LOW_HARMONICS.min(own.len()) } else { own.len() };
            let (own, own_rest) = own.split_at(slow);
            let (other, other_rest) = other.split_at(slow * 2 * HARMONICS);
            let mut sums = Sums::default();
            sums.add(own, other);
            if index == 0 {
                bound = least(
                    overlap + magnitude(&sums),
                    self.energy_above_low_harmonics,
                    reference.energy_above_low_harmonics(),
                );
                if bound > enough {
                    break;
                }
                sums.add(own_rest, other_rest);
            }
            overlap += magnitude(&sums);
            bound = least(overlap, self.remaining[index], reference.remaining(index));
            if bound > enough {
                break;
            }
        }
        bound
    }

    pub(super) fn compare(&self, reference: &PanoramaDescriptor) -> ViewDifference {
        if !self.fits(reference) {
            return INCOMPARABLE;
        }
        let products = self.groups.iter().zip(reference.groups()).map(|(own, other)| {
            let mut sums = Sums::default();
            sums.add(own, other);
            sums
        });
        let (rotation, maximum) = best_rotation(self.constant_product(reference), products, self.n_harmonics);
        ViewDifference { distance: self.distance(reference, maximum), rotation }
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
pub(super) fn compare_once(view: &PanoramaDescriptor, reference: &PanoramaDescriptor) -> ViewDifference {
    if !view.has_shape_of(reference) {
        return INCOMPARABLE;
    }
    let constant = view.constant().iter().zip(reference.constant());
    let constant = constant.map(|(a, b)| i32::from(*a) * i32::from(*b)).sum::<i32>();
    let products = view.groups().zip(reference.groups()).map(|(own, other)| {
        let mut sums = Sums::default();
        for (own, other) in own.chunks_exact(2 * HARMONICS).zip(other.chunks_exact(2 * HARMONICS)) {
            sums.add(&[Pairs::new(own)], other);
        }
        sums
    });
    let (rotation, maximum) = best_rotation(f64::from(constant), products, view.n_harmonics());
    let scales = f64::from(view.scale()) * f64::from(reference.scale());
    ViewDifference { distance: distance(scales, view.energy() + reference.energy(), maximum), rotation }
}

const INCOMPARABLE: ViewDifference = ViewDifference { distance: f64::INFINITY, rotation: 0.0 };

/// Where the correlation is largest, and how large.
fn best_rotation(constant: f64, products: impl Iterator<Item = Sums>, n_harmonics: usize) -> (f64, f64) {
    let mut harmonics = [(0.0, 0.0); MOST_GROUPS * HARMONICS];
    for (sums, harmonics) in products.zip(harmonics.chunks_exact_mut(HARMONICS)) {
        for (harmonic, sum) in harmonics.iter_mut().zip(sums.harmonics()) {
            *harmonic = sum;
        }
    }
    Correlation { constant, harmonics: &harmonics[..n_harmonics - 1] }.maximum()
}

/// The distance of views whose energies add up to so much and whose whole numbers overlap so much.
fn distance(scales: f64, energies: f64, overlap: f64) -> f64 {
    (energies - 2.0 * scales * overlap).max(0.0).sqrt()
}

/// The sum of the magnitudes of the harmonics, rounded up.
fn magnitude(sums: &Sums) -> f64 {
    f64::from(sums.magnitude()) * (1.0 + ROUNDING)
}

/// More than what square roots and sums of single precision lose: eight sums, a root and a product of 6e-8 each.
const ROUNDING: f64 = 1e-6;
