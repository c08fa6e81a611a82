use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use crate::{
    Innovation, KalmanAlgorithm,
    algebra::product::{joseph, propagated_covariance},
    algebra::transport::gaussian_at,
    check,
    error::Checked,
    linearize::{linearize_motion, linearize_sensor},
};

/// The extended Kalman filter in the form of Joseph, on any manifold.
///
/// Predict: $`x = f(x, u),\; P = F P F^T + Q`$. Update: $`S = H P H^T + R,\; K = P H^T S^{-1},\; x = x ⊞ K y,\;
/// P = (I - KH) P (I - KH)^T + K R K^T`$. On linear models it is the Kalman filter. [Bar-Shalom et al. 2001, §10.3]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExtendedKalmanAlgorithm;

impl<X: Manifold> KalmanAlgorithm<X> for ExtendedKalmanAlgorithm
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    type Belief = Gaussian<X>;

    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<Gaussian<X>> {
        check::positive_definite("prior", gaussian.covariance())?;
        Ok(gaussian.clone())
    }

    fn predict<M>(&self, belief: &Gaussian<X>, motion: &M, control: &M::Control) -> Checked<Gaussian<X>>
    where
        M: MotionModel<State = X>,
    {
        let linear = linearize_motion(motion, belief.mean(), control)?;
        let covariance = propagated_covariance(&linear.jacobian, belief.covariance(), &linear.noise);
        check::positive_definite("predicted", &covariance)?;
        Ok(Gaussian::from_parts_unchecked(linear.mean, covariance))
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
        let prior = belief.covariance();
        let linear = linearize_sensor(sensor, belief.mean(), measurement)?;
        let innovation = Innovation::of_linearized(linear.residual, prior, &linear.jacobian, &linear.noise)?;
        if !admits(&innovation) {
            return Ok((innovation, None));
        }
        let gain = innovation.gain();
        let mean = check::moved("posterior mean", belief.mean(), &(&gain * innovation.residual()))?;
        let covariance = joseph(prior, &gain, innovation.cross_covariance(), &linear.jacobian, &linear.noise);
        Ok((innovation, Some(gaussian_at("posterior", mean, belief.mean(), covariance)?)))
    }
}
