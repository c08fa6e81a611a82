use nalgebra::{Const, Matrix3, Matrix6, RealField, UnitQuaternion, Vector3, Vector6};

use crate::{LieGroup, Manifold};

/// A spatial rigid-body pose: metres and a unit quaternion, x forward, y left, z up (REP 103).
///
/// Tangent order `(x, y, z, rx, ry, rz)` in the **body** frame; the retraction moves translation and rotation apart:
/// $`(t, R) ⊞ (δ_t, δ_r) = (t + R δ_t, R \exp(δ_r))`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose3<T: RealField + Copy> {
    /// Position of the body's origin in the world, metres.
    pub translation: Vector3<T>,
    /// Rotation from the body frame to the world frame.
    pub rotation: UnitQuaternion<T>,
}

impl<T: RealField + Copy> Manifold for Pose3<T> {
    type Scalar = T;
    type Dim = Const<6>;
    fn dim(&self) -> Const<6> {
        Const
    }
    fn retract(&self, delta: &Vector6<T>) -> Self {
        let (t, r) = split(delta);
        Self {
            translation: self.translation + self.rotation * t,
            rotation: renormalized(self.rotation * UnitQuaternion::from_scaled_axis(r)),
        }
    }
    fn local(&self, other: &Self) -> Vector6<T> {
        let t = self.rotation.inverse() * (other.translation - self.translation);
        join(&t, &scaled_axis(&(self.rotation.inverse() * other.rotation)))
    }
    /// $`\begin{pmatrix} R_y^T R_x & 0 \\ 0 & J_r^{-1}(\log R_y^T R_x) \end{pmatrix}`$
    fn chart_jacobian(&self, at: &Self) -> Matrix6<T> {
        let relative = at.rotation.inverse() * self.rotation;
        let mut jacobian = Matrix6::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(relative.to_rotation_matrix().matrix());
        // The right Jacobian is the left one of the opposite rotation. [Solà et al. 2018, Eq. 76]
        jacobian.fixed_view_mut::<3, 3>(3, 3).copy_from(&left_jacobian_inverse(&-scaled_axis(&relative)));
        jacobian
    }
}

impl<T: RealField + Copy> LieGroup for Pose3<T> {
    fn identity() -> Self {
        Self { translation: Vector3::zeros(), rotation: UnitQuaternion::identity() }
    }
    fn compose(&self, other: &Self) -> Self {
        Self {
            translation: self.translation + self.rotation * other.translation,
            rotation: renormalized(self.rotation * other.rotation),
        }
    }
    fn inverse(&self) -> Self {
        let rotation = self.rotation.inverse();
        Self { translation: -(rotation * self.translation), rotation }
    }
    /// $`\exp(v, ω) = (V(ω) v, \exp ω)`$, [Solà et al. 2018, Eqs. 172-174].
    fn exp(tangent: &Vector6<T>) -> Self {
        let (t, r) = split(tangent);
        Self { translation: left_jacobian(&r) * t, rotation: UnitQuaternion::from_scaled_axis(r) }
    }
    fn log(&self) -> Vector6<T> {
        let r = scaled_axis(&self.rotation);
        join(&(left_jacobian_inverse(&r) * self.translation), &r)
    }
    /// $`\mathrm{Ad} = \begin{pmatrix} R & [t]_× R \\ 0 & R \end{pmatrix}`$. [Solà et al. 2018, Eq. 175]
    fn adjoint(&self) -> Matrix6<T> {
        let r = self.rotation.to_rotation_matrix().into_inner();
        let mut adjoint = Matrix6::zeros();
        adjoint.fixed_view_mut::<3, 3>(0, 0).copy_from(&r);
        adjoint.fixed_view_mut::<3, 3>(3, 3).copy_from(&r);
        adjoint.fixed_view_mut::<3, 3>(0, 3).copy_from(&(self.translation.cross_matrix() * r));
        adjoint
    }
    /// $`\log g = (V^{-1}(ω) t, ω)`$, so that the blocks are $`V^{-1} R = J_r^{-1}`$, 0, $`(∂V^{-1} t/∂ω)\, J_r^{-1}`$ and $`J_r^{-1}`$.
    fn log_jacobian(&self) -> Matrix6<T> {
        let r = scaled_axis(&self.rotation);
        let right = left_jacobian_inverse(&-r);
        let mut jacobian = Matrix6::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&right);
        jacobian.fixed_view_mut::<3, 3>(3, 3).copy_from(&right);
        let turned = left_jacobian_inverse_derivative(&r, &self.translation) * right;
        jacobian.fixed_view_mut::<3, 3>(0, 3).copy_from(&turned);
        jacobian
    }
}

