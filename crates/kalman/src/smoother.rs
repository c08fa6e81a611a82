use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, TangentMatrix, UpdateAlloc};
use wayfix_gaussian_core::{Gaussian, cholesky, symmetrize};

use crate::{
    ExtendedKalmanAlgorithm, Innovation, KalmanAlgorithm, KalmanError,
    algebra::product::propagated_covariance, algebra::transport::gaussian_at, check, error::Checked,
    linearize::linearize_motion,
};

/// The Rauch-Tung-Striebel smoother: a forward pass in [`ExtendedKalmanAlgorithm`] form, then a backward pass with the later measurements.
///
/// $`G = P F^T P_-^{-1},\; x^s = x ⊞ G (x^s_+ ⊟ x_-),\; P^s = (I - GF) P (I - GF)^T + G (Q + P^s_+) G^T`$; the last is the form of Joseph
/// of the textbook's $`P + G (P^s_+ - P_-) G^T`$ and subtracts nothing. [Särkkä 2013, Eq. 8.6]
/// On linear models it is the least-squares fit to all measurements at once.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{LinearMotion, LinearSensor, RtsSmoother};
/// let walk = LinearMotion::stationary(Matrix1::new(1.0))?;
/// let sensor = LinearSensor::new(Matrix1::new(1.0), Matrix1::new(1.0))?;
/// let mut smoother = RtsSmoother::new(Gaussian::new(Vector1::new(0.0_f64), Matrix1::new(1.0))?)?;
/// smoother.predict(&walk, &None)?;
/// smoother.update(&sensor, &Vector1::new(3.0))?;
/// let path = smoother.smoothed()?;
/// // Start, step and sensor share the 3 metres equally: three unit variances in a row.
/// assert!((path[0].mean()[0] - 1.0).abs() < 1e-15 && (path[1].mean()[0] - 2.0).abs() < 1e-15);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct RtsSmoother<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    transitions: Vec<Transition<X>>,
    current: Gaussian<X>,
}

/// A step of the forward pass: the belief before it and the belief after it.
#[derive(Clone, Debug)]
struct Transition<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    filtered: Gaussian<X>,
    predicted: Gaussian<X>,
    jacobian: TangentMatrix<X>,
    noise: TangentMatrix<X>,
}

impl<X: Manifold> RtsSmoother<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// A smoother whose first state is distributed as `prior`.
    ///
    /// # Errors
    /// Returns an error if the prior's covariance is not positive definite beyond rounding.
    pub fn new(prior: Gaussian<X>) -> Result<Self, KalmanError> {
        Ok(Self { transitions: Vec::new(), current: ExtendedKalmanAlgorithm.belief_from(&prior)? })
    }

    /// The filtered estimate of the last state.
    pub fn filtered(&self) -> &Gaussian<X> {
        &self.current
    }

    /// Adds a state, predicted with `control`.
    ///
    /// # Errors
    /// Returns an error if the model output is invalid; the smoother is then unchanged.
    pub fn predict<M>(&mut self, motion: &M, control: &M::Control) -> Result<(), KalmanError>
    where
        M: MotionModel<State = X>,
    {
        let linear = linearize_motion(motion, self.current.mean(), control)?;
        let covariance = propagated_covariance(&linear.jacobian, self.current.covariance(), &linear.noise);
        check::positive_definite("predicted", &covariance)?;
        let predicted = Gaussian::from_parts_unchecked(linear.mean, covariance);
        let filtered = std::mem::replace(&mut self.current, predicted.clone());
        self.transitions.push(Transition {
            filtered,
            predicted,
            jacobian: linear.jacobian,
            noise: linear.noise,
        });
        Ok(())
    }

    /// Corrects the last state by `measurement`; any number of times, or not at all.
    ///
    /// # Errors
    /// Returns an error if model output or measurement are invalid; the smoother is then unchanged.
    pub fn update<S>(
        &mut self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Result<Innovation<X, S::Measurement>, KalmanError>
    where
        S: SensorModel<State = X>,
        DefaultAllocator: UpdateAlloc<X::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let (innovation, posterior) =
            ExtendedKalmanAlgorithm.update(&self.current, sensor, measurement, |_| true)?;
        if let Some(posterior) = posterior {
            self.current = posterior;
        }
        Ok(innovation)
    }

    /// Replaces the filtered estimate of the last state by that of another filter, such as a component of a mixture.
    ///
    /// ```
    /// use nalgebra::{Matrix1, Vector1};
    /// use wayfix_gaussian_core::Gaussian;
    /// use wayfix_kalman::{LinearMotion, RtsSmoother};
    /// let walk = LinearMotion::stationary(Matrix1::new(1.0))?;
    /// let at = |x: f64| Gaussian::new(Vector1::new(x), Matrix1::new(1e-6));
    /// let mut smoother = RtsSmoother::new(at(0.0)?)?;
    /// smoother.predict(&walk, &None)?;
    /// smoother.predict(&walk, &None)?;
    /// smoother.set_filtered(at(2.0)?)?;
    /// assert!((smoother.smoothed()?[1].mean()[0] - 1.0).abs() < 1e-3); // half way
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the covariance is not positive definite beyond rounding; the smoother is then unchanged.
    pub fn set_filtered(&mut self, filtered: Gaussian<X>) -> Result<(), KalmanError> {
        self.current = ExtendedKalmanAlgorithm.belief_from(&filtered)?;
        Ok(())
    }

    /// All states given all measurements, first to last.
    ///
    /// # Errors
    /// Returns an error if rounding makes a smoothed covariance indefinite.
    pub fn smoothed(&self) -> Result<Vec<Gaussian<X>>, KalmanError> {
        let mut path = vec![self.current.clone()];
        let mut later = self.current.clone();
        for transition in self.transitions.iter().rev() {
            later = transition.smoothed(&later)?;
            path.push(later.clone());
        }
        path.reverse();
        Ok(path)
    }
}

impl<X: Manifold> Transition<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The state before this transition, given the smoothed state after it.
    fn smoothed(&self, later: &Gaussian<X>) -> Checked<Gaussian<X>> {
        let (filtered, f) = (self.filtered.covariance(), &self.jacobian);
        let gain = cholesky("predicted", self.predicted.covariance())?.solve(&(f * filtered)).transpose();
        // The later state as the forward pass saw it: in the tangent space at its prediction.
        let (correction, later) = later.in_chart_at(self.predicted.mean())?.into_parts();
        let n = self.filtered.dim();
        let remainder = TangentMatrix::<X>::identity_generic(n, n) - &gain * f;
        let mut covariance =
            &remainder * filtered * remainder.transpose() + &gain * (&self.noise + later) * gain.transpose();
        symmetrize(&mut covariance);
        let mean = check::moved("smoothed mean", self.filtered.mean(), &(gain * correction))?;
        gaussian_at("smoothed", mean, self.filtered.mean(), covariance)
    }
}
