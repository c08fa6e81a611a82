use nalgebra::DefaultAllocator;

use super::{
    LawViolation,
    check::{extent, finite, positive},
    jacobian::agrees,
};
use crate::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};

/// The laws of [`MotionModel`] at each pair of a state and a control.
///
/// Choose states across the wrap and controls of both signs, standing still included.
///
/// # Errors
/// The first law that does not hold.
pub fn motion<M: MotionModel>(
    model: &M,
    states_and_controls: &[(M::State, &M::Control)],
) -> Result<(), LawViolation>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    let states: Vec<M::State> = states_and_controls.iter().map(|(state, _)| state.clone()).collect();
    let size = extent(&states);
    for (index, (state, control)) in states_and_controls.iter().enumerate() {
        let case = || format!("at state and control {index}");
        let propagated = model.propagate(state, control);
        finite("propagate is finite (law 3)", state.local(&propagated).as_slice(), case)?;
        let jacobian = model.jacobian(state, control);
        let propagate = |x: &M::State| model.propagate(x, control);
        agrees("jacobian is the derivative of propagate (law 1)", &jacobian, propagate, state, size, case)?;
        positive("noise is positive semidefinite (law 2)", &model.noise(state, control), false, case)?;
    }
    Ok(())
}

/// The laws of [`SensorModel`] at each state, which the sensor must see.
///
/// # Errors
/// The first law that does not hold.
pub fn sensor<S: SensorModel>(model: &S, states: &[S::State]) -> Result<(), LawViolation>
where
    DefaultAllocator: UpdateAlloc<<S::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
{
    let size = extent(states);
    for (index, state) in states.iter().enumerate() {
        let case = || format!("at state {index}");
        let expected = model.expected(state);
        finite("expected is finite (law 3)", expected.local(&expected).as_slice(), case)?;
        let jacobian = model.jacobian(state);
        let measure = |x: &S::State| model.expected(x);
        agrees("jacobian is the derivative of expected (law 1)", &jacobian, measure, state, size, case)?;
        positive("noise is positive definite (law 2)", &model.noise(state), true, case)?;
    }
    Ok(())
}
