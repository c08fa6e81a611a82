use super::{
    LawViolation,
    check::{rounding, within},
};
use crate::LikelihoodModel;

/// The law of [`LikelihoodModel`]: never NaN, and nowhere above its value at `best`.
///
/// `others` are finite states, impossible ones among them.
///
/// # Errors
/// The first state where it does not hold.
pub fn likelihood<L: LikelihoodModel>(
    model: &L,
    measurement: &L::Measurement,
    best: &L::State,
    others: &[L::State],
) -> Result<(), LawViolation> {
    let log_likelihood = model.log_likelihood(measurement);
    let peak = log_likelihood(best);
    let nan = if peak.is_finite() { 0.0 } else { f64::NAN };
    within("finite where expected", nan, 0.0, || "at the best state".to_owned())?;
    let slack = rounding::<f64>(1.0 + peak.abs());
    for (index, other) in others.iter().enumerate() {
        let excess = log_likelihood(other) - peak;
        within("never NaN, largest where expected", excess, slack, || format!("at state {index}"))?;
    }
    Ok(())
}
