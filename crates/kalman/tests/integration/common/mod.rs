//! Models that several tests share.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its models has failed")]

use nalgebra::{DMatrix, DVector, Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{LinearMotion, LinearSensor};

pub(crate) type TrackSensor<T> = LinearSensor<Vector4<T>, Vector2<T>>;

/// `(x, y, vx, vy)` at constant velocity, a step of 0.1 s, noise density `q` on the acceleration.
pub(crate) fn constant_velocity(q: f64) -> LinearMotion<f64, nalgebra::U4> {
    LinearMotion::new(transition(), discrete_acceleration_noise(q)).unwrap()
}

/// The position is seen with variance `r`.
pub(crate) fn position_sensor(r: f64) -> TrackSensor<f64> {
    LinearSensor::new(Matrix2x4::identity(), Matrix2::identity() * r).unwrap()
}

pub(crate) fn transition() -> Matrix4<f64> {
    let mut f = Matrix4::identity();
    f[(0, 2)] = 0.1;
    f[(1, 3)] = 0.1;
    f
}

/// The discretized white-noise acceleration of density `q`. [Bar-Shalom et al. 2001, Eq. 6.2.2-12]
pub(crate) fn discrete_acceleration_noise(q: f64) -> Matrix4<f64> {
    let dt: f64 = 0.1;
    let (a, b, c) = (q * dt.powi(3) / 3.0, q * dt.powi(2) / 2.0, q * dt);
    Matrix4::new(
        a, 0.0, b, 0.0, //
        0.0, a, 0.0, b, //
        b, 0.0, c, 0.0, //
        0.0, b, 0.0, c,
    )
}

pub(crate) fn track_prior(variance: f64) -> Gaussian<Vector4<f64>> {
    Gaussian::new(Vector4::zeros(), Matrix4::identity() * variance).unwrap()
}

/// The same models with sizes known at run time only.
pub(crate) fn dynamic(
    motion: &LinearMotion<f64, nalgebra::U4>,
    sensor: &TrackSensor<f64>,
) -> (LinearMotion<f64, nalgebra::Dyn>, LinearSensor<DVector<f64>, DVector<f64>>) {
    let matrix = |m: &[f64], rows, columns| DMatrix::from_column_slice(rows, columns, m);
    let motion = LinearMotion::new(
        matrix(motion.transition().as_slice(), 4, 4),
        matrix(motion.noise().as_slice(), 4, 4),
    );
    let sensor =
        LinearSensor::new(matrix(sensor.matrix().as_slice(), 2, 4), matrix(sensor.noise().as_slice(), 2, 2));
    (motion.unwrap(), sensor.unwrap())
}
