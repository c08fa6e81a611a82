//! A variable and a residual of your own: a robot that hears a beacon through a cable of unknown delay. Public API only.
//! `cargo run -p wayfix-smoother --example 01_custom_residual`

use nalgebra::{Const, Matrix1, Vector1, Vector2};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_smoother::{Graph, Kernel, Params, Residual, laws};

/// 1. The variable: a delay, kept positive by estimating its logarithm.
#[derive(Clone, Debug)]
struct Delay(f64);

impl Manifold for Delay {
    type Scalar = f64;
    type Dim = Const<1>;
    fn dim(&self) -> Const<1> {
        Const
    }
    fn retract(&self, delta: &Vector1<f64>) -> Self {
        Self(self.0 * delta.x.exp())
    }
    fn local(&self, other: &Self) -> Vector1<f64> {
        Vector1::new((other.0 / self.0).ln())
    }
}

/// 2. The residual: a time of flight in metres, to a beacon whose place is unknown too. Its Jacobians are central differences.
struct TimeOfFlight(f64);

impl Residual for TimeOfFlight {
    type Dim = Const<1>;
    type Variables = (Pose2<f64>, Vector2<f64>, Delay);
    fn value(&self, (robot, beacon, delay): (&Pose2<f64>, &Vector2<f64>, &Delay)) -> Vector1<f64> {
        Vector1::new((beacon - robot.translation).norm() + delay.0 - self.0)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    laws::residual(&TimeOfFlight(4.0), (&Pose2::new(1.0, 2.0, 3.0), &Vector2::new(4.0, 4.0), &Delay(0.5)))?;

    // 3. The robot is known at forty places on a circle; the beacon is at (3, 1), the delay 0.4 m. Every tenth time is an echo.
    let mut graph = Graph::new();
    let (beacon, delay) = (graph.add_variable(Vector2::new(2.0, 0.0)), graph.add_variable(Delay(1.0)));
    for i in 0..40 {
        let angle = 0.2 * f64::from(i);
        let robot = graph.add_variable(Pose2::new(angle.sin(), 1.0 - angle.cos(), angle));
        graph.fix(robot)?;
        let distance = (Vector2::new(3.0, 1.0) - graph.value(robot)?.translation).norm();
        let heard = TimeOfFlight(distance + 0.4 + if i % 10 == 5 { 5.0 } else { 0.0 });
        let id = graph.add(heard, (robot, beacon, delay), Matrix1::new(100.0))?;
        graph.set_kernel(id, Kernel::Cauchy { c: 2.385 })?;
    }
    graph.optimize(&Params::default())?;
    let (found, delay) = (graph.value(beacon)?, graph.value(delay)?.0);
    println!("beacon at {:.3?} m, delay {delay:.3} m", found.as_slice());
    assert!((found - Vector2::new(3.0, 1.0)).norm() < 0.1 && (delay - 0.4).abs() < 0.1);
    Ok(())
}
