/// Values along a path smoothed by a Gaussian of `sigma` steps; near the ends a straight line through what is left stands in for the mean, so
/// that ends do not shrink.
pub fn smoothed(values: &[f64], sigma: f64) -> Vec<f64> {
    if sigma <= 0.0 || !sigma.is_finite() {
        return values.to_vec();
    }
    let reach = (3.0 * sigma).ceil() as usize;
    (0..values.len()).map(|index| local_line(values, index, sigma, reach)).collect()
}

/// The value at `index` of the straight line fitted to the neighbours, weighted by nearness.
fn local_line(values: &[f64], index: usize, sigma: f64, reach: usize) -> f64 {
    let (mut w, mut wd, mut wdd, mut wv, mut wdv) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let from = index.saturating_sub(reach);
    for (at, value) in values.iter().enumerate().take((index + reach + 1).min(values.len())).skip(from) {
        let distance = at as f64 - index as f64;
        let weight = (-0.5 * (distance / sigma).powi(2)).exp();
        w += weight;
        wd += weight * distance;
        wdd += weight * distance * distance;
        wv += weight * value;
        wdv += weight * distance * value;
    }
    let determinant = w * wdd - wd * wd;
    if determinant > 1e-9 * w * w { (wdd * wv - wd * wdv) / determinant } else { wv / w }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_stay_and_noise_shrinks() {
        let line: Vec<f64> = (0..30).map(|i| 3.0 + 0.5 * f64::from(i)).collect();
        for (value, smooth) in line.iter().zip(smoothed(&line, 2.0)) {
            assert!((value - smooth).abs() < 1e-9);
        }
        let trembling: Vec<f64> = (0..30).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(smoothed(&trembling, 2.0)[5..25].iter().all(|value| value.abs() < 0.05));
        assert_eq!(smoothed(&trembling, 0.0), trembling);
        assert_eq!(smoothed(&[4.0], 2.0), [4.0]);
        assert!(smoothed(&[], 2.0).is_empty());
    }
}
