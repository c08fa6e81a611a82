use std::fmt;

use nalgebra::{DMatrix, DefaultAllocator, DimName, OVector, allocator::Allocator};
use wayfix_estimation_traits::{Jacobian, Manifold, TangentMatrix, numerical_jacobian};

use crate::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};

/// The identity of a landmark in the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct LandmarkId(pub u32);

impl fmt::Display for LandmarkId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// One measurement of one landmark, with its identity where the sensor reads one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation<Z> {
    /// The identity that the sensor reads.
    pub label: Option<LandmarkId>,
    /// The measurement.
    pub measurement: Z,
}

/// A kind of landmark and its measurement model: the one trait to implement for a new kind.
///
/// $`z = h(x_r, m) ⊞ v,\; v ∼ N(0, R)`$, and backwards $`m = g(x_r, z)`$. [Andrade-Cetto 2005, Eq. 2]
///
/// **Laws**: the Jacobians are the derivatives of [`expected`](Self::expected) in tangent coordinates (body frame for the robot);
/// [`noise`](Self::noise) is symmetric positive definite; `expected(robot, initialize(robot, z).landmark)` is `z` for every `z` of the
/// sensor. [`laws::landmark_model`](crate::laws::landmark_model) checks them. Where a model is undefined (a bearing to the robot's own position) it returns
/// non-finite numbers, and the filter counts the observation as rejected.
pub trait LandmarkModel
where
    DefaultAllocator: SlamAlloc<RobotDim<Self>, LandmarkDim<Self>, MeasurementDim<Self>>,
{
    /// The robot state: `Pose2`, or more.
    type Robot: Manifold<Scalar = f64, Dim: DimName> + fmt::Debug;
    /// The landmark state: `Vector2` for points.
    type Landmark: Manifold<Scalar = f64, Dim: DimName> + fmt::Debug;
    /// The measurement.
    type Measurement: Manifold<Scalar = f64, Dim: DimName> + fmt::Debug;

    /// $`h(x_r, m)`$: the expected measurement.
    fn expected(&self, robot: &Self::Robot, landmark: &Self::Landmark) -> Self::Measurement;

    /// $`∂h/∂x_r`$. By default a central difference.
    fn robot_jacobian(
        &self,
        robot: &Self::Robot,
        landmark: &Self::Landmark,
    ) -> Jacobian<Self::Measurement, Self::Robot> {
        numerical_jacobian(|robot| self.expected(robot, landmark), robot)
    }

    /// $`∂h/∂m`$. By default a central difference.
    fn landmark_jacobian(
        &self,
        robot: &Self::Robot,
        landmark: &Self::Landmark,
    ) -> Jacobian<Self::Measurement, Self::Landmark> {
        numerical_jacobian(|landmark| self.expected(robot, landmark), landmark)
    }

    /// $`R`$ at a measurement; it may depend on the measured distance.
    fn noise(&self, measurement: &Self::Measurement) -> TangentMatrix<Self::Measurement>;

    /// Covariance of a measurement for data association only. By default [`noise`](Self::noise), which may be inflated to account for
    /// time-correlated errors.
    fn association_noise(&self, measurement: &Self::Measurement) -> TangentMatrix<Self::Measurement> {
        self.noise(measurement)
    }

    /// The noise of a measurement, moved from the tangent space of the measurement to that of the expected one. The two differ only if a
    /// measurement has two forms, as a line has.
    fn noise_at_expected(
        &self,
        _expected: &Self::Measurement,
        _measurement: &Self::Measurement,
        noise: &TangentMatrix<Self::Measurement>,
    ) -> TangentMatrix<Self::Measurement> {
        noise.clone()
    }

    /// Cross-covariance of the errors of two measurements in one scan, a part of their association noise. By default zero.
    ///
    /// **Law**: the joint covariance of a scan, with this in its off-diagonal blocks, is positive definite.
    fn common_noise(
        &self,
        _a: &Self::Measurement,
        _b: &Self::Measurement,
    ) -> TangentMatrix<Self::Measurement> {
        TangentMatrix::<Self::Measurement>::zeros()
    }

    /// Whether the measurement can be used at all. By default: whether it is finite.
    fn is_usable(&self, measurement: &Self::Measurement) -> bool {
        measurement.local(measurement).iter().all(|entry| entry.is_finite())
    }

    /// Whether a landmark with the prediction `expected` is compatible with the measurement in attributes that are not estimated: the extent
    /// of a wall, a colour. Used by data association. By default: always.
    fn is_compatible(&self, _expected: &Self::Measurement, _measurement: &Self::Measurement) -> bool {
        true
    }

    /// The landmark with the attributes that are not estimated updated by a measurement: the ends of a wall. Its estimated coordinates must
    /// not change. By default: unchanged.
    fn extended(
        &self,
        _robot: &Self::Robot,
        landmark: &Self::Landmark,
        _measurement: &Self::Measurement,
    ) -> Self::Landmark {
        landmark.clone()
    }

    /// Whether a landmark with this prediction is within range and field of view, so that a missing detection counts as a miss. By default: always.
    fn expects_detection(&self, _expected: &Self::Measurement) -> bool {
        true
    }

    /// Names of the joint motions of robot and map that change no measurement, such as "translation along x".
    ///
    /// None by default: then only the standard linearization is available, and the observability toolbox names no direction.
    fn symmetries(&self) -> &'static [&'static str] {
        &[]
    }

    /// $`g_r`$: motion of the robot in its tangent space when the world moves, one column per symmetry, per m or rad.
    ///
    /// **Law**: $`∂h/∂x_r \, g_r + ∂h/∂m \, g_m = 0`$, and the columns are independent.
    fn robot_symmetry(&self, _robot: &Self::Robot) -> DMatrix<f64> {
        DMatrix::zeros(RobotDim::<Self>::DIM, 0)
    }

    /// $`g_m`$: the same of a landmark.
    fn landmark_symmetry(&self, _landmark: &Self::Landmark) -> DMatrix<f64> {
        DMatrix::zeros(LandmarkDim::<Self>::DIM, 0)
    }

    /// $`g(x_r, z)`$: a landmark from its first measurement.
    fn initialize(
        &self,
        robot: &Self::Robot,
        measurement: &Self::Measurement,
    ) -> NewLandmark<Self::Landmark, Self::Robot>;
}

