use super::{Violation, check::within};
use crate::BayesFilter;

/// What [`filter`](fn@filter) does with a filter.
pub struct FilterTrial<'a, F: BayesFilter, E: Fn(&F::Estimate) -> f64> {
    /// Measurements of one true state, enough to pin it down from where the filter starts, which is not there.
    pub measurements: &'a [&'a F::Measurement],
    /// How far an estimate is from the truth.
    pub error: E,
    /// How far it may be in the end, at most half of where it starts.
    pub bound: f64,
    /// Measurements that the filter must refuse: NaN, a wrong dimension.
    pub refused_measurements: &'a [&'a F::Measurement],
    /// Controls that the filter must refuse.
    pub refused_controls: &'a [&'a F::Control],
}

/// The laws of [`BayesFilter`]: refusals leave no trace, the same calls give the same estimate, and the estimate moves to the truth.
///
/// # Errors
/// The first law that does not hold.
pub fn filter<F, E>(filter: &F, trial: &FilterTrial<'_, F, E>) -> Result<(), Violation>
where
    F: BayesFilter + Clone,
    F::Estimate: PartialEq,
    E: Fn(&F::Estimate) -> f64,
{
    refuses(filter, trial)?;
    let start = (trial.error)(&filter.estimate());
    let (mut first, mut second) = (filter.clone(), filter.clone());
    for (index, measurement) in trial.measurements.iter().enumerate() {
        let accepted = first.update(measurement).is_ok() && second.update(measurement).is_ok();
        holds("a good measurement is taken", accepted, || format!("measurement {index}"))?;
    }
    let same = first.estimate() == second.estimate();
    holds("the same calls give the same estimate (law 2)", same, || "after all measurements".to_owned())?;
    let bound = trial.bound.min(0.5 * start);
    let end = (trial.error)(&first.estimate());
    within("the estimate moves to the truth (law 3)", end, bound, || format!("it started {start:e} away"))?;
    refuses(&first, trial)
}

fn refuses<F, E>(filter: &F, trial: &FilterTrial<'_, F, E>) -> Result<(), Violation>
where
    F: BayesFilter + Clone,
    F::Estimate: PartialEq,
    E: Fn(&F::Estimate) -> f64,
{
    let before = filter.estimate();
    let untouched = |after: &F, refused: bool, case: String| {
        holds("bad input is refused", refused, || case.clone())?;
        holds("after an Err the filter is as it was (law 1)", after.estimate() == before, || case)
    };
    for (index, measurement) in trial.refused_measurements.iter().enumerate() {
        let mut after = filter.clone();
        let refused = after.update(measurement).is_err();
        untouched(&after, refused, format!("refused measurement {index}"))?;
    }
    for (index, control) in trial.refused_controls.iter().enumerate() {
        let mut after = filter.clone();
        let refused = after.predict(control).is_err();
        untouched(&after, refused, format!("refused control {index}"))?;
    }
    Ok(())
}

fn holds(law: &'static str, condition: bool, case: impl FnOnce() -> String) -> Result<(), Violation> {
    within(law, if condition { 0.0 } else { 1.0 }, 0.0, case)
}
