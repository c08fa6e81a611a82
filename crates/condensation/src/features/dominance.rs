use std::f64::consts::TAU;

/// What makes a grey value dominate a histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum DominantGrayCriterion {
    /// The three most frequent values, most frequent first, with their shares of the pixels: the paper's. They are often neighbours, and
    /// change with a pixel.
    Counts,
    /// The three highest maxima of the histogram smoothed by a Gaussian of `sigma` grey levels, highest first, with its density there.
    Peaks {
        /// Width of the smoothing, in grey levels; positive.
        sigma: f64,
    },
    /// The means of the three classes into which the histogram falls with the least variance within classes, darkest first, and the
    /// classes' shares. They move smoothly with the picture, linearly with gain and offset. [Otsu 1979]
    Classes,
    /// The same three classes, averaged over all ways to divide the histogram: one that leaves a share $`δ`$ more of the variance within
    /// classes than the best counts $`e^{-δ / τ}`$. So nothing jumps where two divisions are equally good.
    SoftClasses {
        /// $`τ`$, a share of the variance; positive.
        softness: f64,
    },
}

impl Default for DominantGrayCriterion {
    /// Soft classes, with divisions counted that are about three per cent of the variance worse than the best.
    fn default() -> Self {
        Self::SoftClasses { softness: 0.03 }
    }
}

type Density = [f64; 256];

impl DominantGrayCriterion {
    /// At most three pairs of grey value and density.
    pub(super) fn of(self, density: &Density) -> Vec<(f64, f64)> {
        match self {
            Self::Counts => counts(density),
            Self::Peaks { sigma } => peaks(density, sigma),
            Self::Classes => classes(density),
            Self::SoftClasses { softness } => soft_classes(density, softness),
        }
    }

    /// Share of each grey value that belongs to the first, second and third region: those of its class, else the greys that count as the dominating one.
    pub(super) fn memberships(self, density: &Density) -> [Density; 3] {
        let mut memberships = [[0.0; 256]; 3];
        let mut add = |weight: f64, ranges: &[(usize, usize)]| {
            for (membership, &(from, to)) in memberships.iter_mut().zip(ranges) {
                membership[from..to].iter_mut().for_each(|share| *share += weight);
            }
        };
        match self {
            Self::Counts | Self::Peaks { .. } => {
                let reach = if let Self::Peaks { sigma } = self { sigma.max(0.0) as usize } else { 0 };
                let near = |(grey, _): (f64, f64)| {
                    let grey = grey as usize;
                    (grey.saturating_sub(reach), (grey + reach + 1).min(256))
                };
                add(1.0, &self.of(density).into_iter().map(near).collect::<Vec<_>>());
            }
            Self::Classes => {
                let (a, b) = best_division(&Cumulated::new(density));
                add(1.0, &[(0, a), (a, b), (b, 256)]);
            }
            Self::SoftClasses { softness } => {
                let divisions = soft_divisions(&Cumulated::new(density), density, softness);
                let total: f64 = divisions.iter().map(|(weight, ..)| weight).sum();
                for (weight, a, b) in divisions {
                    add(weight / total, &[(0, a), (a, b), (b, 256)]);
                }
            }
        }
        memberships
    }
}

fn counts(density: &Density) -> Vec<(f64, f64)> {
    highest((0..256).map(|i| (i as f64, density[i])).collect())
}

fn peaks(density: &Density, sigma: f64) -> Vec<(f64, f64)> {
    let radius = (3.0 * sigma).ceil().clamp(0.0, 255.0) as usize;
    let weight = |d: usize| if d == 0 { 1.0 } else { (-0.5 * (d as f64 / sigma).powi(2)).exp() };
    let smooth: Density = std::array::from_fn(|i| {
        let near = i.saturating_sub(radius)..=(i + radius).min(255);
        near.map(|j| density[j] * weight(i.abs_diff(j))).sum::<f64>()
            / (sigma.max(TAU.sqrt().recip()) * TAU.sqrt())
    });
    let rises = |i: usize| i == 0 || smooth[i] > smooth[i - 1];
    let falls = |i: usize| i == 255 || smooth[i] >= smooth[i + 1];
    let is_peak = |&i: &usize| smooth[i] > 0.0 && rises(i) && falls(i);
    highest((0..256).filter(is_peak).map(|i| (i as f64, smooth[i])).collect())
}

/// The three of highest density; of equal ones the darker.
fn highest(mut pairs: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
    pairs.truncate(3);
    pairs
}

fn classes(density: &Density) -> Vec<(f64, f64)> {
    let cumulated = Cumulated::new(density);
    let (lower, upper) = best_division(&cumulated);
    vec![cumulated.class(0, lower), cumulated.class(lower, upper), cumulated.class(upper, 256)]
}

/// Exact: for every upper bound the best lower one, which grows with it, so that halving the range saves most comparisons.
fn best_division(cumulated: &Cumulated) -> (usize, usize) {
    let mut lower = [0; 257];
    cumulated.best_lower(2..256, 1..255, &mut lower);
    let quality = |upper: usize| cumulated.two_classes(lower[upper], upper) + cumulated.gain(upper, 256);
    let upper = (2..256).fold(2, |best, upper| if quality(upper) > quality(best) { upper } else { best });
    (lower[upper], upper)
}

fn soft_classes(density: &Density, softness: f64) -> Vec<(f64, f64)> {
    let cumulated = Cumulated::new(density);
    // Sums of weights, of shares and of first moments of each class.
    let (mut total, mut shares, mut means) = (0.0, [0.0; 3], [0.0; 3]);
    for (weight, a, b) in soft_divisions(&cumulated, density, softness) {
        total += weight;
        for (k, (from, to)) in [(0, a), (a, b), (b, 256)].into_iter().enumerate() {
            let (mean, share) = cumulated.class(from, to);
            means[k] += weight * mean;
            shares[k] += weight * share;
        }
    }
    (0..3).map(|k| (means[k] / total, shares[k] / total)).collect()
}

