//! A state of your own: a robot arm's wrist that points somewhere, with a gripper that opens. Public API only.
//!
//! `cargo run -p wayfix-estimation-traits --example 02_custom_state`

use nalgebra::{Const, Matrix3, Unit, UnitQuaternion, Vector3};
use wayfix_estimation_traits::{Manifold, MotionModel, laws};

/// 1. The state: a direction on the unit sphere and an opening in metres. Three numbers move it, four describe it.
#[derive(Clone, Debug)]
struct Wrist {
    direction: Unit<Vector3<f64>>,
    opening: f64,
}

impl Wrist {
    /// Columns: two directions that span the plane touching the sphere here, and the direction itself. [Duff et al. 2017]
    ///
    /// `rotation_between_axis` from the z axis looks simpler; the suite rejects it, since within 1e-8 of the axis it says "no rotation".
    fn frame(&self) -> Matrix3<f64> {
        let n = self.direction;
        let sign = 1.0_f64.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        let first = Vector3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        let second = Vector3::new(b, sign + n.y * n.y * a, -n.y);
        Matrix3::from_columns(&[first, second, n.into_inner()])
    }
}

/// 2. How it moves: along a great circle, and straight.
impl Manifold for Wrist {
    type Scalar = f64;
    type Dim = Const<3>;
    fn dim(&self) -> Const<3> {
        Const
    }
    fn retract(&self, delta: &Vector3<f64>) -> Self {
        let angle = delta.xy().norm();
        // sin(angle) / angle, whose limit at 0 is 1.
        let sinc = if angle > 0.0 { angle.sin() / angle } else { 1.0 };
        let moved = self.frame() * Vector3::new(delta.x * sinc, delta.y * sinc, angle.cos());
        Self { direction: Unit::new_normalize(moved), opening: self.opening + delta.z }
    }
    fn local(&self, other: &Self) -> Vector3<f64> {
        let seen = self.frame().tr_mul(&other.direction);
        let sine = seen.xy().norm();
        let stretch = if sine > 0.0 { sine.atan2(seen.z) / sine } else { 1.0 };
        Vector3::new(seen.x * stretch, seen.y * stretch, other.opening - self.opening)
    }
}

/// 3. A model that drives it; its Jacobian is left to the central difference of the trait.
struct Turn;

impl MotionModel for Turn {
    type State = Wrist;
    type Control = Vector3<f64>;
    fn propagate(&self, state: &Wrist, control: &Vector3<f64>) -> Wrist {
        let turned = UnitQuaternion::from_scaled_axis(*control) * state.direction;
        Wrist { direction: Unit::new_normalize(turned.into_inner()), opening: 0.9 * state.opening }
    }
    fn noise(&self, _: &Wrist, _: &Vector3<f64>) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 0.0)) // the gripper is exact
    }
}

fn main() -> Result<(), laws::LawViolation> {
    let wrist = |x, y, z, opening| Wrist { direction: Unit::new_normalize(Vector3::new(x, y, z)), opening };

    // 4. The laws, at the pole, elsewhere, and near the pole where the frame turns over.
    let states = [wrist(0.0, 0.0, 1.0, 0.0), wrist(1.0, -2.0, 0.5, 0.05), wrist(0.3, 0.1, -1.0, 0.08)];
    laws::manifold(&states)?;

    // 5. And of the model.
    let control = Vector3::new(0.3, -0.2, 0.1);
    laws::motion(&Turn, &states.map(|state| (state, &control)))?;

    println!(
        "a wrist is a manifold of dimension 3, and Turn a motion model: every filter of Wayfix takes them"
    );
    Ok(())
}