/// A new landmark: its position given the robot, and the derivative with respect to the robot.
///
/// $`m = g(x_r, z)`$, $`P_{mm} = G_r P_{rr} G_r^T + N`$, $`P_{mr} = G_r P_{rr}`$.
#[derive(Clone, Debug)]
pub struct NewLandmark<L: Manifold<Scalar = f64>, X: Manifold<Scalar = f64>>
where
    DefaultAllocator: Allocator<L::Dim, X::Dim> + Allocator<L::Dim, L::Dim>,
{
    /// $`g(x_r, z)`$.
    pub landmark: L,
    /// $`G_r = ∂g/∂x_r`$.
    pub robot_jacobian: Jacobian<L, X>,
    /// $`N`$: covariance of the landmark given the robot. $`G_z R G_z^T`$ if one measurement determines the landmark; larger in the
    /// directions that a single measurement does not determine.
    pub covariance: TangentMatrix<L>,
}

/// The innovation of a measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Innovation<Z: Manifold<Scalar = f64>>
where
    DefaultAllocator: Allocator<Z::Dim> + Allocator<Z::Dim, Z::Dim>,
{
    /// $`ν = z ⊟ h(x)`$.
    pub residual: OVector<f64, Z::Dim>,
    /// $`S = H P H^T + R`$.
    pub covariance: TangentMatrix<Z>,
    /// Normalized innovation squared, $`ν^T S^{-1} ν`$: chi-squared with `dim Z` degrees of freedom for a consistent filter.
    pub nis: f64,
}
