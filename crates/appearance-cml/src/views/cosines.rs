use std::{f64::consts::PI, sync::OnceLock};

/// Orthonormal cosines over the rings, the slowest first (DCT-II).
pub(super) struct Cosines {
    rows: Vec<Vec<f64>>,
}

/// As many as are ever asked for.
pub(super) const MOST_COSINES: usize = 8;
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
        Self { rows: (0..n.min(MOST_COSINES)).map(row).collect() }
    }

    /// The first coefficients of what a harmonic is over the rings, and the energy of all others.
    pub(super) fn transform(&self, values: &[i8], n_coefficients: usize, scale: f64) -> (Vec<f64>, f64) {
        let of = |row: &Vec<f64>| scale * row.iter().zip(values).map(|(x, q)| x * f64::from(*q)).sum::<f64>();
        let coefficients: Vec<f64> = self.rows.iter().take(n_coefficients).map(of).collect();
        let energy: f64 = values.iter().map(|q| (scale * f64::from(*q)).powi(2)).sum();
        let rest = energy - coefficients.iter().map(|x| x * x).sum::<f64>();
        (coefficients, rest.max(0.0))
    }
}
