//! A model at one point, checked.

use nalgebra::{DefaultAllocator, Dim, OMatrix};
use wayfix_estimation_traits::{
    Manifold, MotionModel, SensorModel, StateAlloc, Tangent, TangentMatrix, UpdateAlloc,
};

use crate::{check, error::Checked};

/// A motion at one state and control: $`f(x, u)`$, $`F`$, $`Q`$.
pub(crate) struct LinearizedMotion<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    pub(crate) mean: X,
    pub(crate) jacobian: TangentMatrix<X>,
    pub(crate) noise: TangentMatrix<X>,
    /// $`L`$ with $`L L^T = Q`$.
    pub(crate) noise_factor: TangentMatrix<X>,
}

pub(crate) fn linearize_motion<M: MotionModel>(
    motion: &M,
    state: &M::State,
    control: &M::Control,
) -> Checked<LinearizedMotion<M::State>>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    let n = state.dim().value();
    let mean = motion.propagate(state, control);
    check::difference("predicted mean", state, &mean)?;
    let jacobian = motion.jacobian(state, control);
    check::shape("transition Jacobian", (n, n), jacobian.shape())?;
    check::finite("transition Jacobian", &jacobian)?;
    let noise = motion.noise(state, control);
    let noise_factor = check::motion_noise(&noise, n)?;
    Ok(LinearizedMotion { mean, jacobian, noise, noise_factor })
}

/// A sensor at one state and measurement: $`z ⊟ h(x)`$, $`H`$, $`R`$.
pub(crate) struct LinearizedSensor<X: Manifold, Z: Manifold<Scalar = X::Scalar>>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    pub(crate) residual: Tangent<Z>,
    pub(crate) jacobian: OMatrix<X::Scalar, Z::Dim, X::Dim>,
    pub(crate) noise: TangentMatrix<Z>,
}

pub(crate) fn linearize_sensor<S: SensorModel>(
    sensor: &S,
    state: &S::State,
    measurement: &S::Measurement,
) -> Checked<LinearizedSensor<S::State, S::Measurement>>
where
    DefaultAllocator: UpdateAlloc<<S::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
{
    let (n, m) = (state.dim().value(), measurement.dim().value());
    let expected = sensor.expected(state);
    let residual = check::difference("measurement", &expected, measurement)?;
    let jacobian = sensor.jacobian(state);
    check::shape("sensor Jacobian", (m, n), jacobian.shape())?;
    check::finite("sensor Jacobian", &jacobian)?;
    let mut noise = sensor.noise(state);
    check::sensor_noise(&noise, m)?;
    // The form of Joseph needs exact symmetry; only this triangle was checked.
    noise.fill_upper_triangle_with_lower_triangle();
    Ok(LinearizedSensor { residual, jacobian, noise })
}
