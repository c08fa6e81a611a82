//! The suites on our own types: at the identity, far away, on both sides of the wrap.

use std::f64::consts::{PI, TAU};

use nalgebra::{DVector, SVector, UnitQuaternion, Vector3};
use wayfix_estimation_traits::{Angle, Pose2, Pose3, laws};

fn angles() -> Vec<Angle<f64>> {
    [0.0, 1.0, -2.0, PI, PI - 1e-9, -PI + 1e-9, 3.0, -3.0].map(Angle::new).to_vec()
}

fn poses() -> Vec<Pose2<f64>> {
    let parts = [
        (0.0, 0.0, 0.0),
        (1.0, -2.0, PI - 1e-9),
        (-3.0, 0.5, -PI + 1e-9),
        (200.0, -900.0, 1.5),
        (0.1, 0.2, PI),
    ];
    parts.map(|(x, y, heading)| Pose2::new(x, y, heading)).to_vec()
}

fn spatial_poses() -> Vec<Pose3<f64>> {
    let turn = |x, y, z| UnitQuaternion::from_scaled_axis(Vector3::new(x, y, z));
    let place = |x, y, z, rotation| Pose3 { translation: Vector3::new(x, y, z), rotation };
    vec![
        place(0.0, 0.0, 0.0, UnitQuaternion::identity()),
        place(1.0, -2.0, 3.0, turn(0.0, 0.0, 3.0)),
        place(-50.0, 20.0, 0.5, turn(-1.0, 2.0, -1.5)),
        place(0.1, 0.0, -0.3, turn(1e-5, -2e-5, 1e-6)),
    ]
}

#[test]
fn of_angles() {
    laws::manifold(&angles()).unwrap();
    laws::lie_group(&angles()).unwrap();
    laws::periodic(&angles(), 0, TAU).unwrap();
}

#[test]
fn of_planar_poses() {
    laws::manifold(&poses()).unwrap();
    laws::lie_group(&poses()).unwrap();
    laws::periodic(&poses(), 2, TAU).unwrap();
}

#[test]
fn of_spatial_poses() {
    laws::manifold(&spatial_poses()).unwrap();
    laws::lie_group(&spatial_poses()).unwrap();
    for axis in 3..6 {
        laws::periodic(&spatial_poses(), axis, TAU).unwrap();
    }
}

#[test]
fn of_vectors() {
    laws::manifold(&[SVector::<f64, 2>::zeros(), SVector::from([1e6, -1e6])]).unwrap();
    laws::manifold(&[DVector::zeros(5), DVector::from_vec(vec![1.0, -2.0, 3.0, 1e3, 0.0])]).unwrap();
}

#[test]
fn in_single_precision() {
    let pose = Pose2::<f32>::new;
    let planar = [pose(0.0, 0.0, 0.0), pose(1.0, -2.0, 3.1), pose(-3.0, 0.5, -3.1)];
    laws::manifold(&planar).unwrap();
    laws::lie_group(&planar).unwrap();
    let turned = UnitQuaternion::from_scaled_axis(Vector3::new(-1.0_f32, 2.0, -1.5));
    let spatial = Pose3 { translation: Vector3::new(1.0, 2.0, -3.0), rotation: turned };
    laws::manifold(&[spatial]).unwrap();
    laws::lie_group(&[spatial]).unwrap();
    laws::manifold(&[Angle::new(0.0_f32), Angle::new(3.1), Angle::new(-3.1)]).unwrap();
}
