use std::{f64::consts::TAU, sync::OnceLock};

/// The cross-correlation of two views over the angle between them, $`f(φ) = c_0 + \sum_{k≥1} \mathrm{Re}\,(c_k e^{\mathrm i kφ})`$.
pub(super) struct Correlation<'a> {
    /// $`c_0`$.
    pub(super) constant: f64,
    /// $`c_1, c_2, …`$: real and imaginary part.
    pub(super) harmonics: &'a [(f64, f64)],
}

/// More than the half grid of the most harmonics, and a descriptor has no more.
const MOST_HARMONICS: usize = 64;
const LARGEST_GRID: usize = 8 * MOST_HARMONICS;

/// Newton steps from a point of the grid: each squares an error that is a small share of a period to begin with.
const NEWTON_STEPS: usize = 4;

impl Correlation<'_> {
    /// The angle in (−π, π] where it is largest, and the value there.
    ///
    /// Between two points of a grid of step $`h`$ the function rises at most $`\frac{h^2}{8} \max|f''|`$ above them, so every peak of the grid
    /// that is at most so much lower than the best is refined: none is missed.
    pub(super) fn maximum(&self) -> (f64, f64) {
        let n = (8 * self.harmonics.len()).next_power_of_two().clamp(16, LARGEST_GRID);
        let mut values = [0.0; LARGEST_GRID];
        let values = &mut values[..n];
        self.fill(values);
        let step = TAU / n as f64;
        let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let enough = highest - step * step / 8.0 * self.largest_curvature();
        let order = |(angle, value): (f64, f64)| (value, -angle.abs());
        let mut best = (0.0, f64::NEG_INFINITY);
        for (index, &value) in values.iter().enumerate() {
            let is_peak = value >= values[(index + 1) % n] && value >= values[(index + n - 1) % n];
            if value < enough || !is_peak {
                continue;
            }
            let signed = if index > n / 2 { index as f64 - n as f64 } else { index as f64 };
            // The point opposite is both ends of the circle: climbed from as either, so that exchanging two views mirrors what is found there, too.
            let other_end = (2 * index == n).then_some(-signed);
            for start in std::iter::once(signed).chain(other_end) {
                let refined = self.refined(start * step, value, step);
                if order(refined) > order(best) {
                    best = refined;
                }
            }
        }
        best
    }

    /// The values once round; those of opposite angles share their sines and cosines, so that exchanging two views mirrors them to the bit.
    fn fill(&self, values: &mut [f64]) {
        let n = values.len();
        let half = n / 2;
        let grid = Grid::of(n);
        let mut even = [0.0; LARGEST_GRID / 2 + 1];
        let mut odd = [0.0; LARGEST_GRID / 2 + 1];
        let (even, odd) = (&mut even[..=half], &mut odd[..=half]);
        even.fill(self.constant);
        for (k, &(re, im)) in self.harmonics.iter().enumerate() {
            let (cos, sin) = grid.harmonic(k, half + 1);
            for ((even, odd), (cos, sin)) in even.iter_mut().zip(odd.iter_mut()).zip(cos.iter().zip(sin)) {
                *even += re * cos;
                *odd += im * sin;
            }
        }
        for index in 0..=half {
            values[(n - index) % n] = even[index] + odd[index];
            values[index] = even[index] - odd[index];
        }
    }

    fn largest_curvature(&self) -> f64 {
        let of =
            |(k, (re, im)): (usize, &(f64, f64))| ((k + 1) * (k + 1)) as f64 * (re * re + im * im).sqrt();
        self.harmonics.iter().enumerate().map(of).sum()
    }

    /// Climbs from a peak of the grid; never ends lower, nor beyond the neighbours.
    fn refined(&self, start: f64, value: f64, step: f64) -> (f64, f64) {
        let mut best = (start, value);
        let (mut angle, mut derivatives) = (start, self.derivatives(start));
        for _ in 0..NEWTON_STEPS {
            let [_, slope, curvature] = derivatives;
            angle = (angle - slope / curvature).clamp(start - step, start + step);
            derivatives = self.derivatives(angle);
            let [value, ..] = derivatives;
            // Written so that a curvature of 0 ends it, too.
            if !(curvature < 0.0 && value > best.1) {
                break;
            }
            best = (angle, value);
        }
        (wayfix_estimation_traits::wrap_angle(best.0), best.1)
    }

    /// Value, first and second derivative.
    fn derivatives(&self, angle: f64) -> [f64; 3] {
        let (sin, cos) = angle.sin_cos();
        let (mut c, mut s) = (1.0, 0.0);
        let mut sums = [self.constant, 0.0, 0.0];
        for (k, (re, im)) in self.harmonics.iter().enumerate() {
            (c, s) = (c * cos - s * sin, s * cos + c * sin);
            let (k, value) = ((k + 1) as f64, re * c - im * s);
            sums[0] += value;
            sums[1] -= k * (re * s + im * c);
            sums[2] -= k * k * value;
        }
        sums
    }
}

