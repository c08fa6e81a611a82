use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::{ChiSquaredGate, Gaussian};

use crate::{ExtendedKalmanAlgorithm, GatedUpdate, Innovation, KalmanAlgorithm, KalmanError};

/// A Gaussian filter: a motion model, a [`KalmanAlgorithm`] and the present belief.
///
/// The sensor is passed with each measurement, so one filter supports several sensors.
///
/// ```
/// use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
/// use wayfix_estimation_traits::{MotionModel, Pose2, SensorModel};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::ExtendedKalmanFilter;
///
/// /// Odometry increments in the body frame; the Jacobian is taken numerically.
/// struct Odometry;
/// impl MotionModel for Odometry {
///     type State = Pose2<f64>;
///     type Control = Vector3<f64>;
///     fn propagate(&self, pose: &Pose2<f64>, step: &Vector3<f64>) -> Pose2<f64> {
///         wayfix_estimation_traits::Manifold::retract(pose, step)
///     }
///     fn noise(&self, _: &Pose2<f64>, _: &Vector3<f64>) -> Matrix3<f64> {
///         Matrix3::identity() * 1e-4
///     }
/// }
/// /// A position fix.
/// struct Fix;
/// impl SensorModel for Fix {
///     type State = Pose2<f64>;
///     type Measurement = Vector2<f64>;
///     fn expected(&self, pose: &Pose2<f64>) -> Vector2<f64> {
///         pose.translation
///     }
///     fn noise(&self, _: &Pose2<f64>) -> Matrix2<f64> {
///         Matrix2::identity() * 0.01
///     }
/// }
/// let prior = Gaussian::new(Pose2::new(0.0, 0.0, 0.0), Matrix3::identity())?;
/// let mut filter = ExtendedKalmanFilter::new(Odometry, Default::default(), prior)?;
/// filter.predict(&Vector3::new(1.0, 0.0, 0.0))?;
/// let innovation = filter.update(&Fix, &Vector2::new(1.2, 0.1))?;
/// assert!(innovation.nis() < 1.0);
/// assert!((filter.estimate().mean().x() - 1.2).abs() < 0.01);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct GaussianFilter<M: MotionModel, F: KalmanAlgorithm<M::State>>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    motion: M,
    form: F,
    belief: F::Belief,
}

/// [`GaussianFilter`] in [`ExtendedKalmanAlgorithm`] form.
pub type ExtendedKalmanFilter<M> = GaussianFilter<M, ExtendedKalmanAlgorithm>;

impl<M: MotionModel, F: KalmanAlgorithm<M::State>> GaussianFilter<M, F>
where
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    /// A filter that starts from `prior`.
    ///
    /// # Errors
    /// Returns an error if the prior's covariance is not positive definite beyond rounding.
    pub fn new(motion: M, form: F, prior: Gaussian<M::State>) -> Result<Self, KalmanError> {
        let belief = form.belief_from(&prior)?;
        Ok(Self { motion, form, belief })
    }

    /// The present belief as a Gaussian.
    pub fn estimate(&self) -> Gaussian<M::State> {
        self.belief.clone().into()
    }
    /// The present belief in the representation of the form.
    pub fn belief(&self) -> &F::Belief {
        &self.belief
    }
    /// The motion model.
    pub fn motion(&self) -> &M {
        &self.motion
    }

    /// Predicts the belief with `control`.
    ///
    /// # Errors
    /// Returns an error if the model output for this control is invalid; the filter is then unchanged.
    pub fn predict(&mut self, control: &M::Control) -> Result<(), KalmanError> {
        self.belief = self.form.predict(&self.belief, &self.motion, control)?;
        Ok(())
    }

    /// Corrects the belief by `measurement`.
    ///
    /// # Errors
    /// Returns an error if model output or measurement are invalid; the filter is then unchanged.
    pub fn update<S>(
        &mut self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Result<Innovation<M::State, S::Measurement>, KalmanError>
    where
        S: SensorModel<State = M::State>,
        DefaultAllocator: UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let (innovation, posterior) = self.form.update(&self.belief, sensor, measurement, |_| true)?;
        if let Some(posterior) = posterior {
            self.belief = posterior;
        }
        Ok(innovation)
    }

    /// Corrects the belief by `measurement`, if there is one and `gate` accepts it.
    ///
    /// # Errors
    /// Returns an error if model output or measurement are invalid; the filter is then unchanged.
    pub fn update_gated<S>(
        &mut self,
        sensor: &S,
        measurement: Option<&S::Measurement>,
        gate: &ChiSquaredGate,
    ) -> Result<GatedUpdate<M::State, S::Measurement>, KalmanError>
    where
        S: SensorModel<State = M::State>,
        DefaultAllocator: UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let Some(measurement) = measurement else { return Ok(GatedUpdate::Missing) };
        let admits = |innovation: &Innovation<M::State, S::Measurement>| gate.accepts(innovation.nis());
        let (innovation, posterior) = self.form.update(&self.belief, sensor, measurement, admits)?;
        let Some(posterior) = posterior else {
            return Ok(GatedUpdate::Rejected { innovation, threshold: gate.threshold() });
        };
        self.belief = posterior;
        Ok(GatedUpdate::Accepted { innovation })
    }
}
