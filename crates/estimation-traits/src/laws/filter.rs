use super::{LawViolation, check::within};

/// A call to a filter with its arguments; whether the filter accepted it.
pub type FilterLawCall<'a, F> = &'a dyn Fn(&mut F) -> bool;

/// What [`filter`](fn@filter) does with a filter of type `F` whose estimates have type `E`.
pub struct FilterLawTrial<'a, F, E> {
    /// The estimate of the filter.
    pub estimate: &'a dyn Fn(&F) -> E,
    /// Distance of an estimate from the true state, in any unit.
    pub error: &'a dyn Fn(&E) -> f64,
    /// Largest error after [`accepted`](Self::accepted), in the same unit. The suite lowers it to half of the first error.
    pub bound: f64,
    /// Calls that the filter must accept, in this order. Together they determine the true state.
    pub accepted: &'a [FilterLawCall<'a, F>],
    /// Calls that the filter must refuse: NaN, a wrong dimension.
    pub refused: &'a [FilterLawCall<'a, F>],
}

/// The laws of a recursive filter.
///
/// 1. After an `Err` the filter is exactly as it was before the call.
/// 2. The same calls give the same bits.
/// 3. Measurements that determine the state move the estimate to it. (A published filter computes its gain and never applies it.)
///
/// ```
/// use wayfix_estimation_traits::laws;
///
/// /// Mean and variance of a scalar.
/// type Filter = (f64, f64);
/// fn update((mean, variance): &mut Filter, measurement: f64) -> bool {
///     if measurement.is_finite() {
///         let gain = *variance / (*variance + 0.01);
///         *mean += gain * (measurement - *mean);
///         *variance *= 1.0 - gain;
///     }
///     measurement.is_finite()
/// }
/// let trial = laws::FilterLawTrial {
///     estimate: &|filter: &Filter| *filter,
///     error: &|estimate: &Filter| (estimate.0 - 5.0).abs(),
///     bound: 0.1,
///     accepted: &[&|filter| update(filter, 5.0)],
///     refused: &[&|filter| update(filter, f64::NAN)],
/// };
/// laws::filter(&(0.0, 1.0), &trial)?;
/// # Ok::<(), laws::LawViolation>(())
/// ```
///
/// # Errors
/// The first law that does not hold.
pub fn filter<F: Clone, E: PartialEq>(
    filter: &F,
    trial: &FilterLawTrial<'_, F, E>,
) -> Result<(), LawViolation> {
    refuses(filter, trial)?;
    let start = (trial.error)(&(trial.estimate)(filter));
    let (mut first, mut second) = (filter.clone(), filter.clone());
    for (index, call) in trial.accepted.iter().enumerate() {
        let accepted = call(&mut first) && call(&mut second);
        holds("a valid call is accepted", accepted, || format!("call {index}"))?;
    }
    let estimate = (trial.estimate)(&first);
    let same = estimate == (trial.estimate)(&second);
    holds("the same calls give the same estimate (law 2)", same, || "after all calls".to_owned())?;
    let bound = trial.bound.min(0.5 * start);
    let end = (trial.error)(&estimate);
    within("the estimate moves to the truth (law 3)", end, bound, || {
        format!("the first error is {start:e}")
    })?;
    refuses(&first, trial)
}

fn refuses<F: Clone, E: PartialEq>(filter: &F, trial: &FilterLawTrial<'_, F, E>) -> Result<(), LawViolation> {
    let before = (trial.estimate)(filter);
    for (index, call) in trial.refused.iter().enumerate() {
        let mut after = filter.clone();
        let case = || format!("refused call {index}");
        holds("an invalid call is refused", !call(&mut after), case)?;
        let same = (trial.estimate)(&after) == before;
        holds("after an Err the filter is as it was (law 1)", same, case)?;
    }
    Ok(())
}

fn holds(law: &'static str, condition: bool, case: impl FnOnce() -> String) -> Result<(), LawViolation> {
    within(law, if condition { 0.0 } else { 1.0 }, 0.0, case)
}
