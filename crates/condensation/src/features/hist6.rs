use crate::features::histogram::{self, Histogram};
use crate::{CondensationError, FeatureTable, Picture, View, ViewFeature, ViewGrid};

/// Three dominating intensities and their densities: $`[I_1, I_2, I_3, ρ(I_1), ρ(I_2), ρ(I_3)]`$. [Kasprzak & Szynkiewicz, Sec. 3.3]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hist6 {
    /// What makes an intensity dominate.
    pub dominance: Dominance,
}

/// What makes an intensity dominate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Dominance {
    /// raw
    Counts,
    /// peaks
    Peaks {
        /// sigma
        sigma: f64,
        /// order by intensity
        by_intensity: bool,
    },
    /// classes
    #[default]
    Classes,
}

impl ViewFeature for Hist6 {
    fn n_components(&self) -> usize {
        6
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        self.describe(&histogram::of_view(view), features);
    }

    fn extract_all(&self, scene: &Picture, views: &ViewGrid) -> Result<FeatureTable, CondensationError> {
        views.check(scene)?;
        let mut table = FeatureTable::zeros(views.grid(), 6);
        histogram::for_each_view(scene, views, |state, h| self.describe(h, table.row_mut(state)));
        Ok(table)
    }
}

impl Hist6 {
    fn describe(&self, histogram: &Histogram, features: &mut [f64]) {
        let n: u32 = histogram.iter().sum();
        let density: Vec<f64> = histogram.iter().map(|&c| f64::from(c) / f64::from(n)).collect();
        let mut pairs: Vec<(f64, f64)> = match self.dominance {
            Dominance::Counts => {
                let mut order: Vec<usize> = (0..256).collect();
                order.sort_by(|&a, &b| density[b].total_cmp(&density[a]).then(a.cmp(&b)));
                order.iter().take(3).map(|&i| (i as f64, density[i])).collect()
            }
            Dominance::Peaks { sigma, .. } => peaks(&density, sigma),
            Dominance::Classes => classes(&density),
        };
        if matches!(self.dominance, Dominance::Peaks { by_intensity: true, .. }) {
            pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        while pairs.len() < 3 {
            let last = *pairs.last().unwrap_or(&(0.0, 0.0));
            pairs.push((last.0, 0.0));
        }
        for (k, (i, r)) in pairs.into_iter().take(3).enumerate() {
            features[k] = i;
            features[k + 3] = r;
        }
    }
}

fn peaks(density: &[f64], sigma: f64) -> Vec<(f64, f64)> {
    let r = (3.0 * sigma).ceil() as isize;
    let sm: Vec<f64> = (0..256_isize)
        .map(|i| {
            (-r..=r)
                .filter(|d| (0..256).contains(&(i + d)))
                .map(|d| density[(i + d) as usize] * (-0.5 * (d as f64 / sigma).powi(2)).exp())
                .sum::<f64>()
                / (sigma * (std::f64::consts::TAU).sqrt())
        })
        .collect();
    let mut maxima: Vec<(f64, f64)> = (0..256)
        .filter(|&i| (i == 0 || sm[i] > sm[i - 1]) && (i == 255 || sm[i] >= sm[i + 1]))
        .map(|i| (i as f64, sm[i]))
        .collect();
    maxima.sort_by(|a, b| b.1.total_cmp(&a.1));
    maxima.truncate(3);
    maxima
}

fn classes(density: &[f64]) -> Vec<(f64, f64)> {
    let mut w = [0.0; 257];
    let mut m = [0.0; 257];
    for i in 0..256 {
        w[i + 1] = w[i] + density[i];
        m[i + 1] = m[i] + density[i] * i as f64;
    }
    let score = |a: usize, b: usize| {
        let ww: f64 = w[b] - w[a];
        if ww > 0.0 { (m[b] - m[a]).powi(2) / ww } else { 0.0 }
    };
    // best a for every b: monotone in b (Monge), so divide and conquer
    let mut arg = [0_usize; 256];
    fn solve(
        lo: usize,
        hi: usize,
        alo: usize,
        ahi: usize,
        score: &impl Fn(usize, usize) -> f64,
        arg: &mut [usize; 256],
    ) {
        if lo >= hi {
            return;
        }
        let mid = (lo + hi) / 2;
        let mut best = (f64::NEG_INFINITY, alo);
        for a in alo.max(1)..=ahi.min(mid - 1) {
            let s = score(0, a) + score(a, mid);
            if s > best.0 {
                best = (s, a);
            }
        }
        arg[mid] = best.1;
        solve(lo, mid, alo, best.1, score, arg);
        solve(mid + 1, hi, best.1, ahi, score, arg);
    }
    solve(2, 256, 1, 254, &score, &mut arg);
    let mut best = (f64::NEG_INFINITY, 0, 0);
    for b in 2..256 {
        let a = arg[b];
        let s = score(0, a) + score(a, b) + score(b, 256);
        if s > best.0 {
            best = (s, a, b);
        }
    }
    let (_, a, b) = best;
    [(0, a), (a, b), (b, 256)]
        .into_iter()
        .map(|(a, b)| {
            let ww = w[b] - w[a];
            (if ww > 0.0 { (m[b] - m[a]) / ww } else { a as f64 }, ww)
        })
        .collect()
}
