use nalgebra::{Const, DefaultAllocator, Dim, OMatrix, OVector, RealField};
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, Tangent, UpdateAlloc};
use wayfix_gaussian_core::{Gaussian, cholesky};

use crate::{
    ExtendedKalmanAlgorithm, Innovation, KalmanAlgorithm,
    algebra::transport::gaussian_at,
    check,
    error::Checked,
    linearize::{LinearizedSensor, linearize_sensor},
};

/// The extended filter that uses a measurement one scalar at a time.
///
/// $`R = L L^T`$ decorrelates: the rows of $`L^{-1} H`$ and $`L^{-1} y`$ have independent unit noise, so each is an update of its own,
/// $`O(m n^2)`$ together and without a gain for the whole. All rows belong to one linearization, hence the same result as
/// [`ExtendedKalmanAlgorithm`]. Each scalar step is the stabilized one of [Bierman 1977, §V.2]: the form of Joseph for a rank-one gain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SequentialUpdateAlgorithm;

impl<X: Manifold> KalmanAlgorithm<X> for SequentialUpdateAlgorithm
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    type Belief = Gaussian<X>;

    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<Gaussian<X>> {
        ExtendedKalmanAlgorithm.belief_from(gaussian)
    }

    fn predict<M>(&self, belief: &Gaussian<X>, motion: &M, control: &M::Control) -> Checked<Gaussian<X>>
    where
        M: MotionModel<State = X>,
    {
        ExtendedKalmanAlgorithm.predict(belief, motion, control)
    }

    fn update<S>(
        &self,
        belief: &Gaussian<X>,
        sensor: &S,
        measurement: &S::Measurement,
        admits: impl FnOnce(&Innovation<X, S::Measurement>) -> bool,
    ) -> Checked<(Innovation<X, S::Measurement>, Option<Gaussian<X>>)>
    where
        S: SensorModel<State = X>,
        DefaultAllocator: UpdateAlloc<X::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let linear = linearize_sensor(sensor, belief.mean(), measurement)?;
        let innovation = Innovation::of_linearized(
            linear.residual.clone(),
            belief.covariance(),
            &linear.jacobian,
            &linear.noise,
        )?;
        if !admits(&innovation) {
            return Ok((innovation, None));
        }
        let (residual, jacobian) = decorrelated(&linear)?;
        let mut covariance = belief.covariance().clone();
        let mut offset = Tangent::<X>::zeros_generic(belief.dim(), Const::<1>);
        for i in 0..residual.nrows() {
            let row = jacobian.row(i).transpose();
            let remaining = residual[i] - row.dot(&offset);
            let gain = scalar_update(&mut covariance, &row);
            offset.axpy(remaining, &gain, nalgebra::one());
        }
        let mean = check::moved("posterior mean", belief.mean(), &offset)?;
        Ok((innovation, Some(gaussian_at("posterior", mean, belief.mean(), covariance)?)))
    }
}

/// $`L^{-1} y`$ and $`L^{-1} H`$: residual and Jacobian whose noise is the identity.
#[allow(clippy::type_complexity, reason = "a residual and its Jacobian")]
fn decorrelated<X: Manifold, Z: Manifold<Scalar = X::Scalar>>(
    linear: &LinearizedSensor<X, Z>,
) -> Checked<(Tangent<Z>, OMatrix<X::Scalar, Z::Dim, X::Dim>)>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    let factor = cholesky("sensor noise", &linear.noise)?;
    let (mut residual, mut jacobian) = (linear.residual.clone(), linear.jacobian.clone());
    factor.l_dirty().solve_lower_triangular_mut(&mut residual);
    factor.l_dirty().solve_lower_triangular_mut(&mut jacobian);
    Ok((residual, jacobian))
}

/// Updates `covariance` with one scalar of unit noise seen along `row` and gives the gain.
fn scalar_update<T, D>(covariance: &mut OMatrix<T, D, D>, row: &OVector<T, D>) -> OVector<T, D>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: StateAlloc<D>,
{
    let cross = &*covariance * row;
    let gain = &cross / (row.dot(&cross) + T::one());
    // P₁ = P - k cᵀ; what rounding left of P₁ h is taken out again by the second correction.
    covariance.ger(-T::one(), &gain, &cross, T::one());
    let left = &*covariance * row;
    let n = covariance.nrows();
    let half: T = nalgebra::convert(0.5);
    for j in 0..n {
        for i in j..n {
            let lower = covariance[(i, j)] - left[i] * gain[j];
            let upper = covariance[(j, i)] - left[j] * gain[i];
            let entry = (lower + upper) * half + gain[i] * gain[j];
            covariance[(i, j)] = entry;
            covariance[(j, i)] = entry;
        }
    }
    gain
}
