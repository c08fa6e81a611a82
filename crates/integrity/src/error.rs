/// Why a call was refused. The state is unchanged.
///
/// ```
/// use wayfix_integrity::CusumTest;
/// let mut test = CusumTest::from_false_alarm_rate(1e-3)?;
/// test.observe(2.0)?;
/// let refused = test.observe(f64::NAN).expect_err("not a number");
/// assert_eq!(refused.to_string(), "log-likelihood ratio is NaN, must be a number");
/// assert_eq!(test.sum(), 2.0); // unchanged
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrityError {
    /// A number is outside its range.
    #[error("{what} is {value}, must be {range}")]
    OutOfRange {
        /// The number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The values that it may take.
        range: &'static str,
    },
}

/// `Ok` if `is_within` holds.
pub(crate) fn check(
    what: &'static str,
    value: f64,
    is_within: bool,
    range: &'static str,
) -> Result<(), IntegrityError> {
    if is_within { Ok(()) } else { Err(IntegrityError::OutOfRange { what, value, range }) }
}

pub(crate) fn check_distance(distance: f64) -> Result<(), IntegrityError> {
    check("distance (m)", distance, distance >= 0.0 && distance.is_finite(), "finite and not negative")
}

/// Infinite ratios are legal: one of the two hypotheses excludes the measurement.
pub(crate) fn check_ratio(ratio: f64) -> Result<(), IntegrityError> {
    check("log-likelihood ratio", ratio, !ratio.is_nan(), "a number")
}
