use nalgebra::{Const, Matrix1, RealField, Vector1};

use crate::{LieGroup, Manifold, Tangent, TangentMatrix};

/// Brings an angle into (−π, π].
///
/// NaN and infinities give NaN.
///
/// ```
/// use std::f64::consts::PI;
/// assert_eq!(wayfix_estimation_traits::wrap_angle(-PI), PI);
/// assert!((wayfix_estimation_traits::wrap_angle(7.0) - (7.0 - 2.0 * PI)).abs() < 1e-15);
/// ```
pub fn wrap_angle<T: RealField + Copy>(angle: T) -> T {
    if angle > -T::pi() && angle <= T::pi() {
        return angle;
    }
    let wrapped = angle - T::two_pi() * ((angle - T::pi()) / T::two_pi()).ceil();
    if wrapped > -T::pi() && wrapped <= T::pi() {
        return wrapped;
    }
    // Rounding lands a hair outside, or anywhere for angles of millions of turns, which sine and cosine reduce exactly.
    let (sin, cos) = angle.sin_cos();
    let direction = sin.atan2(cos);
    if direction <= -T::pi() { T::pi() } else { direction }
}

/// A direction in the plane, kept in (−π, π]; differences wrap by construction.
///
/// ```
/// use wayfix_estimation_traits::{Angle, Manifold};
/// let almost_pi = Angle::new(3.1);
/// let beyond_pi = Angle::new(-3.1);
/// assert!((almost_pi.local(&beyond_pi)[0] - (2.0 * std::f64::consts::PI - 6.2)).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(transparent))]
pub struct Angle<T>(T);

impl<T: RealField + Copy> Angle<T> {
    /// The direction `radians`, wrapped into (−π, π].
    pub fn new(radians: T) -> Self {
        Self(wrap_angle(radians))
    }
    /// The value in (−π, π].
    pub fn radians(self) -> T {
        self.0
    }
}

/// A stored number is wrapped like any other, so that no file makes an angle outside (−π, π].
#[cfg(feature = "serde")]
impl<'de, T: RealField + Copy + serde::Deserialize<'de>> serde::Deserialize<'de> for Angle<T> {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::new)
    }
}

impl<T: RealField + Copy> Manifold for Angle<T> {
    type Scalar = T;
    type Dim = Const<1>;
    fn dim(&self) -> Const<1> {
        Const
    }
    fn retract(&self, delta: &Vector1<T>) -> Self {
        Self::new(self.0 + delta.x)
    }
    fn local(&self, other: &Self) -> Vector1<T> {
        Vector1::new(wrap_angle(other.0 - self.0))
    }
    fn chart_jacobian(&self, _: &Self) -> Matrix1<T> {
        Matrix1::identity()
    }
}

impl<T: RealField + Copy> LieGroup for Angle<T> {
    fn identity() -> Self {
        Self(T::zero())
    }
    fn compose(&self, other: &Self) -> Self {
        Self::new(self.0 + other.0)
    }
    fn inverse(&self) -> Self {
        Self::new(-self.0)
    }
    fn exp(tangent: &Tangent<Self>) -> Self {
        Self::new(tangent.x)
    }
    fn log(&self) -> Tangent<Self> {
        Vector1::new(self.0)
    }
    fn adjoint(&self) -> TangentMatrix<Self> {
        TangentMatrix::<Self>::identity()
    }
    fn log_jacobian(&self) -> TangentMatrix<Self> {
        TangentMatrix::<Self>::identity()
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn wraps_into_the_half_open_interval() {
        for k in -1000..=1000 {
            let angle = f64::from(k) * 0.37;
            let wrapped = wrap_angle(angle);
            assert!(wrapped > -PI && wrapped <= PI, "{angle} wrapped to {wrapped}");
            assert_abs_diff_eq!(wrapped.sin(), angle.sin(), epsilon = 1e-12);
            assert_abs_diff_eq!(wrapped.cos(), angle.cos(), epsilon = 1e-12);
        }
        assert_eq!(wrap_angle(-PI), PI);
        for odd in [3.0, -3.0, 5.0, -7.0] {
            // The product is not exactly an odd multiple of π, so either end is right.
            assert_abs_diff_eq!(wrap_angle(odd * PI).abs(), PI, epsilon = 1e-14);
        }
        for huge in [1e6, -1e16, 1e300, f64::MAX, f64::MIN] {
            let wrapped = wrap_angle(huge);
            assert!(wrapped > -PI && wrapped <= PI, "{huge} wrapped to {wrapped}");
        }
        assert!(wrap_angle(f64::NAN).is_nan() && wrap_angle(f64::INFINITY).is_nan());
    }
}
