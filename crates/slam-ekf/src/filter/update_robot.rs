use nalgebra::{DMatrix, DVector, DefaultAllocator, DimName, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, SensorModel, UpdateAlloc};
use wayfix_gaussian_core::ChiSquaredGate;

use super::{
    EkfSlam, OutlierRule,
    predict::{LARGEST_VARIANCE, check_covariance},
};
use crate::{
    Innovation, LandmarkDim, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc, SlamError,
    covariance::SparseJacobian,
};

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Corrects robot and map with a measurement of the robot alone: GPS, a compass, a camera at the ceiling.
    ///
    /// It ties the map to the world as an anchor does. Outliers are treated as those of landmark observations.
    /// [Andrade-Cetto 2005, Eqs. 23, 26, 27]
    ///
    /// ```
    /// use nalgebra::{Matrix1, Vector1};
    /// use wayfix_estimation_traits::SensorModel;
    /// use wayfix_slam_ekf::{EkfSlam, LineDistanceSensor, SlamParams};
    ///
    /// /// Measures the position of the robot on its line, with a standard deviation in metres.
    /// struct Camera(f64);
    /// impl SensorModel for Camera {
    ///     type State = Vector1<f64>;
    ///     type Measurement = Vector1<f64>;
    ///     fn expected(&self, robot: &Vector1<f64>) -> Vector1<f64> { *robot }
    ///     fn noise(&self, _: &Vector1<f64>) -> Matrix1<f64> { Matrix1::new(self.0 * self.0) }
    /// }
    ///
    /// let sensor = LineDistanceSensor { sigma: 0.1, sigma_per_meter: 0.0 };
    /// let start = (Vector1::new(0.0), Matrix1::new(1.0));
    /// let mut slam = EkfSlam::with_start_covariance(sensor, SlamParams::default(), start.0, start.1)?;
    /// slam.update_robot(&Camera(1.0), &Vector1::new(1.0))?;
    /// assert!((slam.robot().x - 0.5).abs() < 1e-6); // half way between two of equal variance
    /// # Ok::<(), wayfix_slam_ekf::SlamError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the measurement, Jacobian or noise is not finite, the noise is not a covariance, or the measurement is a rejected outlier;
    /// the filter is then unchanged.
    pub fn update_robot<S>(
        &mut self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Result<Innovation<S::Measurement>, SlamError>
    where
        S: SensorModel<State = M::Robot, Measurement: Manifold<Scalar = f64, Dim: DimName>>,
        DefaultAllocator: UpdateAlloc<RobotDim<M>, <S::Measurement as Manifold>::Dim>,
    {
        let what = "measurement of the robot";
        let (jacobian, noise) = (sensor.jacobian(&self.robot), sensor.noise(&self.robot));
        let residual = sensor.expected(&self.robot).local(measurement);
        if !residual.iter().chain(jacobian.iter()).all(|entry| entry.is_finite()) {
            return Err(SlamError::NotFinite { what });
        }
        check_covariance("measurement noise", &noise)?;

        let covariance = &jacobian * self.robot_covariance() * jacobian.transpose() + &noise;
        let indefinite =
            SlamError::NotACovariance { what, value: covariance.diagonal().min(), asymmetry: 0.0 };
        let Some(factor) = Cholesky::new(covariance.clone()) else { return Err(indefinite) };
        let innovation = Innovation { nis: residual.dot(&factor.solve(&residual)), residual, covariance };
        let size = <S::Measurement as Manifold>::Dim::DIM;
        let threshold = self.robot_gate(size)?;
        if innovation.nis > threshold && self.params.outlier_rule == OutlierRule::Reject {
            return Err(SlamError::Outlier { nis: innovation.nis, threshold });
        }
        let noise = noise * self.params.noise_scale(innovation.nis, threshold);
        if noise.amax() >= LARGEST_VARIANCE {
            return Err(SlamError::Outlier { nis: innovation.nis, threshold }); // so far out that its weight would be zero
        }

        let mut rows = SparseJacobian::default();
        for row in jacobian.row_iter() {
            rows.push_row(row.iter().copied(), 0, []);
        }
        let noise = DMatrix::from_fn(size, size, |row, column| noise[(row, column)]);
        let residual = DVector::from_fn(size, |row, _| innovation.residual[row]);
        let step = self.covariance.correct(&rows, &noise, &residual).ok_or(indefinite)?;
        self.step(&step);
        Ok(innovation)
    }

    fn robot_gate(&self, degrees_of_freedom: usize) -> Result<f64, SlamError> {
        let probability = self.params.gate_probability;
        let gate = ChiSquaredGate::from_probability(degrees_of_freedom, probability);
        let range = "between 0 and 1, exclusive";
        gate.map(|gate| gate.threshold()).map_err(|_| SlamError::Parameter {
            name: "gate_probability",
            value: probability,
            range,
        })
    }
}
