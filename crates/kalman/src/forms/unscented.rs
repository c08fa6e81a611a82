use nalgebra::{DefaultAllocator, Dim, OMatrix};
use wayfix_estimation_traits::{
    Manifold, MotionModel, SensorModel, StateAlloc, Tangent, TangentMatrix, UpdateAlloc,
};
use wayfix_gaussian_core::{Gaussian, SigmaPoints, UnscentedParams, symmetrize, weighted_mean};

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
        let sigma = SigmaPoints::new(belief, &self.params)?;
        let images: Vec<X> = sigma.points.iter().map(|point| motion.propagate(point, control)).collect();
        for image in &images {
            check::difference("predicted sigma point", belief.mean(), image)?;
        }
        let mean = weighted_mean(&images, &sigma.mean_weights)?;
        let mut covariance = motion.noise(belief.mean(), control);
        check::motion_noise(&covariance, belief.mean().dim().value())?;
        for (image, &weight) in images.iter().zip(&sigma.covariance_weights) {
            add_outer::<X>(&mut covariance, weight, &mean.local(image));
        }
        symmetrize(&mut covariance);
        check::positive_definite("predicted", &covariance)?;
        Ok(Gaussian::from_parts_unchecked(mean, covariance))
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
        let spread = Spread::new(belief, sensor, measurement, &self.params)?;
        let residual = check::difference("measurement", &spread.expected, measurement)?;
        let innovation = spread.innovation(residual, &noise)?;
        if !admits(&innovation) {
            return Ok((innovation, None));
        }
        let gain = innovation.gain();
        let mean = check::moved("posterior mean", belief.mean(), &(&gain * innovation.residual()))?;
        let covariance = spread.remaining(&gain, &noise);
        Ok((innovation, Some(gaussian_at("posterior", mean, belief.mean(), covariance)?)))
    }
}

/// Sigma points and their predicted measurements, as deviations from their means.
struct Spread<X: Manifold, Z: Manifold<Scalar = X::Scalar>>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    expected: Z,
    deviations: Vec<(f64, Tangent<X>, Tangent<Z>)>,
    origin: X,
}

impl<X: Manifold, Z: Manifold<Scalar = X::Scalar>> Spread<X, Z>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    fn new<S>(belief: &Gaussian<X>, sensor: &S, measurement: &Z, params: &UnscentedParams) -> Checked<Self>
    where
        S: SensorModel<State = X, Measurement = Z>,
    {
        let sigma = SigmaPoints::new(belief, params)?;
        let images: Vec<Z> = sigma.points.iter().map(|point| sensor.expected(point)).collect();
        for image in &images {
            check::difference("measurement", image, measurement)?;
        }
        let expected = weighted_mean(&images, &sigma.mean_weights)?;
        let deviations = sigma
            .points
            .iter()
            .zip(&images)
            .zip(&sigma.covariance_weights)
            .map(|((point, image), &weight)| (weight, belief.mean().local(point), expected.local(image)))
            .collect();
        Ok(Self { expected, deviations, origin: belief.mean().clone() })
    }

    /// $`S = \sum w ζ ζ^T + R,\; C = \sum w χ ζ^T`$.
    fn innovation(&self, residual: Tangent<Z>, noise: &TangentMatrix<Z>) -> Checked<Innovation<X, Z>> {
        let mut covariance = noise.clone();
        let mut cross_covariance = OMatrix::zeros_generic(self.origin.dim(), self.expected.dim());
        for (weight, state, seen) in &self.deviations {
            add_outer::<Z>(&mut covariance, *weight, seen);
            cross_covariance.ger(nalgebra::convert::<f64, X::Scalar>(*weight), state, seen, nalgebra::one());
        }
        symmetrize(&mut covariance);
        Innovation::new(residual, covariance, cross_covariance)
    }

    /// $`\sum w (χ - K ζ)(χ - K ζ)^T + K R K^T`$.
    fn remaining(
        &self,
        gain: &OMatrix<X::Scalar, X::Dim, Z::Dim>,
        noise: &TangentMatrix<Z>,
    ) -> TangentMatrix<X> {
        let mut covariance = gain * noise * gain.transpose();
        for (weight, state, seen) in &self.deviations {
            add_outer::<X>(&mut covariance, *weight, &(state - gain * seen));
        }
        symmetrize(&mut covariance);
        covariance
    }
}

/// Adds $`w v v^T`$.
fn add_outer<X: Manifold>(matrix: &mut TangentMatrix<X>, weight: f64, vector: &Tangent<X>)
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    matrix.ger(nalgebra::convert(weight), vector, vector, nalgebra::one());
}
