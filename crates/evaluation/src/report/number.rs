/// Formats `value` with about four significant digits; large and small values with an exponent, non-finite values as a dash.
pub(super) fn significant(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        "—".to_owned()
    } else if value.fract() == 0.0 && size < 1e9 {
        format!("{value:.0}")
    } else if (1e-3..1e5).contains(&size) {
        // The exponent after rounding, so that 9.99996 has no extra digit.
        let exponent: i32 = format!("{size:.3e}")
            .split_once('e')
            .and_then(|(_, exponent)| exponent.parse().ok())
            .unwrap_or(0);
        let decimals = (3 - exponent).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.3e}")
    }
}

/// The same for an optional value; empty for `None`.
pub(super) fn significant_or_empty(value: Option<f64>) -> String {
    value.map_or_else(String::new, significant)
}

/// A duration in words: `850 ms`, `12.3 s`, `4 min 05 s`.
pub(super) fn duration(seconds: f64) -> String {
    if !seconds.is_finite() || seconds < 0.0 {
        "—".to_owned()
    } else if seconds < 1.0 {
        format!("{:.0} ms", seconds * 1e3)
    } else if seconds < 60.0 {
        format!("{seconds:.1} s")
    } else {
        let whole = seconds.round();
        format!("{:.0} min {:02.0} s", (whole / 60.0).floor(), whole % 60.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_and_no_more() {
        let cases = [
            (0.120_94, "0.1209"),
            (9.999_96, "10.00"),
            (1234.56, "1235"),
            (-3.25, "-3.250"),
            (15.0, "15"),
            (0.0, "0"),
            (1.5e-7, "1.500e-7"),
            (2.5e9, "2.500e9"),
            (f64::NAN, "—"),
        ];
        for (value, text) in cases {
            assert_eq!(significant(value), text);
        }
        assert_eq!([duration(0.25), duration(12.34), duration(245.0)], ["250 ms", "12.3 s", "4 min 05 s"]);
    }
}
