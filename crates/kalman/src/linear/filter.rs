use nalgebra::{DefaultAllocator, Dim, OMatrix, OVector, RealField};
use wayfix_estimation_traits::{StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::{ChiSquaredGate, Gaussian};

use super::{LinearMotion, LinearSensor};
use crate::{
    GatedUpdate, Innovation, KalmanError,
    algebra::product::{joseph, plain_difference, propagated_covariance},
    certificate::Floor,
    check,
    error::Checked,
};

/// The innovation of a linear sensor in a [`KalmanFilter`].
pub type LinearInnovation<T, D, M> = Innovation<OVector<T, D>, OVector<T, M>>;

/// The outcome of a gated measurement in a [`KalmanFilter`].
pub type LinearUpdate<T, D, M> = GatedUpdate<OVector<T, D>, OVector<T, M>>;

/// The Kalman filter: linear motion, linear sensors, a Gaussian.
///
/// The same results as [`ExtendedKalmanFilter`](crate::ExtendedKalmanFilter) on the same models, faster, because the models' matrices were
/// checked when they were built. [Kalman 1960]
///
/// ```
/// use nalgebra::{Matrix1, Matrix1x2, Matrix2, Vector1, Vector2};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{KalmanFilter, LinearMotion, LinearSensor};
/// let motion = LinearMotion::new(Matrix2::new(1.0, 0.1, 0.0, 1.0), Matrix2::identity() * 1e-4)?;
/// let sensor = LinearSensor::new(Matrix1x2::new(1.0, 0.0), Matrix1::new(0.01))?;
/// let prior = Gaussian::new(Vector2::zeros(), Matrix2::identity())?;
/// let mut filter = KalmanFilter::new(motion, prior)?;
/// for k in 1..=100 {
///     filter.predict(None)?;
///     filter.update(&sensor, &Vector1::new(0.2 * f64::from(k)))?; // 2 m/s, every 0.1 s
/// }
/// assert!((filter.estimate().mean() - Vector2::new(20.0, 2.0)).norm() < 0.01);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct KalmanFilter<T: RealField + Copy, D: Dim>
where
    DefaultAllocator: StateAlloc<D>,
{
    motion: LinearMotion<T, D>,
    estimate: Gaussian<OVector<T, D>>,
    floor: Floor<T>,
}

impl<T: RealField + Copy, D: Dim> KalmanFilter<T, D>
where
    DefaultAllocator: StateAlloc<D>,
{
    /// A filter that starts from `prior`.
    ///
    /// # Errors
    /// Returns an error if sizes do not match or the prior's covariance is not positive definite beyond rounding.
    pub fn new(motion: LinearMotion<T, D>, prior: Gaussian<OVector<T, D>>) -> Result<Self, KalmanError> {
        let n = motion.transition().nrows();
        let (mean, mut covariance) = prior.into_parts();
        check::dimension("prior", n, mean.nrows())?;
        check::shape("prior covariance", (n, n), covariance.shape())?;
        check::positive_definite("prior", &covariance)?;
        // No certificate covers the other triangle of an unchecked Gaussian.
        covariance.fill_upper_triangle_with_lower_triangle();
        Ok(Self { motion, estimate: Gaussian::from_parts_unchecked(mean, covariance), floor: T::zero() })
    }

    /// The present belief.
    pub fn estimate(&self) -> &Gaussian<OVector<T, D>> {
        &self.estimate
    }
    /// The motion model.
    pub fn motion(&self) -> &LinearMotion<T, D> {
        &self.motion
    }

    /// $`x = F x + u,\; P = F P F^T + Q`$; `None` for free motion.
    ///
    /// # Errors
    /// Returns an error if the displacement has the wrong size or on overflow; the filter is then unchanged.
    #[inline(always)]
    pub fn predict(&mut self, displacement: Option<&OVector<T, D>>) -> Result<(), KalmanError> {
        let transition = self.motion.transition();
        let mut mean = transition * self.estimate.mean();
        if let Some(displacement) = displacement {
            check::dimension("control", mean.nrows(), displacement.nrows())?;
            mean += displacement;
        }
        check::finite("predicted mean", &mean)?;
        let prior = self.estimate.covariance();
        let covariance = propagated_covariance(transition, prior, self.motion.noise());
        self.floor = match self.motion.certificate().after(prior.trace()) {
            Some(floor) => floor,
            None => proved_by_elimination("predicted", &covariance)?,
        };
        self.estimate = Gaussian::from_parts_unchecked(mean, covariance);
        Ok(())
    }

    /// Corrects by `measurement`, in the form of Joseph.
    ///
    /// # Errors
    /// Returns an error if the measurement is invalid; the filter is then unchanged.
    #[inline(always)]
    pub fn update<M: Dim>(
        &mut self,
        sensor: &LinearSensor<OVector<T, D>, OVector<T, M>>,
        measurement: &OVector<T, M>,
    ) -> Result<LinearInnovation<T, D, M>, KalmanError>
    where
        DefaultAllocator: UpdateAlloc<D, M>,
    {
        let innovation = self.innovation(sensor, measurement)?;
        self.correct(sensor, &innovation)?;
        Ok(innovation)
    }

    /// Corrects by `measurement` with $`P = P - K C^T`$: half the work of [`update`](Self::update), for well-conditioned problems.
    ///
    /// # Errors
    /// Returns an error if the measurement is invalid or rounding makes the difference indefinite; the filter is then unchanged.
    #[inline(always)]
    pub fn update_plain<M: Dim>(
        &mut self,
        sensor: &LinearSensor<OVector<T, D>, OVector<T, M>>,
        measurement: &OVector<T, M>,
    ) -> Result<LinearInnovation<T, D, M>, KalmanError>
    where
        DefaultAllocator: UpdateAlloc<D, M>,
    {
        let innovation = self.innovation(sensor, measurement)?;
        let gain = innovation.gain();
        let covariance = plain_difference(self.estimate.covariance(), &gain, innovation.cross_covariance());
        self.accept(sensor, &gain, innovation.residual(), covariance)?;
        Ok(innovation)
    }

    /// Corrects by `measurement` in the form of Joseph, if there is one and `gate` accepts it.
    ///
    /// # Errors
    /// Returns an error if the measurement is invalid; the filter is then unchanged.
    pub fn update_gated<M: Dim>(
        &mut self,
        sensor: &LinearSensor<OVector<T, D>, OVector<T, M>>,
        measurement: Option<&OVector<T, M>>,
        gate: &ChiSquaredGate,
    ) -> Result<LinearUpdate<T, D, M>, KalmanError>
    where
        DefaultAllocator: UpdateAlloc<D, M>,
    {
        let Some(measurement) = measurement else { return Ok(GatedUpdate::Missing) };
        let innovation = self.innovation(sensor, measurement)?;
        if !gate.accepts(innovation.nis()) {
            return Ok(GatedUpdate::Rejected { innovation, threshold: gate.threshold() });
        }
        self.correct(sensor, &innovation)?;
        Ok(GatedUpdate::Accepted { innovation })
    }

    /// The innovation of `measurement`, without a correction.
    ///
    /// # Errors
    /// Returns an error if the measurement is invalid.
    #[inline(always)]
    pub fn innovation<M: Dim>(
        &self,
        sensor: &LinearSensor<OVector<T, D>, OVector<T, M>>,
        measurement: &OVector<T, M>,
    ) -> Result<LinearInnovation<T, D, M>, KalmanError>
    where
        DefaultAllocator: UpdateAlloc<D, M>,
    {
        let (m, n) = sensor.matrix().shape();
        check::dimension("state", n, self.estimate.mean().nrows())?;
        check::dimension("measurement", m, measurement.nrows())?;
        let residual = measurement - sensor.matrix() * self.estimate.mean();
        check::finite("measurement", &residual)?;
        Innovation::of_linearized(residual, self.estimate.covariance(), sensor.matrix(), sensor.noise())
    }

    #[inline(always)]
    fn correct<M: Dim>(
        &mut self,
        sensor: &LinearSensor<OVector<T, D>, OVector<T, M>>,
        innovation: &LinearInnovation<T, D, M>,
    ) -> Checked
    where
        DefaultAllocator: UpdateAlloc<D, M>,
    {
        let (prior, cross_covariance) = (self.estimate.covariance(), innovation.cross_covariance());
        let gain = innovation.gain();
        let covariance = joseph(prior, &gain, cross_covariance, sensor.matrix(), sensor.noise());
        self.accept(sensor, &gain, innovation.residual(), covariance)
    }

    #[inline(always)]
    fn accept<M: Dim>(
        &mut self,
        sensor: &LinearSensor<OVector<T, D>, OVector<T, M>>,
        gain: &OMatrix<T, D, M>,
        residual: &OVector<T, M>,
        covariance: OMatrix<T, D, D>,
    ) -> Checked
    where
        DefaultAllocator: UpdateAlloc<D, M>,
    {
        let mean = self.estimate.mean() + gain * residual;
        check::finite("posterior mean", &mean)?;
        self.floor = match sensor.certificate().after(self.floor, self.estimate.covariance().trace()) {
            Some(floor) => floor,
            None => proved_by_elimination("posterior", &covariance)?,
        };
        self.estimate = Gaussian::from_parts_unchecked(mean, covariance);
        Ok(())
    }
}

/// Positive definite, with an unknown smallest eigenvalue.
#[cold]
#[inline(never)]
fn proved_by_elimination<T: RealField + Copy, D: Dim>(
    what: &'static str,
    covariance: &OMatrix<T, D, D>,
) -> Checked<Floor<T>>
where
    DefaultAllocator: StateAlloc<D>,
{
    check::positive_definite(what, covariance)?;
    Ok(T::zero())
}
