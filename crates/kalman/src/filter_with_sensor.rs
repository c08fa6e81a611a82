use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{BayesFilter, Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::{ChiSquaredGate, Gaussian};

use crate::{Form, GaussianFilter, KalmanError, Update};

/// A [`GaussianFilter`] with one sensor: a [`BayesFilter`].
///
/// For code that is generic over filters. Measurements are `Option`s: `None` is a missed observation.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use wayfix_estimation_traits::BayesFilter;
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{GaussianFilter, LinearMotion, LinearSensor, FilterWithSensor, SquareRoot, Update};
/// let prior = Gaussian::new(Vector1::new(0.0), Matrix1::new(1.0))?;
/// let filter = GaussianFilter::new(LinearMotion::stationary(Matrix1::new(0.1))?, SquareRoot, prior)?;
/// let mut filter = FilterWithSensor::new(filter, LinearSensor::new(Matrix1::new(1.0), Matrix1::new(1.0))?);
/// filter.predict(&None)?;
/// assert!(matches!(filter.update(&None)?, Update::Missing));
/// assert!(filter.update(&Some(Vector1::new(1.0)))?.is_accepted());
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FilterWithSensor<F, S> {
    filter: F,
    sensor: S,
    gate: Option<ChiSquaredGate>,
}

impl<F, S> FilterWithSensor<F, S> {
    /// `filter`, corrected by every measurement of `sensor`.
    pub fn new(filter: F, sensor: S) -> Self {
        Self { filter, sensor, gate: None }
    }
    /// The same, but only by measurements that pass `gate`.
    pub fn gated(self, gate: ChiSquaredGate) -> Self {
        Self { gate: Some(gate), ..self }
    }
    /// The filter inside.
    pub fn filter(&self) -> &F {
        &self.filter
    }
    /// The filter again, without its sensor.
    pub fn into_filter(self) -> F {
        self.filter
    }
}

impl<M, F, S> BayesFilter for FilterWithSensor<GaussianFilter<M, F>, S>
where
    M: MotionModel,
    F: Form<M::State>,
    S: SensorModel<State = M::State>,
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>
        + UpdateAlloc<<M::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
{
    type Control = M::Control;
    type Measurement = Option<S::Measurement>;
    type Estimate = Gaussian<M::State>;
    type Report = Update<M::State, S::Measurement>;
    type Error = KalmanError;

    fn predict(&mut self, control: &M::Control) -> Result<(), KalmanError> {
        self.filter.predict(control)
    }

    fn update(&mut self, measurement: &Option<S::Measurement>) -> Result<Self::Report, KalmanError> {
        match (&self.gate, measurement) {
            (Some(gate), _) => self.filter.update_gated(&self.sensor, measurement.as_ref(), gate),
            (None, Some(measurement)) => {
                let innovation = self.filter.update(&self.sensor, measurement)?;
                Ok(Update::Accepted { innovation })
            }
            (None, None) => Ok(Update::Missing),
        }
    }

    fn estimate(&self) -> Gaussian<M::State> {
        self.filter.estimate()
    }
}
