use super::channels::lane::ComplexLane;
use super::channels::planes::{PlaneFourier, Planes, Spectrum};

/// A correlation filter with the target as its support; its surroundings serve only as negative examples.
/// ```math
/// f = \arg\min_f \tfrac12 ‖\sum_d f_d ⋆ x_d − y‖² + \tfrac{μ}{2} \sum_d ‖f_d − f_d^{t−1}‖², \qquad f_d = 0 \text{ outside the target}
/// ```
///
/// with $`y`$ a narrow Gaussian, solved by alternating directions: over frequencies by the Sherman-Morrison formula, over cells by the
/// support. [Galoogahi et al. 2017; Li et al. 2018]
#[derive(Clone, Debug)]
pub(super) struct CorrelationFilter {
    fourier: PlaneFourier,
    /// Spectrum of $`y`$, real because $`y`$ is even.
    desired: Vec<f32>,
    support: Vec<f32>,
}

/// Parameters of filter learning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Learning {
    /// $`μ`$, in units of the mean energy of a frequency of the sample.
    pub(super) inertia: f32,
    /// Weight of the agreement between the two domains, in the same units.
    pub(super) penalty: f32,
}

/// Rounds of alternating directions; more change the filter by less than the next picture does.
const ROUNDS: usize = 2;

impl CorrelationFilter {
    /// For grids of `side` cells; `sigma` is the width of the desired response in cells, `support` is 1 on the target and 0 outside.
    pub(super) fn new(side: usize, sigma: f64, support: Vec<f32>) -> Self {
        let fourier = PlaneFourier::new(side);
        let mut planes = Planes::zeros(side, 1);
        let off = |i: usize| i.min(side - i) as f64;
        for (i, cell) in planes.cells.iter_mut().enumerate() {
            let squared = off(i % side).powi(2) + off(i / side).powi(2);
            cell[0] = libm::exp(-0.5 * squared / (sigma * sigma)) as f32;
        }
        let desired = fourier.forward(&planes).bins.iter().map(|bin| bin.re[0]).collect();
        Self { fourier, desired, support }
    }

    /// The Fourier transform of the samples.
    pub(super) fn fourier(&self) -> &PlaneFourier {
        &self.fourier
    }

    /// Response of a filter to a sample at every shift in cells, row by row with shift zero at the top left; about 1 at the target.
    pub(super) fn response(&self, filter: &Spectrum, sample: &Spectrum) -> Vec<f32> {
        let mut sums = vec![ComplexLane::default(); self.fourier.n_bins()];
        for (f, x) in filter.groups().zip(sample.groups()) {
            for ((sum, f), x) in sums.iter_mut().zip(f).zip(x) {
                let [re, im] = f.dot(x);
                sum.re[0] += re;
                sum.im[0] += im;
            }
        }
        let sums = self.fourier.spectrum(sums);
        self.fourier.backward(&sums).cells.iter().map(|cell| cell[0]).collect()
    }

    /// The filter learned from a sample with the target in the middle, near the one before.
    pub(super) fn learned(
        &self,
        before: Option<&Spectrum>,
        sample: &Spectrum,
        learning: Learning,
    ) -> Spectrum {
        let nothing = self.fourier.spectrum(vec![ComplexLane::default(); sample.bins.len()]);
        let (before, inertia) = before.map_or((&nothing, 0.0), |filter| (filter, learning.inertia));
        let (mut constrained, mut dual) = (before.clone(), nothing.clone());
        let penalty = learning.penalty;
        for _ in 0..ROUNDS {
            let mut free =
                self.pulled(sample, [(before, inertia), (&constrained, penalty), (&dual, -penalty)]);
            self.solve(sample, inertia + penalty, &mut free);
            (constrained, dual) = self.constrained(free, &dual);
        }
        constrained
    }

    /// The right side $`q = x ŷ + μ f_{t−1} + γ (g − u)`$, from the weighted others.
    fn pulled(&self, sample: &Spectrum, others: [(&Spectrum, f32); 3]) -> Spectrum {
        let n_bins = self.fourier.n_bins();
        let mut pulled = sample.clone();
        for (i, q) in pulled.bins.iter_mut().enumerate() {
            *q = q.scaled(self.desired[i % n_bins]);
        }
        for (other, weight) in others {
            for (q, value) in pulled.bins.iter_mut().zip(&other.bins) {
                *q = *q + value.scaled(weight);
            }
        }
        pulled
    }

