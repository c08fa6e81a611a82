//! Gates between a form and its filter.

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::ChiSquaredGate;

use crate::{Form, Update, error::Checked};

/// Updates `belief` if there is a measurement and the gate accepts it.
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
    let (innovation, posterior) =
        form.update(belief, sensor, measurement, |innovation| gate.accepts(innovation.nis()))?;
    let outcome = match posterior {
        Some(_) => Update::Accepted { innovation },
        None => Update::Rejected { innovation, threshold: gate.threshold() },
    };
    Ok((outcome, posterior))
}
