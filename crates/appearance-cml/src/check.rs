//! Ranges of parameters, each named when it is broken.

use crate::AppearanceMapError;

pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), AppearanceMapError> {
    within(what, value, value > 0.0 && value.is_finite(), "positive and finite")
}

pub(crate) fn not_negative(what: &'static str, value: f64) -> Result<(), AppearanceMapError> {
    within(what, value, value >= 0.0 && value.is_finite(), "finite and not negative")
}

/// In [0, 1].
pub(crate) fn share(what: &'static str, value: f64) -> Result<(), AppearanceMapError> {
    within(what, value, (0.0..=1.0).contains(&value), "in [0, 1]")
}

pub(crate) fn count(what: &'static str, value: usize) -> Result<(), AppearanceMapError> {
    within(what, value as f64, value > 0, "at least 1")
}

pub(crate) fn within(
    what: &'static str,
    value: f64,
    holds: bool,
    range: &'static str,
) -> Result<(), AppearanceMapError> {
    if holds { Ok(()) } else { Err(AppearanceMapError::Parameter { what, value, range }) }
}
