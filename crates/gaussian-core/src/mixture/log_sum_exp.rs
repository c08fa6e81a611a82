use wayfix_estimation_traits::LogWeight;

/// $`\log \sum_i e^{l_i}`$ without overflow; $`-∞`$ for none, NaN when one is NaN.
///
/// ```
/// use wayfix_gaussian_core::log_sum_exp;
/// assert!((log_sum_exp(&[-1000.0, -1000.0]) - (-1000.0 + 2.0_f64.ln())).abs() < 1e-12);
/// assert_eq!(log_sum_exp(&[]), f64::NEG_INFINITY);
/// ```
pub fn log_sum_exp(log_weights: &[LogWeight]) -> LogWeight {
    let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if largest.is_infinite() && !log_weights.iter().any(|l| l.is_nan()) {
        return largest; // all zero, or one beyond all others
    }
    largest + log_weights.iter().map(|l| (l - largest).exp()).sum::<f64>().ln()
}
