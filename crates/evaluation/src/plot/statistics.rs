//! Medians and quantiles of figures.

/// The median of the finite values; `None` without any.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    quantile(values, 0.5)
}

/// The value that a share `share` of the finite values does not exceed.
pub fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> Option<f64> {
    let mut finite: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    finite.get(((finite.len() as f64 - 1.0) * share).round() as usize).copied()
}

/// The mean of the last `window` finite values at each finite sample.
pub(super) fn moving_mean(samples: &[(f64, f64)], window: usize) -> Vec<(f64, f64)> {
    let finite: Vec<(f64, f64)> =
        samples.iter().copied().filter(|(t, value)| t.is_finite() && value.is_finite()).collect();
    finite
        .windows(window.max(1))
        .filter_map(|slice| {
            Some((slice.last()?.0, slice.iter().map(|(_, value)| value).sum::<f64>() / slice.len() as f64))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_not_finite_do_not_count() {
        assert_eq!(median([f64::NAN, 3.0, 1.0, f64::INFINITY, 2.0]), Some(2.0));
        assert_eq!(quantile([4.0, 1.0, 3.0, 2.0, 5.0], 1.0), Some(5.0));
        assert_eq!(median([]), None);
        let samples = [(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0), (3.0, 5.0)];
        assert_eq!(moving_mean(&samples, 2), [(2.0, 2.0), (3.0, 4.0)]);
    }
}