/// Divisions of a histogram into three classes, with their weights; the best one has weight 1.
fn soft_divisions(cumulated: &Cumulated, density: &Density, softness: f64) -> Vec<(f64, usize, usize)> {
    /// Grey levels between bounds that are tried: averaging makes finer ones pointless.
    const STEP: usize = 4;
    let mean = cumulated.moment[256];
    let variance: f64 = density.iter().enumerate().map(|(i, p)| p * (i as f64 - mean).powi(2)).sum();
    if variance <= 0.0 || softness <= 0.0 {
        let (lower, upper) = best_division(cumulated);
        return vec![(1.0, lower, upper)];
    }
    let bounds = || (STEP..256).step_by(STEP);
    let divisions = || bounds().flat_map(|a| (a + STEP..256).step_by(STEP).map(move |b| (a, b)));
    let quality: Vec<f64> =
        divisions().map(|(a, b)| cumulated.two_classes(a, b) + cumulated.gain(b, 256)).collect();
    let best = quality.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weight = |((a, b), quality): ((usize, usize), &f64)| {
        let exponent = (quality - best) / (softness * variance);
        (exponent > -30.0).then(|| (exponent.exp(), a, b))
    };
    divisions().zip(&quality).filter_map(weight).collect()
}

/// Shares and first moments of the values below each bound.
struct Cumulated {
    share: [f64; 257],
    moment: [f64; 257],
}

impl Cumulated {
    fn new(density: &Density) -> Self {
        let (mut share, mut moment) = ([0.0; 257], [0.0; 257]);
        for (i, p) in density.iter().enumerate() {
            share[i + 1] = share[i] + p;
            moment[i + 1] = moment[i] + p * i as f64;
        }
        Self { share, moment }
    }

    /// What the values `from..to` add to the variance between classes if they are one.
    fn gain(&self, from: usize, to: usize) -> f64 {
        let share = self.share[to] - self.share[from];
        if share > 0.0 { (self.moment[to] - self.moment[from]).powi(2) / share } else { 0.0 }
    }

    /// Mean and share of the values `from..to`. An empty class dominates nothing; it sits at its lower bound.
    fn class(&self, from: usize, to: usize) -> (f64, f64) {
        let share = self.share[to] - self.share[from];
        (if share > 0.0 { (self.moment[to] - self.moment[from]) / share } else { from as f64 }, share)
    }

    fn two_classes(&self, lower: usize, upper: usize) -> f64 {
        self.gain(0, lower) + self.gain(lower, upper)
    }

    /// Fills the best lower bound of every upper bound in `uppers`, known to lie in `lowers`.
    fn best_lower(
        &self,
        uppers: std::ops::Range<usize>,
        lowers: std::ops::Range<usize>,
        best: &mut [usize; 257],
    ) {
        if uppers.is_empty() {
            return;
        }
        let middle = (uppers.start + uppers.end) / 2;
        let mut found = (f64::NEG_INFINITY, lowers.start.min(middle - 1));
        for lower in lowers.start..lowers.end.min(middle) {
            let quality = self.two_classes(lower, middle);
            if quality > found.0 {
                found = (quality, lower);
            }
        }
        best[middle] = found.1;
        self.best_lower(uppers.start..middle, lowers.start..found.1 + 1, best);
        self.best_lower(middle + 1..uppers.end, found.1..lowers.end, best);
    }
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// All pairs of bounds, with variances computed from the values themselves.
    fn least_variance_within(density: &Density) -> f64 {
        let variance = |from: usize, to: usize| {
            let share: f64 = density[from..to].iter().sum();
            let mean = (from..to).map(|i| density[i] * i as f64).sum::<f64>() / share.max(1e-300);
            (from..to).map(|i| density[i] * (i as f64 - mean).powi(2)).sum::<f64>()
        };
        let bounds = (1..255).flat_map(|a| (a + 1..256).map(move |b| (a, b)));
        bounds.map(|(a, b)| variance(0, a) + variance(a, b) + variance(b, 256)).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn classes_have_the_least_variance_within() {
        for seed in 0..8 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut density: Density = std::array::from_fn(|_| rng.random::<f64>().powi(6));
            let sum: f64 = density.iter().sum();
            density.iter_mut().for_each(|p| *p /= sum);
            let found = classes(&density);
            let total: f64 = density.iter().enumerate().map(|(i, p)| p * (i as f64).powi(2)).sum();
            let within = total - found.iter().map(|(mean, share)| share * mean * mean).sum::<f64>();
            assert!(abs_diff_eq!(within, least_variance_within(&density), epsilon = 1e-8), "seed {seed}");
        }
    }

    #[test]
    fn peaks_are_apart_where_counts_are_neighbours() {
        let hill = |centre: f64, i: usize| (-0.5 * ((i as f64 - centre) / 6.0).powi(2)).exp();
        let density: Density =
            std::array::from_fn(|i| 3.0 * hill(50.0, i) + 2.0 * hill(120.0, i) + hill(200.0, i));
        let values = |pairs: Vec<(f64, f64)>| pairs.into_iter().map(|pair| pair.0).collect::<Vec<_>>();
        assert_eq!(values(counts(&density)), [50.0, 49.0, 51.0]);
        assert_eq!(values(peaks(&density, 4.0)), [50.0, 120.0, 200.0]);
    }
}
