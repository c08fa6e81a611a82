use crate::NormalizedWeights;

/// How many children are written without asking whether there are so many. Most particles have fewer, and a wrong guess of the processor
/// about a branch costs more than these writes.
const WRITTEN_BLINDLY: usize = 4;

/// Fills `ancestors` particle by particle: `points_up_to(n C)` says how many of the `n` points lie up to the cumulative weight $`C`$; it never
/// falls as $`C`$ grows.
///
/// The same answer as `walk`, which goes point by point, without its unpredictable branches.
pub(super) fn spread(
    weights: &NormalizedWeights,
    points_up_to: impl Fn(f64) -> usize,
    ancestors: &mut [usize],
) {
    let n = ancestors.len() as f64;
    let mut cumulative = 0.0;
    let ends = weights.as_slice().iter().map(|share| {
        cumulative += share;
        points_up_to(cumulative * n)
    });
    // The weights add up to one but for rounding, which may leave the last points out.
    let filled = expand(ends, ancestors);
    ancestors[filled..].fill(weights.last_positive());
}

/// Writes each index up to where its children end; ends do not fall. Where the last one is.
pub(super) fn expand(ends: impl Iterator<Item = usize>, ancestors: &mut [usize]) -> usize {
    let mut filled = 0;
    for (index, end) in ends.enumerate() {
        let end = end.min(ancestors.len());
        match ancestors.get_mut(filled..filled + WRITTEN_BLINDLY) {
            Some(few) if end - filled <= WRITTEN_BLINDLY => few.fill(index),
            _ => ancestors[filled..end].fill(index),
        }
        filled = end;
    }
    filled
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::super::walk::walk;
    use crate::{NormalizedWeights, Resampler, StratifiedResampler, SystematicResampler};

    /// Weights from equal to almost all on one, more and fewer of them than points.
    fn cases(rng: &mut ChaCha8Rng) -> Vec<(NormalizedWeights, usize)> {
        let mut cases = vec![];
        for (n_weights, n) in [(1, 1), (1, 9), (9, 1), (7, 7), (1000, 1000), (1000, 37), (50, 4000), (3, 0)] {
            for power in [0, 1, 8, 40] {
                let raw = (0..n_weights).map(|_| rng.random::<f64>().powi(power)).collect();
                cases.push((NormalizedWeights::from_linear(raw).unwrap(), n));
            }
        }
        cases
    }

    #[test]
    fn systematic_and_stratified_agree_with_the_walk() {
        let mut rng = ChaCha8Rng::seed_from_u64(20_261_121);
        for (weights, n) in cases(&mut rng) {
            let mut walked = vec![0; n];
            let mut twin = rng.clone();
            let fast = SystematicResampler.ancestors(&weights, n, &mut rng).unwrap();
            let offset: f64 = twin.random();
            walk(&weights, (0..n).map(|i| (i as f64 + 1.0 - offset) / n as f64), &mut walked);
            assert_eq!(fast, walked, "systematic, {n} by {weights:?}");

            let mut twin = rng.clone();
            let fast = StratifiedResampler.ancestors(&weights, n, &mut rng).unwrap();
            let points = (0..n).map(|i| (i as f64 + 1.0 - twin.random::<f64>()) / n as f64);
            walk(&weights, points, &mut walked);
            assert_eq!(fast, walked, "stratified, {n} by {weights:?}");
        }
    }
}
