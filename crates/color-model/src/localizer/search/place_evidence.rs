use std::collections::BTreeMap;

use wayfix_estimation_traits::LogWeight;

/// How well a place explains some frames, and which of their tiles say so.
#[derive(Debug, Default)]
pub(crate) struct PlaceEvidence {
    /// Log-likelihood of the frames with the prior of the trajectory, nats.
    pub(crate) log: LogWeight,
    /// What each tile adds to the log-likelihood of its frame, by frame and tile, with the share that the frame counts. A tile that is missing adds nothing.
    gains: BTreeMap<(usize, usize), (f64, LogWeight)>,
}

impl PlaceEvidence {
    /// Without tiles: it counts in full.
    pub(crate) fn new(log: LogWeight) -> Self {
        Self { log, gains: BTreeMap::new() }
    }

    /// Adds the tiles of a frame, which counts this share.
    pub(crate) fn add_tiles(
        &mut self,
        (frame, share): (usize, f64),
        gains: impl IntoIterator<Item = (usize, LogWeight)>,
    ) {
        self.gains.extend(gains.into_iter().map(|(tile, gain)| ((frame, tile), (share, gain))));
    }

    /// The log-odds of this place and another, nats. No likelihood is exact. The more the tiles disagree about two places, the less their ratio counts.
    pub(crate) fn log_odds(&self, other: &Self) -> LogWeight {
        bounded_log_odds(self.log - other.log, self.variance_of_ratio(other))
    }

    /// The variance of the log-likelihood ratio of two places. [Vuong 1989, Eq. 4.2]
    ///
    /// ```math
    /// \hat ω^2 = \sum_t γ_t (d_t - \bar d)^2, \quad d_t = \ln \frac{p_a(z_t)}{p_b(z_t)}
    /// ```
    fn variance_of_ratio(&self, other: &Self) -> f64 {
        let mut ratios = self.gains.clone();
        for (tile, (share, gain)) in &other.gains {
            ratios.entry(*tile).or_insert((*share, 0.0)).1 -= gain;
        }
        let n: f64 = ratios.values().map(|(share, _)| share).sum();
        let mean = ratios.values().map(|(share, ratio)| share * ratio).sum::<f64>() / n;
        ratios.values().map(|(share, ratio)| share * (ratio - mean).powi(2)).sum()
    }
}

/// A bound of the log-odds that a log-likelihood ratio leaves if it has errors of this variance, $`ω^2`$:
/// $`|L| - ω^2 / 2`$ if $`ω^2 ≤ |L|`$, and $`L^2 / 2 ω^2`$ otherwise, with the sign of $`L`$.
///
/// The less probable place is right with the probability $`\operatorname{E} [1 / (1 + e^X)] ≤ \operatorname{E} [e^{-sX}]`$, $`X ∼ N(|L|, ω^2)`$, for any $`0 ≤ s ≤ 1`$; this is the
/// least of these bounds. [Chernoff 1952] Two impossible places are even.
fn bounded_log_odds(log_ratio: LogWeight, variance: f64) -> LogWeight {
    let size = log_ratio.abs();
    let bound = if variance <= size { size - variance / 2.0 } else { size.powi(2) / (2.0 * variance) };
    if bound.is_nan() { 0.0 } else { bound.min(f64::MAX).copysign(log_ratio) }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;

    fn evidence(gains: &[f64]) -> PlaceEvidence {
        let mut evidence = PlaceEvidence::new(gains.iter().sum());
        evidence.add_tiles((0, 1.0), gains.iter().copied().enumerate());
        evidence
    }

    #[test]
    fn one_tile_against_all_others_counts_less() {
        let nothing = PlaceEvidence::default();
        assert_eq!(evidence(&[1.0; 10]).log_odds(&nothing), 10.0);
        let one = evidence(&[10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_abs_diff_eq!(one.log_odds(&nothing), 100.0 / 180.0, epsilon = 1e-12); // 9² + 9 tiles of 1²
        assert_abs_diff_eq!(nothing.log_odds(&one), -100.0 / 180.0, epsilon = 1e-12);
        assert_eq!(one.log_odds(&one), 0.0);
    }

    /// By Monte Carlo: the mean probability that a ratio with errors gives the wrong place. The bound holds, and is not ten times too high.
    #[test]
    fn odds_are_a_bound() {
        use rand::SeedableRng;
        use rand_distr::{Distribution, Normal};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let n = 100_000;
        for (log_ratio, variance) in [(3.0, 0.5), (3.0, 3.0), (3.0, 9.0), (5.0, 10.0)] {
            let ratio = Normal::new(log_ratio, f64::sqrt(variance)).unwrap();
            let wrong =
                (0..n).map(|_| 1.0 / (1.0 + ratio.sample(&mut rng).exp())).sum::<f64>() / f64::from(n);
            let odds: f64 = bounded_log_odds(log_ratio, variance);
            assert!(wrong < (-odds).exp() && wrong > 0.1 * (-odds).exp(), "{wrong} {odds}");
        }
    }

    #[test]
    fn impossible_places_lose_or_are_even() {
        let impossible = PlaceEvidence::new(f64::NEG_INFINITY);
        assert_eq!(impossible.log_odds(&evidence(&[1.0])), -f64::MAX);
        assert_eq!(impossible.log_odds(&impossible), 0.0);
    }
}
