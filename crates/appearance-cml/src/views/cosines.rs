use std::{f64::consts::PI, sync::OnceLock};

/// Orthonormal cosines over the rings, the slowest first (DCT-II).
///
/// An orthonormal change of basis over the rings changes no product of two views. What it changes is where a view's energy is: slow
/// changes from top to bottom hold most of it, so that the first cosines of two views contain most of their difference.
pub(super) struct Cosines {
    rows: Vec<Vec<f64>>,
}

const MOST_RINGS: usize = u8::MAX as usize;

impl Cosines {
    /// Those over `n` rings.
    pub(super) fn over(n: u8) -> &'static Self {
        static ALL: [OnceLock<Cosines>; MOST_RINGS + 1] = [const { OnceLock::new() }; MOST_RINGS + 1];
        ALL[usize::from(n)].get_or_init(|| Self::new(usize::from(n)))
    }

    fn new(n: usize) -> Self {
        let row = |k: usize| {
            let weight = if k == 0 { (1.0 / n as f64).sqrt() } else { (2.0 / n as f64).sqrt() };
            (0..n).map(|ring| weight * (PI * (ring as f64 + 0.5) * k as f64 / n as f64).cos()).collect()
        };
        Self { rows: (0..n).map(row).collect() }
    }

    /// What has a value on each ring, as cosines.
    pub(super) fn transform(&self, values: &[f64]) -> impl Iterator<Item = f64> {
        self.rows.iter().map(move |row| row.iter().zip(values).map(|(x, value)| x * value).sum())
    }
}
