use nalgebra::{Const, Matrix2, Matrix3, RealField, Vector2, Vector3};

use crate::{Angle, LieGroup, Manifold, wrap_angle};

/// A planar rigid-body pose: metres and radians, x forward, y left (REP 103).
///
/// The retraction moves in the **body** frame, translation and rotation apart:
/// $`(t, θ) ⊞ (δ_x, δ_y, δ_θ) = (t + R(θ)(δ_x, δ_y)^T, θ + δ_θ)`$.
/// The group exponential, which drives along an arc, is [`LieGroup::exp`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: nalgebra::Scalar + serde::Serialize",
        deserialize = "T: RealField + Copy + serde::Deserialize<'de>"
    ))
)]
pub struct Pose2<T> {
    /// Position of the body's origin in the world, metres.
    pub translation: Vector2<T>,
    /// Heading of the body's x axis in the world.
    pub rotation: Angle<T>,
}

impl<T: RealField + Copy> Pose2<T> {
    /// The pose at `(x, y)` metres with heading `heading` radians.
    pub fn new(x: T, y: T, heading: T) -> Self {
        Self { translation: Vector2::new(x, y), rotation: Angle::new(heading) }
    }
    /// x of the position, metres.
    pub fn x(&self) -> T {
        self.translation.x
    }
    /// y of the position, metres.
    pub fn y(&self) -> T {
        self.translation.y
    }
    /// Heading in (−π, π].
    pub fn heading(&self) -> T {
        self.rotation.radians()
    }
    /// The 2×2 matrix that turns body vectors into world vectors.
    pub fn rotation_matrix(&self) -> Matrix2<T> {
        let (sin, cos) = self.heading().sin_cos();
        Matrix2::new(cos, -sin, sin, cos)
    }
    /// A point given in the body frame, in the world frame.
    pub fn transform(&self, body_point: &Vector2<T>) -> Vector2<T> {
        self.translation + self.rotation_matrix() * body_point
    }
    /// A point given in the world frame, in the body frame.
    pub fn inverse_transform(&self, world_point: &Vector2<T>) -> Vector2<T> {
        self.rotation_matrix().tr_mul(&(world_point - self.translation))
    }
    /// Whether every coordinate is a finite number.
    pub fn is_finite(&self) -> bool {
        self.x().is_finite() && self.y().is_finite() && self.heading().is_finite()
    }
}

impl<T: RealField + Copy> Manifold for Pose2<T> {
    type Scalar = T;
    type Dim = Const<3>;
    fn dim(&self) -> Const<3> {
        Const
    }
    fn retract(&self, delta: &Vector3<T>) -> Self {
        Self { translation: self.transform(&delta.xy()), rotation: Angle::new(self.heading() + delta.z) }
    }
    fn local(&self, other: &Self) -> Vector3<T> {
        let t = self.inverse_transform(&other.translation);
        Vector3::new(t.x, t.y, wrap_angle(other.heading() - self.heading()))
    }
    fn chart_jacobian(&self, at: &Self) -> Matrix3<T> {
        let r = Self::new(T::zero(), T::zero(), self.heading() - at.heading()).rotation_matrix();
        r.to_homogeneous()
    }
}

impl<T: RealField + Copy> LieGroup for Pose2<T> {
    fn identity() -> Self {
        Self::new(T::zero(), T::zero(), T::zero())
    }
    fn compose(&self, other: &Self) -> Self {
        Self {
            translation: self.transform(&other.translation),
            rotation: Angle::new(self.heading() + other.heading()),
        }
    }
    fn inverse(&self) -> Self {
        Self {
            translation: -self.rotation_matrix().tr_mul(&self.translation),
            rotation: Angle::new(-self.heading()),
        }
    }
    /// $`\exp(v, ω) = (V(ω) v, ω)`$ with
    /// $`V(ω) = \begin{pmatrix} \sin ω/ω & -(1-\cos ω)/ω \\ (1-\cos ω)/ω & \sin ω/ω \end{pmatrix}`$. [Solà et al. 2018, Eqs. 156-158]
    fn exp(tangent: &Vector3<T>) -> Self {
        Self { translation: arc_matrix(tangent.z) * tangent.xy(), rotation: Angle::new(tangent.z) }
    }
    fn log(&self) -> Vector3<T> {
        let heading = self.heading();
        let v = arc_matrix(heading);
        let (a, b) = (v[(0, 0)], v[(1, 0)]);
        // V is a scaled rotation, so its inverse is its transpose over a² + b² (not 0 for |ω| ≤ π).
        let t = v.tr_mul(&self.translation) / (a * a + b * b);
        Vector3::new(t.x, t.y, heading)
    }
    /// $`\mathrm{Ad} = \begin{pmatrix} R & (y, -x)^T \\ 0 & 1 \end{pmatrix}`$. [Solà et al. 2018, Eq. 159]
    fn adjoint(&self) -> Matrix3<T> {
        let r = self.rotation_matrix();
        let (zero, one) = (T::zero(), T::one());
        Matrix3::new(
            r.m11,
            r.m12,
            self.y(), //
            r.m21,
            r.m22,
            -self.x(), //
            zero,
            zero,
            one,
        )
    }
    /// $`\log g = (V^{-1} t, θ)`$, so that the columns are $`V^{-1} R`$ and $`(∂V^{-1}/∂θ)\, t`$, with
    /// $`V^{-1} = \begin{pmatrix} f & θ/2 \\ -θ/2 & f \end{pmatrix}`$, $`f = \tfrac{θ}{2} \cot \tfrac{θ}{2}`$.
    fn log_jacobian(&self) -> Matrix3<T> {
        let theta = self.heading();
        let half: T = nalgebra::convert(0.5);
        let v = arc_matrix(theta);
        let (a, b) = (v[(0, 0)], v[(1, 0)]);
        let inverse = v.transpose() / (a * a + b * b);
        // f' = (sin θ - θ) / (4 sin² θ/2); its series where that cancels.
        let half_sin = (theta * half).sin();
        let slope = if theta.abs() < T::default_epsilon().sqrt().sqrt() {
            -theta * nalgebra::convert(1.0 / 6.0)
        } else {
            (theta.sin() - theta) / (half_sin * half_sin * nalgebra::convert(4.0))
        };
        let mut jacobian = (inverse * self.rotation_matrix()).to_homogeneous();
        jacobian[(0, 2)] = slope * self.x() + half * self.y();
        jacobian[(1, 2)] = slope * self.y() - half * self.x();
        jacobian
    }
}

/// V(ω): where a unit body velocity ends after turning by ω on the way.
fn arc_matrix<T: RealField + Copy>(omega: T) -> Matrix2<T> {
    if omega == T::zero() {
        return Matrix2::identity();
    }
    let half: T = nalgebra::convert(0.5);
    let half_sin = (omega * half).sin();
    // 1 - cos ω = 2 sin² ω/2 keeps its digits near 0, where the difference loses them.
    let (a, b) = (omega.sin() / omega, half_sin * half_sin / (omega * half));
    Matrix2::new(a, -b, b, a)
}
