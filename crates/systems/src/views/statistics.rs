use super::{ViewSystem, ViewsError};
use wayfix_evaluation::report::Metric;

/// Distinctness of the learned views and similarity of views of one place: [Kasprzak & Szynkiewicz, Tables 1, 2], with our test in place of its
/// unnamed one ([`Appearance::p_value`](wayfix_condensation::AppearanceModel::p_value)).
///
/// # Errors
/// Returns [`ViewsError::Condensation`].
pub fn p_value_metrics(system: &ViewSystem) -> Result<Vec<Metric>, ViewsError> {
    let appearance = system.appearance();
    let between = appearance.p_values_between_states().map_or(f64::NAN, |p| p.mean);
    let same = appearance.p_values_of(system.seen())?;
    let figures = [
        ("p_value_between_states_mean", between),
        ("p_value_same_state_min", same.min),
        ("p_value_same_state_max", same.max),
        ("p_value_same_state_mean", same.mean),
    ];
    Ok(figures.map(|(name, value)| Metric::new(name, value, "")).into())
}
