use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::Gaussian;

use crate::{
    Extended, Form, Innovation, algebra::product::plain_difference, algebra::transport::transported, check,
    error::Checked, linearize::linearize_sensor,
};

/// A faster variant of [`Extended`]: $`P = P - K C^T`$ instead of the form of Joseph.
///
/// For well-conditioned problems. If rounding makes the difference indefinite it returns an error, earlier than [`Extended`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlainExtended;

impl<X: Manifold> Form<X> for PlainExtended
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    type Belief = Gaussian<X>;

    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<Gaussian<X>> {
        Extended.belief_from(gaussian)
    }

    fn gaussian(&self, belief: &Gaussian<X>) -> Gaussian<X> {
        belief.clone()
    }

    fn predict<M>(&self, belief: &Gaussian<X>, motion: &M, control: &M::Control) -> Checked<Gaussian<X>>
    where
        M: MotionModel<State = X>,
    {
        Extended.predict(belief, motion, control)
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
        let covariance = plain_difference(prior, &gain, innovation.cross_covariance());
        check::positive_definite("posterior", &covariance)?;
        let covariance = transported(covariance, belief.mean(), &mean)?;
        Ok((innovation, Some(Gaussian::from_parts_unchecked(mean, covariance))))
    }
}