    /// $`(x x^H + w I)^{-1} q = (q − x (x^H q) / (w + x^H x)) / w`$ at every frequency.
    fn solve(&self, sample: &Spectrum, weight: f32, q: &mut Spectrum) {
        let n_bins = self.fourier.n_bins();
        let mut along = vec![[0.0_f32; 2]; n_bins];
        let mut energy = vec![0.0_f32; n_bins];
        for (x, q) in sample.groups().zip(q.groups()) {
            for (((sum, energy), x), q) in along.iter_mut().zip(&mut energy).zip(x).zip(q) {
                let [re, im] = x.dot(q);
                sum[0] += re;
                sum[1] += im;
                *energy += x.energy();
            }
        }
        for (sum, energy) in along.iter_mut().zip(&energy) {
            *sum = sum.map(|v| v / (weight + energy));
        }
        for (x, q) in sample.groups().zip(q.groups_mut()) {
            for ((q, x), &sum) in q.iter_mut().zip(x).zip(&along) {
                *q = (*q - x.turned(sum)).scaled(1.0 / weight);
            }
        }
    }

    /// The filter nearest to `free + dual` that vanishes outside the support, and the remainder as the new dual.
    fn constrained(&self, mut free: Spectrum, dual: &Spectrum) -> (Spectrum, Spectrum) {
        for (value, u) in free.bins.iter_mut().zip(&dual.bins) {
            *value = *value + *u;
        }
        let mut planes = self.fourier.backward(&free);
        for group in planes.groups_mut() {
            for (cell, &support) in group.iter_mut().zip(&self.support) {
                *cell = cell.map(|v| v * support);
            }
        }
        let constrained = self.fourier.forward(&planes);
        for (value, g) in free.bins.iter_mut().zip(&constrained.bins) {
            *value = *value - *g;
        }
        (constrained, free)
    }
}

#[cfg(test)]
mod tests {
    use super::super::response::Peak;
    use super::*;
    use approx::assert_abs_diff_eq;

    const SIDE: usize = 24;

    /// Noise of energy 1, shifted cyclically by this number of cells.
    fn sample(shift: [usize; 2]) -> Planes {
        let mut planes = Planes::zeros(SIDE, 2);
        let scale = 1.0 / ((2 * 8 * SIDE * SIDE) as f32 / 12.0).sqrt();
        for (i, cell) in planes.cells.iter_mut().enumerate() {
            let (group, x, y) = (i / (SIDE * SIDE), i % SIDE, i / SIDE % SIDE);
            let (x, y) = ((x + SIDE - shift[0]) % SIDE, (y + SIDE - shift[1]) % SIDE);
            *cell = std::array::from_fn(|c| scale * (hash(((group * SIDE + y) * SIDE + x) * 8 + c) - 0.5));
        }
        planes
    }

    /// SplitMix64 as a function of a place, from 0 to 1.
    fn hash(place: usize) -> f32 {
        let mut z = (place as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1_u32 << 24) as f32
    }

    fn learned() -> (CorrelationFilter, Spectrum) {
        let inside = |i: usize| i.abs_diff(SIDE / 2) <= 5;
        let support = (0..SIDE * SIDE).map(|i| f32::from(inside(i % SIDE) && inside(i / SIDE))).collect();
        let filter = CorrelationFilter::new(SIDE, 0.8, support);
        let learning = Learning { inertia: 2.5, penalty: 0.2 };
        let first = filter.fourier().forward(&sample([0, 0]));
        let before = filter.learned(None, &first, learning);
        let spectrum = filter.learned(Some(&before), &first, learning);
        (filter, spectrum)
    }

    #[test]
    fn answers_where_the_sample_has_moved_to() {
        let (filter, learned) = learned();
        let moved = filter.fourier().forward(&sample([3, SIDE - 2]));
        let peak = Peak::of(&filter.response(&learned, &moved), SIDE);
        assert_abs_diff_eq!(peak.shift[0], 3.0, epsilon = 0.5);
        assert_abs_diff_eq!(peak.shift[1], -2.0, epsilon = 0.5);
        // the largest of 576 normal values is beyond 5 in less than one of a thousand fields
        assert!(peak.peak_to_sidelobe > 5.0, "{peak:?}");
    }

    #[test]
    fn vanishes_outside_its_support() {
        let (filter, learned) = learned();
        let planes = filter.fourier().backward(&learned);
        let largest = |inside: bool| {
            let cells = planes
                .cells
                .iter()
                .enumerate()
                .filter(|(i, _)| (filter.support[i % (SIDE * SIDE)] > 0.0) == inside);
            cells.flat_map(|(_, cell)| cell).fold(0.0_f32, |most, v| most.max(v.abs()))
        };
        assert!(largest(false) < 1e-5 * largest(true)); // f32 rounding of two transforms
    }
}
