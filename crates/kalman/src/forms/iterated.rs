use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField};
use wayfix_estimation_traits::{
    Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc, epsilon, to_f64,
};
use wayfix_gaussian_core::Gaussian;

use crate::{
    ExtendedKalmanAlgorithm, Innovation, KalmanAlgorithm, KalmanError, algebra::product::joseph,
    algebra::transport::gaussian_at, check, error::Checked, linearize::linearize_sensor,
};

/// The iterated extended filter: the update relinearizes at its own result until convergence, which is Gauss-Newton on
/// $`\|x ⊟ \hat x\|^2_P + \|z ⊟ h(x)\|^2_R`$. [Bell & Cathey 1993]
///
/// Each iteration works in the tangent space at its iterate, to which the prior is transformed to first order. [He et al. 2021, §IV]
/// The reported innovation is that of the prediction, as for every other form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IteratedExtendedKalmanAlgorithm {
    /// Maximum number of relinearizations; default 20.
    pub max_iterations: usize,
    /// Converged when no component moves by more than this many prior standard deviations; default 1e-6 (never below $`\sqrt ε`$).
    pub tolerance: f64,
}

impl Default for IteratedExtendedKalmanAlgorithm {
    fn default() -> Self {
        Self { max_iterations: 20, tolerance: 1e-6 }
    }
}

impl<X: Manifold> KalmanAlgorithm<X> for IteratedExtendedKalmanAlgorithm
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
        let (mean, prior) = (belief.mean(), belief.covariance());
        let first = linearize_sensor(sensor, mean, measurement)?;
        let innovation = Innovation::of_linearized(first.residual, prior, &first.jacobian, &first.noise)?;
        if !admits(&innovation) {
            return Ok((innovation, None));
        }
        let mut point = mean.clone();
        let mut last_step = f64::INFINITY;
        for _ in 0..self.max_iterations {
            let linear = linearize_sensor(sensor, &point, measurement)?;
            let (to_prior, prior) = belief.in_chart_at(&point)?.into_parts();
            // The residual at the prior mean by this linearization.
            let residual = &linear.residual - &linear.jacobian * &to_prior;
            let fit = Innovation::<X, S::Measurement>::of_linearized(
                residual,
                &prior,
                &linear.jacobian,
                &linear.noise,
            )?;
            let gain = fit.gain();
            let step = to_prior + &gain * fit.residual();
            last_step = in_sigmas(&step, &prior);
            let next = check::moved("iterate", &point, &step)?;
            if last_step <= self.tolerance.max(to_f64(epsilon::<X::Scalar>()).sqrt()) {
                let covariance =
                    joseph(&prior, &gain, fit.cross_covariance(), &linear.jacobian, &linear.noise);
                return Ok((innovation, Some(gaussian_at("posterior", next, &point, covariance)?)));
            }
            point = next;
        }
        Err(KalmanError::NotConverged {
            iterations: self.max_iterations,
            last_step,
            last_offset: mean.local(&point).iter().map(|component| to_f64(*component)).collect(),
        })
    }
}

/// The largest component of a step, in standard deviations of `prior`.
fn in_sigmas<T: RealField + Copy, D: Dim>(step: &OVector<T, D>, prior: &OMatrix<T, D, D>) -> f64
where
    DefaultAllocator: StateAlloc<D>,
{
    (0..step.nrows()).map(|i| to_f64(step[i].abs() / prior[(i, i)].sqrt())).fold(0.0, f64::max)
}
