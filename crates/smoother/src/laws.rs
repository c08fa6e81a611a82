//! The law suite of [`Residual`]: run it on a residual of your own.

use wayfix_estimation_traits::laws::within;

pub use wayfix_estimation_traits::laws::LawViolation;

use crate::{Refs, Residual, VariableTuple};

/// The laws of [`Residual`] at some values of its variables.
///
/// Call it at several: small and large residuals, angles of both signs and across the wrap.
///
/// # Errors
/// The first law that does not hold, with numbers.
pub fn residual<R: Residual>(residual: &R, variables: Refs<'_, R>) -> Result<(), LawViolation> {
    let value = residual.value(variables);
    let jacobians = residual.jacobians(variables);
    let numerical = R::Variables::differentiate(residual, variables);
    let rows = R::Variables::value_rows(&value);
    finite("the value is finite (law 1)", rows, String::new)?;
    let claimed = R::Variables::jacobian_entries(&jacobians);
    let expected = R::Variables::jacobian_entries(&numerical);
    for (place, (claimed, expected)) in claimed.iter().zip(&expected).enumerate() {
        let case = || format!("for variable {place}");
        finite("Jacobians are finite (law 1)", claimed.0, case)?;
        let shape_fits = (claimed.1, claimed.2) == (expected.1, expected.2) && claimed.1 == rows.len();
        within(
            "Jacobians have a row for each row of the value (law 2, 3)",
            if shape_fits { 0.0 } else { f64::INFINITY },
            0.0,
            case,
        )?;
        let largest = expected.0.iter().chain(rows).fold(1.0_f64, |max, entry| max.max(entry.abs()));
        let difference = claimed.0.iter().zip(expected.0).fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
        // A central difference errs by about ε^(2/3) of the largest number; its third derivatives may be some hundred times larger.
        let tolerance = 1e3 * f64::EPSILON.powf(2.0 / 3.0) * largest;
        within("Jacobians are the derivatives of the value (law 2)", difference, tolerance, case)?;
    }
    Ok(())
}

fn finite(law: &'static str, entries: &[f64], case: impl FnOnce() -> String) -> Result<(), LawViolation> {
    let is_finite = entries.iter().all(|entry| entry.is_finite());
    within(law, if is_finite { 0.0 } else { f64::NAN }, 0.0, case)
}
