use wayfix_evaluation::plot::statistics::median;

/// Smooths values along a path by a Gaussian of `sigma` steps. A local straight line avoids shrinkage at the ends.
pub fn smoothed(values: &[f64], sigma: f64) -> Vec<f64> {
    if sigma <= 0.0 || !sigma.is_finite() {
        return values.to_vec();
    }
    let reach = (3.0 * sigma).ceil() as usize;
    (0..values.len()).map(|index| local_line(values, index, sigma, reach)).collect()
}

/// The value at `index` of a straight line fitted to the neighbours, weighted by nearness.
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

/// The smoothing, in frames, that reduces the noise of path headings to about 1°, estimated from the noise of the steps.
///
/// The noise σ of positions comes from the median second difference, which excludes curves. A straight line through
/// $`n`$ frames of step $`s`$ has a heading wrong by about $`σ / (s n^{3/2})`$.
pub fn smoothing_of(x: &[f64], y: &[f64]) -> f64 {
    let steps = x.windows(2).zip(y.windows(2)).map(|(x, y)| (x[1] - x[0]).hypot(y[1] - y[0]));
    let bend = |values: &[f64]| values[0] - 2.0 * values[1] + values[2];
    let bends = x.windows(3).zip(y.windows(3)).map(|(x, y)| bend(x).hypot(bend(y)));
    // A second difference of white noise has 6 times its variance; the median length in two dimensions is 1.18 σ.
    let trembling = median(bends).unwrap_or(f64::NAN) / (1.18 * 6_f64.sqrt());
    let ratio = trembling / (HEADING_SIGMA * median(steps).unwrap_or(f64::NAN));
    if ratio.is_finite() {
        ratio.powf(2.0 / 3.0).clamp(LEAST_SMOOTHING, MOST_SMOOTHING)
    } else {
        LEAST_SMOOTHING
    }
}

/// rad.
const HEADING_SIGMA: f64 = 0.02;
/// Frames.
const LEAST_SMOOTHING: f64 = 0.5;
/// Frames.
const MOST_SMOOTHING: f64 = 8.0;

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn straight_lines_stay_and_noise_shrinks() {
        let line: Vec<f64> = (0..30).map(|i| 3.0 + 0.5 * f64::from(i)).collect();
        for (value, smooth) in line.iter().zip(smoothed(&line, 2.0)) {
            assert_abs_diff_eq!(*value, smooth, epsilon = 1e-9);
        }
        let trembling: Vec<f64> = (0..30).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(smoothed(&trembling, 2.0)[5..25].iter().all(|value| value.abs() < 0.05));
        assert_eq!(smoothed(&trembling, 0.0), trembling);
        assert_eq!(smoothed(&[4.0], 2.0), [4.0]);
        assert!(smoothed(&[], 2.0).is_empty());
    }

    #[test]
    fn a_path_that_trembles_is_smoothed_more() {
        let angle = |i: i32| 0.02 * f64::from(i);
        let arc = |tremble: f64| -> (Vec<f64>, Vec<f64>) {
            let sign = |i: i32| if (i / 2) % 2 == 0 { tremble } else { -tremble };
            (0..200).map(|i| (angle(i).cos() + sign(i), angle(i).sin() - sign(i + 1))).unzip()
        };
        let smoothing = [0.0, 0.002, 0.01].map(|tremble| {
            let (x, y) = arc(tremble);
            smoothing_of(&x, &y)
        });
        // The arc itself bends by 0.0004 per step of 0.02, a seventh of the bend that would need a frame of smoothing.
        assert!(
            smoothing[0] <= 0.6 && smoothing[0] < smoothing[1] && smoothing[1] < smoothing[2],
            "{smoothing:?}"
        );
        assert_eq!(smoothing_of(&[], &[]), 0.5);
        assert_eq!(smoothing_of(&[1.0; 9], &[1.0; 9]), 0.5);
    }
}
