use nalgebra::{DefaultAllocator, Dim, OMatrix};
use wayfix_estimation_traits::{
    Manifold, MotionModel, SensorModel, StateAlloc, Tangent, TangentMatrix, UpdateAlloc,
};
use wayfix_gaussian_core::{
    Gaussian, SigmaDeviation, SigmaPoints, UnscentedParams, UnscentedTransform, symmetrize,
};

use crate::{
    ExtendedKalmanAlgorithm, Innovation, KalmanAlgorithm, algebra::transport::gaussian_at, check,
    error::Checked,
};

/// The unscented filter with additive noise, on any manifold: sigma points instead of Jacobians.
///
/// The posterior covariance is the sum over the corrected deviations of the sigma points,
/// $`P = \sum_i w_i (χ_i - K ζ_i)(χ_i - K ζ_i)^T + K R K^T`$, the form of Joseph for sigma points, where the textbook's
/// $`P - K S K^T`$ loses positive definiteness. [Wan & van der Merwe 2000]; means on manifolds as in [Hertzberg et al. 2013].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnscentedKalmanAlgorithm {
    /// Spread and weights of the sigma points.
    pub params: UnscentedParams,
}

impl<X: Manifold> KalmanAlgorithm<X> for UnscentedKalmanAlgorithm
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    type Belief = Gaussian<X>;

    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<Gaussian<X>> {
        SigmaPoints::new(gaussian, &self.params)?;
        ExtendedKalmanAlgorithm.belief_from(gaussian)
    }

    fn predict<M>(&self, belief: &Gaussian<X>, motion: &M, control: &M::Control) -> Checked<Gaussian<X>>
    where
        M: MotionModel<State = X>,
    {
        let noise = motion.noise(belief.mean(), control);
        check::motion_noise(&noise, belief.mean().dim().value())?;
        let predicted = self.transform(
            belief,
            |state| motion.propagate(state, control),
            |image| check::difference("predicted sigma point", belief.mean(), image),
        )?;
        let mut covariance = predicted.covariance() + noise;
        symmetrize(&mut covariance);
        check::positive_definite("predicted", &covariance)?;
        Ok(Gaussian::from_parts_unchecked(predicted.mean().clone(), covariance))
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
        let noise = sensor.noise(belief.mean());
        check::sensor_noise(&noise, measurement.dim().value())?;
        let predicted = self.transform(
            belief,
            |state| sensor.expected(state),
            |image| check::difference("measurement", image, measurement),
        )?;
        let residual = check::difference("measurement", predicted.mean(), measurement)?;
        let mut covariance = predicted.covariance() + &noise;
        symmetrize(&mut covariance);
        let innovation = Innovation::new(residual, covariance, predicted.cross_covariance())?;
        if !admits(&innovation) {
            return Ok((innovation, None));
        }
        let gain = innovation.gain();
        let mean = check::moved("posterior mean", belief.mean(), &(&gain * innovation.residual()))?;
        let covariance = remaining(&predicted, &gain, &noise);
        Ok((innovation, Some(gaussian_at("posterior", mean, belief.mean(), covariance)?)))
    }
}

impl UnscentedKalmanAlgorithm {
    /// The unscented transform under `function`, whose images pass a check.
    fn transform<X: Manifold, Z: Manifold<Scalar = X::Scalar>>(
        &self,
        belief: &Gaussian<X>,
        function: impl Fn(&X) -> Z,
        check: impl Fn(&Z) -> Checked<Tangent<Z>>,
    ) -> Checked<UnscentedTransform<X, Z>>
    where
        DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
    {
        let sigma = SigmaPoints::new(belief, &self.params)?;
        let images: Vec<Z> = sigma.points.iter().map(function).collect();
        for image in &images {
            check(image)?;
        }
        Ok(UnscentedTransform::from_images(belief, &sigma, &images)?)
    }
}

/// $`\sum w (χ - K ζ)(χ - K ζ)^T + K R K^T`$.
fn remaining<X: Manifold, Z: Manifold<Scalar = X::Scalar>>(
    predicted: &UnscentedTransform<X, Z>,
    gain: &OMatrix<X::Scalar, X::Dim, Z::Dim>,
    noise: &TangentMatrix<Z>,
) -> TangentMatrix<X>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    let mut covariance = gain * noise * gain.transpose();
    for SigmaDeviation { weight, state, image } in predicted.deviations() {
        let corrected = state - gain * image;
        covariance.ger(*weight, &corrected, &corrected, nalgebra::one());
    }
    symmetrize(&mut covariance);
    covariance
}
