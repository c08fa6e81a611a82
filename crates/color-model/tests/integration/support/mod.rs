//! Lights for the tests.
pub(crate) mod painted;

use nalgebra::{DMatrix, DVector, Vector3};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};
use wayfix_color_model::{ColorMeans, LightingFilter, LightingFilterParams};
use wayfix_gaussian_core::Gaussian;

pub(crate) fn normal(rng: &mut impl Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Green, white, yellow, sky-blue, pink under a bright light, roughly as a JPEG of the four-legged field has them.
pub(crate) const BRIGHT: [[f64; 3]; 5] = [
    [90.0, 115.0, 100.0],
    [200.0, 128.0, 126.0],
    [160.0, 70.0, 145.0],
    [130.0, 165.0, 95.0],
    [140.0, 120.0, 175.0],
];

pub(crate) fn stacked(colors: &[[f64; 3]]) -> DVector<f64> {
    DVector::from_iterator(3 * colors.len(), colors.iter().flatten().copied())
}

/// Any prior of `n_colors`: standard deviations about 30, everything correlated with everything.
pub(crate) fn random_prior(n_colors: usize, rng: &mut impl Rng) -> Gaussian<DVector<f64>> {
    let n = 3 * n_colors;
    let factor = DMatrix::from_fn(n, n, |_, _| 8.0 * normal(rng));
    let covariance = &factor * factor.transpose() + DMatrix::identity(n, n) * 20.0;
    Gaussian::new(DVector::from_fn(n, |_, _| 128.0 + 40.0 * normal(rng)), covariance)
        .expect("valid by construction")
}

/// A prior whose colours become brighter and more colourful together, by `spread` of the whole (1 standard deviation), and by 5 each alone.
pub(crate) fn common_gain(colors: &[[f64; 3]], spread: f64) -> Gaussian<DVector<f64>> {
    let mean = stacked(colors);
    let grey = DVector::from_fn(mean.len(), |i, _| if i % 3 == 0 { 0.0 } else { 128.0 });
    let direction = (&mean - grey) * spread;
    let covariance = &direction * direction.transpose() + DMatrix::identity(mean.len(), mean.len()) * 25.0;
    Gaussian::new(mean, covariance).expect("valid by construction")
}

pub(crate) fn filter(prior: Gaussian<DVector<f64>>, params: LightingFilterParams) -> LightingFilter {
    LightingFilter::new(prior, params).expect("valid by construction")
}

/// Means of all colours but those whose bit in `hidden` is set.
pub(crate) fn means(state: &DVector<f64>, hidden: u32) -> ColorMeans {
    ColorMeans::new((0..state.len() / 3).map(|color| {
        let seen = hidden & (1 << color) == 0;
        (seen.then(|| state.fixed_rows::<3>(3 * color).into_owned()), 100 * u64::from(seen))
    }))
}

pub(crate) fn noisy(state: &DVector<f64>, variance: &Vector3<f64>, rng: &mut impl Rng) -> DVector<f64> {
    DVector::from_fn(state.len(), |i, _| state[i] + variance[i % 3].sqrt() * normal(rng))
}
