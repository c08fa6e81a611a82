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
    /// What was measured.
    pub measurement: Z,
}

/// A kind of landmark and how a sensor sees it: the one trait to implement for a new kind.
///
/// $`z = h(x_r, m) ⊞ v,\; v ∼ N(0, R)`$, and backwards $`m = g(x_r, z)`$.
///
/// **Laws**: the Jacobians are the derivatives of [`expected`](Self::expected) in tangent coordinates (body frame for the robot);
/// [`noise`](Self::noise) is symmetric positive definite; `expected(robot, initialize(robot, z).landmark)` is `z` for every `z` the sensor can
/// give; [`laws::landmark_model`](crate::laws::landmark_model) checks them. Where a model is undefined (a bearing to where the robot stands) it returns non-finite numbers and the filter counts the
/// observation as rejected.
pub trait LandmarkModel
where
    DefaultAllocator: SlamAlloc<RobotDim<Self>, LandmarkDim<Self>, MeasurementDim<Self>>,
{
    /// What is estimated of the robot: `Pose2`, or more.
    type Robot: Manifold<Scalar = f64, Dim: DimName> + fmt::Debug;
    /// What is in the map: `Vector2` for points.
    type Landmark: Manifold<Scalar = f64, Dim: DimName> + fmt::Debug;
    /// What the sensor gives.
    type Measurement: Manifold<Scalar = f64, Dim: DimName> + fmt::Debug;

    /// $`h(x_r, m)`$: the measurement to expect.
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

    /// $`R`$ at a measurement, where it grows with distance.
    fn noise(&self, measurement: &Self::Measurement) -> TangentMatrix<Self::Measurement>;

    /// Covariance of a measurement where it only tells landmarks apart. By default [`noise`](Self::noise), which some robots inflate to correct no more
    /// than their errors, which hang together in time, allow.
    fn association_noise(&self, measurement: &Self::Measurement) -> TangentMatrix<Self::Measurement> {
        self.noise(measurement)
    }

    /// The noise of a measurement, given in the tangent space of the measurement, in that of what is expected: the same unless one thing
    /// has two forms, as a line has.
    fn noise_at_expected(
        &self,
        _expected: &Self::Measurement,
        _measurement: &Self::Measurement,
        noise: &TangentMatrix<Self::Measurement>,
    ) -> TangentMatrix<Self::Measurement> {
        noise.clone()
    }

    /// Covariance of what two measurements of one look err together, a share of their association noise. By default nothing.
    ///
    /// **Law**: the joint covariance of a look, with this off its diagonal blocks, is positive definite.
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

    /// Whether the landmark that should look like `expected` can be what was measured, beyond what the estimated coordinates tell: the stretch
    /// of a wall, a colour. Association asks. By default: always.
    fn is_compatible(&self, _expected: &Self::Measurement, _measurement: &Self::Measurement) -> bool {
        true
    }

    /// The landmark after a look at it, with what the look tells beyond the estimated coordinates: the ends of a wall. It must be at the
    /// same place. By default: as it was.
    fn extended(
        &self,
        _robot: &Self::Robot,
        landmark: &Self::Landmark,
        _measurement: &Self::Measurement,
    ) -> Self::Landmark {
        landmark.clone()
    }

    /// Whether a landmark that should look like this is within reach and view, so that not seeing it means something. By default: always.
    fn expects_detection(&self, _expected: &Self::Measurement) -> bool {
        true
    }

    /// Names of the ways to move robot and map together that no measurement can see, such as "translation along x".
    ///
    /// None by default: then there is only the standard filter, and the observability toolbox names nothing.
    fn symmetries(&self) -> &'static [&'static str] {
        &[]
    }

    /// $`g_r`$: how the robot moves in its tangent space when the world moves, one column a symmetry, per metre or radian.
    ///
    /// **Law**: $`∂h/∂x_r \, g_r + ∂h/∂m \, g_m = 0`$, and the columns are independent.
    fn robot_symmetry(&self, _robot: &Self::Robot) -> DMatrix<f64> {
        DMatrix::zeros(RobotDim::<Self>::DIM, 0)
    }

    /// $`g_m`$: how a landmark moves with it.
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

/// A landmark at its start: where it is given the robot, and how that depends on the robot.
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
    /// $`N`$: covariance of the landmark were the robot known. $`G_z R G_z^T`$ for a sensor that fixes the landmark at once; wider in
    /// the directions a single measurement leaves open.
    pub covariance: TangentMatrix<L>,
}

/// What a measurement said beyond what was expected.
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
