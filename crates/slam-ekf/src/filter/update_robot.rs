use nalgebra::{
    Const, DMatrix, DefaultAllocator, Dim, DimName, OMatrix, allocator::Allocator, linalg::Cholesky,
};
use wayfix_estimation_traits::{Manifold, Pose2, SensorModel, TangentMatrix, UpdateAlloc};
use wayfix_gaussian_core::ChiSquaredGate;

use super::{
    EkfSlam, OutlierRule,
    predict::{LARGEST_VARIANCE, check_covariance, not_positive_definite},
};
use crate::{
    Innovation, LandmarkDim, LandmarkModel, MeasurementDim, PlanarRobot, RobotDim, RobotInnovation,
    SlamAlloc, SlamError, covariance::SparseJacobian,
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
        let (jacobian, noise) = (sensor.jacobian(&self.robot), sensor.noise(&self.robot));
        check_covariance("measurement noise", &noise)?;
        let residual = sensor.expected(&self.robot).local(measurement);
        let outlier_rule = self.params.outlier_rule;
        let robot =
            self.correct_robot(dynamic(&jacobian), dynamic(&noise), dynamic(&residual), outlier_rule)?;
        let covariance =
            TangentMatrix::<S::Measurement>::from_fn(|row, column| robot.covariance[(row, column)]);
        Ok(Innovation { nis: robot.nis, residual, covariance })
    }

    /// Corrects robot and map with a measurement of the pose by a sensor that may fail: GPS, a compass, a camera at the ceiling.
    ///
    /// As [`update_robot`](Self::update_robot) for a robot with more coordinates than the pose, but an outlier is always rejected: its NIS exceeds the
    /// chi-squared quantile of `gate_probability`. Returns what [`record_robot`](crate::observability::ObservabilityRecorder::record_robot) records.
    ///
    /// # Errors
    /// Returns the errors of [`update_robot`](Self::update_robot), and [`SlamError::Outlier`]; the filter is then unchanged.
    pub fn update_pose<S>(
        &mut self,
        sensor: &S,
        measurement: &S::Measurement,
    ) -> Result<RobotInnovation, SlamError>
    where
        M::Robot: PlanarRobot,
        S: SensorModel<State = Pose2<f64>, Measurement: Manifold<Scalar = f64, Dim: DimName>>,
        DefaultAllocator: UpdateAlloc<Const<3>, <S::Measurement as Manifold>::Dim>,
    {
        let pose = *self.robot.pose();
        let noise = sensor.noise(&pose);
        check_covariance("measurement noise", &noise)?;
        let mut jacobian = dynamic(&sensor.jacobian(&pose));
        jacobian.resize_horizontally_mut(RobotDim::<M>::DIM, 0.0);
        let residual = dynamic(&sensor.expected(&pose).local(measurement));
        self.correct_robot(jacobian, dynamic(&noise), residual, OutlierRule::Reject)
    }

    /// Gate and correction of both.
    fn correct_robot(
        &mut self,
        jacobian: DMatrix<f64>,
        noise: DMatrix<f64>,
        residual: DMatrix<f64>,
        outlier_rule: OutlierRule,
    ) -> Result<RobotInnovation, SlamError> {
        let what = "measurement of the robot";
        if !residual.iter().chain(jacobian.iter()).all(|entry| entry.is_finite()) {
            return Err(SlamError::NotFinite { what });
        }
        let covariance = &jacobian * dynamic(&self.robot_covariance()) * jacobian.transpose() + &noise;
        let Some(factor) = Cholesky::new(covariance.clone()) else {
            return Err(not_positive_definite(what, &covariance));
        };
        let nis = residual.dot(&factor.solve(&residual));
        let threshold = self.robot_gate(residual.len())?;
        if nis > threshold && outlier_rule == OutlierRule::Reject {
            return Err(SlamError::Outlier { nis, threshold });
        }
        let noise = noise * self.params.noise_scale(nis, threshold);
        if noise.amax() >= LARGEST_VARIANCE {
            return Err(SlamError::Outlier { nis, threshold }); // so far out that its weight would be zero
        }

        let mut rows = SparseJacobian::default();
        for row in jacobian.row_iter() {
            rows.push_row(row.iter().copied(), 0, []);
        }
        let residual = residual.column(0).into_owned();
        let step = self.covariance.correct(&rows, &noise, &residual).ok_or(SlamError::NotFinite { what })?;
        self.step(&step);
        Ok(RobotInnovation { nis, jacobian, covariance })
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

pub(super) fn dynamic<R: Dim, C: Dim>(matrix: &OMatrix<f64, R, C>) -> DMatrix<f64>
where
    DefaultAllocator: Allocator<R, C>,
{
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| matrix[(row, column)])
}
