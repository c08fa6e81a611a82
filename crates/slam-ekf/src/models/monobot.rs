use nalgebra::{DMatrix, Matrix1, Vector1};
use wayfix_estimation_traits::MotionModel;

use crate::{LandmarkModel, NewLandmark};

/// A robot on a line with a commanded displacement: $`x' = x + u + v`$ with $`σ_v = σ_0 + α |u|`$. [Andrade-Cetto 2005, Eq. 19]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MonobotMotion {
    /// $`σ_0`$, m.
    pub sigma: f64,
    /// $`α`$: standard deviation as a share of the commanded motion.
    pub sigma_per_meter: f64,
}

/// Landmarks on the line, measured by their signed distance: $`z = m - x + w`$ with $`σ_w = σ_0 + β |z|`$. [Andrade-Cetto 2005, Sec. 2.2]
///
/// ```
/// use nalgebra::Vector1;
/// use wayfix_slam_ekf::{EkfSlam, KnownIdAssociation, LandmarkId, LineDistanceSensor, Observation, SlamParams};
/// let sensor = LineDistanceSensor { sigma: 0.1, sigma_per_meter: 0.0 };
/// let mut slam = EkfSlam::new(sensor, SlamParams::default(), Vector1::new(-1.0))?;
/// slam.update(&[Observation { label: Some(LandmarkId(0)), measurement: Vector1::new(2.1) }], &mut KnownIdAssociation)?;
/// assert!((slam.landmark(LandmarkId(0)).expect("seen").mean.x - 1.1).abs() < 1e-12);
/// # Ok::<(), wayfix_slam_ekf::SlamError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct LineDistanceSensor {
    /// $`σ_0`$, m; above zero, or a landmark at the robot would be measured without error.
    pub sigma: f64,
    /// $`β`$: standard deviation as a share of the distance.
    pub sigma_per_meter: f64,
}

impl MotionModel for MonobotMotion {
    type State = Vector1<f64>;
    type Control = Vector1<f64>;

    fn propagate(&self, position: &Vector1<f64>, motion: &Vector1<f64>) -> Vector1<f64> {
        position + motion
    }
    fn jacobian(&self, _: &Vector1<f64>, _: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::identity()
    }
    fn noise(&self, _: &Vector1<f64>, motion: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::new((self.sigma + self.sigma_per_meter * motion.x.abs()).powi(2))
    }
}

impl LandmarkModel for LineDistanceSensor {
    type Robot = Vector1<f64>;
    type Landmark = Vector1<f64>;
    type Measurement = Vector1<f64>;

    fn expected(&self, robot: &Vector1<f64>, landmark: &Vector1<f64>) -> Vector1<f64> {
        landmark - robot
    }
    fn robot_jacobian(&self, _: &Vector1<f64>, _: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::new(-1.0)
    }
    fn landmark_jacobian(&self, _: &Vector1<f64>, _: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::identity()
    }
    fn noise(&self, distance: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::new((self.sigma + self.sigma_per_meter * distance.x.abs()).powi(2))
    }
    fn symmetries(&self) -> &'static [&'static str] {
        &["translation of everything"]
    }
    fn robot_symmetry(&self, _: &Vector1<f64>) -> DMatrix<f64> {
        DMatrix::identity(1, 1)
    }
    fn landmark_symmetry(&self, _: &Vector1<f64>) -> DMatrix<f64> {
        DMatrix::identity(1, 1)
    }
    fn initialize(
        &self,
        robot: &Vector1<f64>,
        distance: &Vector1<f64>,
    ) -> NewLandmark<Vector1<f64>, Vector1<f64>> {
        NewLandmark {
            landmark: robot + distance,
            robot_jacobian: Matrix1::identity(),
            covariance: self.noise(distance),
        }
    }
}
