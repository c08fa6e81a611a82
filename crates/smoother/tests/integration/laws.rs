//! Our residuals keep the laws, and the suite catches those that break them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use nalgebra::{Const, Matrix1, UnitQuaternion, Vector1, Vector2, Vector3};
use wayfix_estimation_traits::{Angle, LieGroup, Pose2, Pose3};
use wayfix_smoother::{Between, Prior, RelativePosition, Residual, laws};

fn planar() -> Vec<Pose2<f64>> {
    vec![
        Pose2::identity(),
        Pose2::new(1.0, -2.0, 1e-8),
        Pose2::new(3.0, 1.0, 3.1),
        Pose2::new(-2.0, 4.0, -3.1),
        Pose2::new(0.5, 0.5, -1e-3),
    ]
}

fn spatial() -> Vec<Pose3<f64>> {
    [[0.0, 0.0, 0.0], [1e-8, -1e-8, 0.0], [0.05, -0.02, 0.03], [1.0, -1.2, 0.5], [-2.0, 1.5, 1.0]]
        .iter()
        .enumerate()
        .map(|(i, axis)| Pose3 {
            translation: Vector3::new(i as f64, -2.0 * i as f64, 0.5),
            rotation: UnitQuaternion::from_scaled_axis(Vector3::from_row_slice(axis)),
        })
        .collect()
}

#[test]
fn residuals_between_poses_keep_the_laws() {
    for (a, b, z) in triples(&planar()) {
        laws::residual(&Between::new(z), (&a, &b)).unwrap();
        laws::residual(&Prior::new(z), (&a,)).unwrap();
    }
    for (a, b, z) in triples(&spatial()) {
        laws::residual(&Between::new(z), (&a, &b)).unwrap();
        laws::residual(&Prior::new(z), (&a,)).unwrap();
    }
    laws::residual(&Between::new(Angle::new(-3.0)), (&Angle::new(2.0), &Angle::new(-2.5))).unwrap();
}

#[test]
fn residuals_of_landmarks_keep_the_laws() {
    for pose in planar() {
        let seen = RelativePosition { measured: Vector2::new(1.0, 2.0) };
        laws::residual(&seen, (&pose, &Vector2::new(-3.0, 0.5))).unwrap();
    }
    for pose in spatial() {
        let seen = RelativePosition { measured: Vector3::new(1.0, 2.0, 3.0) };
        laws::residual(&seen, (&pose, &Vector3::new(-3.0, 0.5, 1.0))).unwrap();
    }
}

#[test]
fn wrong_sign_and_nan_are_caught() {
    for factor in [-1.0, 1.01, f64::NAN] {
        let violation = laws::residual(&Square { factor }, (&Vector1::new(0.7),)).unwrap_err();
        assert!(violation.law.contains("Jacobians"), "{violation}");
    }
    laws::residual(&Square { factor: 1.0 }, (&Vector1::new(0.7),)).unwrap();
    let violation = laws::residual(&Square { factor: 1.0 }, (&Vector1::new(f64::NAN),)).unwrap_err();
    assert!(violation.law.contains("finite"), "{violation}");
}

/// $`x^2`$ with a Jacobian that is wrong by a factor.
struct Square {
    factor: f64,
}
impl Residual for Square {
    type Dim = Const<1>;
    type Variables = (Vector1<f64>,);
    fn value(&self, (x,): (&Vector1<f64>,)) -> Vector1<f64> {
        Vector1::new(x.x * x.x)
    }
    fn jacobians(&self, (x,): (&Vector1<f64>,)) -> (Matrix1<f64>,) {
        (Matrix1::new(2.0 * x.x * self.factor),)
    }
}

fn triples<G: Copy>(poses: &[G]) -> Vec<(G, G, G)> {
    let pairs = poses.iter().flat_map(|a| poses.iter().map(move |b| (*a, *b)));
    pairs.flat_map(|(a, b)| poses.iter().map(move |c| (a, b, *c))).collect()
}