/// $`\cos kφ`$ and $`\sin kφ`$ on half a circle, harmonic by harmonic.
struct Grid {
    half: usize,
    cos: Vec<f64>,
    sin: Vec<f64>,
}

impl Grid {
    /// The tables of a circle of `n` points, a power of two from 16 on.
    fn of(n: usize) -> &'static Self {
        static GRIDS: [OnceLock<Grid>; 6] = [const { OnceLock::new() }; 6];
        GRIDS[n.trailing_zeros() as usize - 4].get_or_init(|| Self::new(n))
    }

    fn new(n: usize) -> Self {
        let half = n / 2 + 1;
        let angles = (1..=n / 8).flat_map(|k| (0..half).map(move |j| TAU * (k * j % n) as f64 / n as f64));
        let (sin, cos) = angles.map(f64::sin_cos).unzip();
        Self { half, cos, sin }
    }

    fn harmonic(&self, k: usize, n: usize) -> (&[f64], &[f64]) {
        let from = k * self.half;
        (&self.cos[from..from + n], &self.sin[from..from + n])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn pseudo_random(seed: u64, n: usize) -> Vec<(f64, f64)> {
        // Weyl sequences of two irrationals: any spread of coefficients will do.
        let value = |i: usize, step: f64| ((seed as f64 + i as f64) * step).fract() - 0.5;
        (0..n).map(|i| (value(i, 0.754_877_666), value(i, 0.569_840_291))).collect()
    }

    #[test]
    fn the_maximum_is_that_of_a_dense_scan() {
        for n in [1, 2, 3, 8, 15, 31, 63] {
            for seed in 0..40 {
                let harmonics = pseudo_random(seed, n);
                let correlation = Correlation { constant: 0.3, harmonics: &harmonics };
                let (angle, value) = correlation.maximum();
                let scan = (0..40_000).map(|i| correlation.derivatives(TAU * f64::from(i) / 40_000.0)[0]);
                let scanned = scan.fold(f64::NEG_INFINITY, f64::max);
                // A scan of that step misses at most (1.6e-4)²/8 · max|f''| ≤ 3.1e-9 · 63³/3 · 0.7 = 2e-4.
                assert!(value >= scanned - 1e-12 && value <= scanned + 2e-4, "{n} {seed}: {value} {scanned}");
                assert_abs_diff_eq!(correlation.derivatives(angle)[0], value, epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn exchanged_views_turn_the_other_way_to_the_bit() {
        for seed in 0..100 {
            let harmonics = pseudo_random(seed, 15);
            let mirrored: Vec<_> = harmonics.iter().map(|(re, im)| (*re, -im)).collect();
            let there = Correlation { constant: 0.0, harmonics: &harmonics }.maximum();
            let back = Correlation { constant: 0.0, harmonics: &mirrored }.maximum();
            assert_eq!((there.0, there.1), (-back.0, back.1));
        }
    }

    #[test]
    fn a_constant_has_its_maximum_anywhere() {
        let harmonics = [(0.0, 0.0); 15];
        assert_eq!(Correlation { constant: 2.0, harmonics: &harmonics }.maximum(), (0.0, 2.0));
    }
}
