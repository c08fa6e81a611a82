//! Gates between a form and its filter.

use nalgebra::{DefaultAllocator, Dim};
use wayfix_estimation_traits::{Manifold, SensorModel, StateAlloc, UpdateAlloc};

use crate::{Form, Update, error::Checked};

/// stub
#[derive(Clone, Copy, Debug)]
pub struct ChiSquaredGate(f64);
impl ChiSquaredGate {
    /// stub
    pub fn new(_p: f64) -> Checked<Self> {
        Ok(Self(9.0))
    }
}

/// The largest normalized innovation squared that passes for a measurement of dimension `dim`.
pub(crate) fn threshold(gate: &ChiSquaredGate, _dim: usize) -> Checked<f64> {
    Ok(gate.0)
}

/// Updates `belief` when there is a measurement and the gate lets it in.
#[allow(clippy::type_complexity, reason = "the outcome for the caller and the belief for the filter")]
pub(crate) fn gated<X, F, S>(
    form: &F,
    belief: &F::Belief,
    sensor: &S,
    measurement: Option<&S::Measurement>,
    gate: &ChiSquaredGate,
) -> Checked<(Update<X, S::Measurement>, Option<F::Belief>)>
where
    X: Manifold,
    F: Form<X>,
    S: SensorModel<State = X>,
    DefaultAllocator: StateAlloc<X::Dim> + UpdateAlloc<X::Dim, <S::Measurement as Manifold>::Dim>,
{
    let Some(measurement) = measurement else { return Ok((Update::Missing, None)) };
    let threshold = threshold(gate, measurement.dim().value())?;
    let (innovation, posterior) =
        form.update(belief, sensor, measurement, |innovation| innovation.nis() <= threshold)?;
    let outcome = match posterior {
        Some(_) => Update::Accepted { innovation },
        None => Update::Rejected { innovation, threshold },
    };
    Ok((outcome, posterior))
}
