use crate::NormalizedWeights;

/// For each of the ascending `points` in (0, 1] the first index whose cumulative weight reaches it.
///
/// The textbook merge of two sorted lists, and the reference for `spread`.
pub(super) fn walk(weights: &NormalizedWeights, points: impl Iterator<Item = f64>, ancestors: &mut [usize]) {
    let shares = weights.as_slice();
    let last = weights.last_positive();
    let (mut index, mut cumulative) = (0, shares[0]);
    for (ancestor, point) in ancestors.iter_mut().zip(points) {
        while cumulative < point && index < last {
            index += 1;
            cumulative += shares[index];
        }
        *ancestor = index;
    }
}

/// A uniform number in (0, 1]: a point at 0 would belong to the first particle even if that has no weight.
pub(super) fn open_closed<R: rand::Rng + ?Sized>(rng: &mut R) -> f64 {
    use rand::RngExt as _;
    1.0 - rng.random::<f64>()
}
