use super::lane::ComplexLane;
use super::planes::{PlaneFourier, Planes, Spectrum};

/// A correlation filter whose support is the target: what lies around it is only there to be told apart.
///
/// ```math
/// f = \arg\min_f \tfrac12 ‖\sum_d f_d ⋆ x_d − y‖² + \tfrac{μ}{2} \sum_d ‖f_d − f_d^{t−1}‖², \qquad f_d = 0 \text{ outside the target}
/// ```
///
/// with $`y`$ a narrow Gaussian, solved by alternating directions: over frequencies by the Sherman-Morrison formula, over cells by the
/// support. [Galoogahi et al. 2017, Eqs. 4-10; Li et al. 2018, Eqs. 5-11]
#[derive(Clone, Debug)]
pub(super) struct CorrelationFilter {
    fourier: PlaneFourier,
    /// Spectrum of $`y`$, real because $`y`$ is even.
    desired: Vec<f32>,
    support: Vec<f32>,
}

/// How a filter is learned.
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
    /// For grids of `side` cells; `sigma` is the width of the desired response in cells, `support` is 1 on the target and 0 elsewhere.
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

    /// The transform the samples come from.
    pub(super) fn fourier(&self) -> &PlaneFourier {
        &self.fourier
    }

    /// How a filter answers to a sample at every shift in cells, row by row with shift zero at the top left; about 1 at the target.
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
        let n_bins = self.fourier.n_bins();
        let mut energy = vec![0.0_f32; n_bins];
        for group in sample.groups() {
            for (sum, x) in energy.iter_mut().zip(group) {
                *sum += x.energy();
            }
        }
        let inertia = if before.is_some() { learning.inertia } else { 0.0 };
        let mut constrained: Option<Spectrum> = before.cloned();
        let mut dual: Option<Spectrum> = None;
        let penalty = learning.penalty;
        let weight = inertia + penalty;
        for _ in 0..ROUNDS {
            // Q = x ŷ + μ f_{t−1} + γ (g − u), and F = (Q − x (xᴴ Q) / (w + xᴴ x)) / w
            let mut free = self.pulled(
                sample,
                &[(before, inertia), (constrained.as_ref(), penalty), (dual.as_ref(), -penalty)],
            );
            let mut along = vec![[0.0_f32; 2]; n_bins];
            for (x, q) in sample.groups().zip(free.groups()) {
                for ((sum, x), q) in along.iter_mut().zip(x).zip(q) {
                    let [re, im] = x.dot(q);
                    sum[0] += re;
                    sum[1] += im;
                }
            }
            for (sum, energy) in along.iter_mut().zip(&energy) {
                *sum = sum.map(|v| v / (weight + energy));
            }
            for (x, q) in sample.groups().zip(free.groups_mut()) {
                for ((q, x), &sum) in q.iter_mut().zip(x).zip(&along) {
                    *q = (*q - x.turned(sum)).scaled(1.0 / weight);
                }
            }
            constrained = Some(self.constrain(&mut free, dual.as_ref()));
            dual = Some(free);
        }
        constrained.expect("invariant: there is at least one round")
    }

    /// $`x ŷ`$ and weighted others.
    fn pulled(&self, sample: &Spectrum, others: &[(Option<&Spectrum>, f32)]) -> Spectrum {
        let n_bins = self.fourier.n_bins();
        let mut pulled = sample.clone();
        for (i, q) in pulled.bins.iter_mut().enumerate() {
            *q = q.scaled(self.desired[i % n_bins]);
        }
        for (other, weight) in others {
            for (q, value) in pulled.bins.iter_mut().zip(other.iter().flat_map(|s| &s.bins)) {
                *q = *q + value.scaled(*weight);
            }
        }
        pulled
    }

    /// The filter nearest to `free` plus the dual that vanishes outside the support; `free` becomes the new dual.
    fn constrain(&self, free: &mut Spectrum, dual: Option<&Spectrum>) -> Spectrum {
        if let Some(dual) = dual {
            for (value, u) in free.bins.iter_mut().zip(&dual.bins) {
                *value = *value + *u;
            }
        }
        let mut planes = self.fourier.backward(free);
        for group in planes.groups_mut() {
            for (cell, &support) in group.iter_mut().zip(&self.support) {
                *cell = cell.map(|v| v * support);
            }
        }
        let constrained = self.fourier.forward(&planes);
        for (value, g) in free.bins.iter_mut().zip(&constrained.bins) {
            *value = *value - *g;
        }
        constrained
    }
}