fn split<T: RealField + Copy>(v: &Vector6<T>) -> (Vector3<T>, Vector3<T>) {
    (v.fixed_rows::<3>(0).into_owned(), v.fixed_rows::<3>(3).into_owned())
}

fn join<T: RealField + Copy>(t: &Vector3<T>, r: &Vector3<T>) -> Vector6<T> {
    Vector6::new(t.x, t.y, t.z, r.x, r.y, r.z)
}

/// Products of unit quaternions drift off the unit sphere by rounding; one Newton step brings them back.
fn renormalized<T: RealField + Copy>(mut q: UnitQuaternion<T>) -> UnitQuaternion<T> {
    q.renormalize_fast();
    q
}

/// The rotation vector with angle in [0, π], accurate for small angles too (an `acos` of the scalar part is not).
fn scaled_axis<T: RealField + Copy>(q: &UnitQuaternion<T>) -> Vector3<T> {
    let two: T = nalgebra::convert(2.0);
    let (w, v) = if q.w < T::zero() { (-q.w, -q.imag()) } else { (q.w, q.imag()) };
    let norm = v.norm();
    if norm < T::default_epsilon() { v * two } else { v * (two * norm.atan2(w) / norm) }
}

/// V(ω) of the exponential; its series where the closed form cancels.
fn left_jacobian<T: RealField + Copy>(r: &Vector3<T>) -> Matrix3<T> {
    let angle = r.norm();
    let half: T = nalgebra::convert(0.5);
    let (a, b): (T, T) = if angle < T::default_epsilon().sqrt().sqrt() {
        (half - angle * angle * nalgebra::convert(1.0 / 24.0), nalgebra::convert(1.0 / 6.0))
    } else {
        // 1 - cos θ = 2 sin² θ/2 keeps its digits where the difference loses them.
        let half_sinc = (angle * half).sin() / angle;
        (half_sinc * half_sinc * nalgebra::convert(2.0), (angle - angle.sin()) / (angle * angle * angle))
    };
    let cross = r.cross_matrix();
    Matrix3::identity() + cross * a + cross * cross * b
}

fn left_jacobian_inverse<T: RealField + Copy>(r: &Vector3<T>) -> Matrix3<T> {
    let angle = r.norm();
    let half: T = nalgebra::convert(0.5);
    let c: T = if angle < T::default_epsilon().sqrt().sqrt() {
        nalgebra::convert(1.0 / 12.0)
    } else {
        let half_angle = angle * half;
        (T::one() - half_angle * half_angle.cos() / half_angle.sin()) / (angle * angle)
    };
    let cross = r.cross_matrix();
    Matrix3::identity() - cross * half + cross * cross * c
}

/// $`∂\big(V^{-1}(ω)\, t\big)/∂ω`$ of $`V^{-1}(ω)\, t = t - \tfrac12 ω × t + c(θ)\, ω × (ω × t)`$, $`θ = |ω|`$.
fn left_jacobian_inverse_derivative<T: RealField + Copy>(r: &Vector3<T>, t: &Vector3<T>) -> Matrix3<T> {
    let half: T = nalgebra::convert(0.5);
    let angle = r.norm();
    let square = angle * angle;
    // c = (1 - f) / θ² with f = θ/2 cot θ/2, and its slope c'/θ.
    let (c, slope): (T, T) = if angle < nalgebra::convert(0.1) {
        let polynomial = |terms: [f64; 4]| {
            terms.iter().rev().fold(T::zero(), |sum, term| sum * square + nalgebra::convert(*term))
        };
        (polynomial(C_SERIES), polynomial(C_SLOPE_SERIES))
    } else {
        let half_sin = (angle * half).sin();
        let f = angle * half * (angle * half).cos() / half_sin;
        let f_slope = (angle.sin() - angle) / (half_sin * half_sin * nalgebra::convert(4.0));
        let c = (T::one() - f) / square;
        (c, (-f_slope / angle - c - c) / square)
    };
    let double_cross = r * r.dot(t) - t * square;
    let derivative = Matrix3::identity() * r.dot(t) + r * t.transpose()
        - t * r.transpose() * nalgebra::convert::<f64, T>(2.0);
    t.cross_matrix() * half + derivative * c + double_cross * r.transpose() * slope
}

/// Taylor coefficients of c in θ²: $`|B_{2k}|/(2k)!`$ from k = 1.
const C_SERIES: [f64; 4] = [1.0 / 12.0, 1.0 / 720.0, 1.0 / 30_240.0, 1.0 / 1_209_600.0];
/// Those of c'/θ.
const C_SLOPE_SERIES: [f64; 4] = [2.0 / 720.0, 4.0 / 30_240.0, 6.0 / 1_209_600.0, 8.0 / 47_900_160.0];
