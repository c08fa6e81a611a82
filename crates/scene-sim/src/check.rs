//! The few conditions that parameters have to meet.

use crate::SimulationError;

type Checked = Result<(), SimulationError>;

fn ensure(holds: bool, what: &'static str, value: f64, must: &'static str) -> Checked {
    if holds { Ok(()) } else { Err(SimulationError::Parameter { what, value, must }) }
}

pub(crate) fn finite(what: &'static str, value: f64) -> Checked {
    ensure(value.is_finite(), what, value, "finite")
}

pub(crate) fn positive(what: &'static str, value: f64) -> Checked {
    ensure(value.is_finite() && value > 0.0, what, value, "finite and above 0")
}

pub(crate) fn not_negative(what: &'static str, value: f64) -> Checked {
    ensure(value.is_finite() && value >= 0.0, what, value, "finite and at least 0")
}

pub(crate) fn share(what: &'static str, value: f64) -> Checked {
    ensure((0.0..=1.0).contains(&value), what, value, "in [0, 1]")
}

pub(crate) fn above(what: &'static str, value: f64, low: f64, must: &'static str) -> Checked {
    ensure(value.is_finite() && value > low, what, value, must)
}

pub(crate) fn at_most(what: &'static str, value: f64, high: f64, must: &'static str) -> Checked {
    ensure(value <= high, what, value, must)
}

/// A relative error that leaves the thing itself positive.
pub(crate) fn relative_error(what: &'static str, value: f64) -> Checked {
    ensure(value.is_finite() && value > -1.0, what, value, "finite and above -1")
}

pub(crate) fn period(what: &'static str, milliseconds: u32) -> Checked {
    ensure(milliseconds > 0, what, f64::from(milliseconds), "at least 1")
}

pub(crate) fn count(what: &'static str, got: usize, limit: usize) -> Checked {
    if got <= limit {
        Ok(())
    } else {
        Err(SimulationError::TooMany { what, limit: limit as u64, got: got as u64 })
    }
}
