//! A motion model and a sensor of your own, in any form, through the public interface only.
//!
//! A bicycle on the plane, steered by speed and steering angle, that sees where two lighthouses stand.
//! `cargo run -p wayfix-kalman --example 02_custom_motion_model`

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Manifold, MotionModel, Pose2, SensorModel};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, GaussianFilter, IteratedExtendedKalmanAlgorithm, KalmanAlgorithm, KalmanError,
    SquareRootKalmanAlgorithm, UnscentedKalmanAlgorithm,
};

/// Rolls without slip; the wheelbase is in metres.
struct Bicycle {
    wheelbase: f64,
}

/// What the rider does for `seconds`.
struct Ride {
    speed: f64,
    steering: f64,
    seconds: f64,
}

impl MotionModel for Bicycle {
    type State = Pose2<f64>;
    type Control = Ride;

    fn propagate(&self, pose: &Pose2<f64>, ride: &Ride) -> Pose2<f64> {
        let distance = ride.speed * ride.seconds;
        let turn = distance * ride.steering.tan() / self.wheelbase;
        pose.compose(&Pose2::exp(&Vector3::new(distance, 0.0, turn)))
    }

    fn noise(&self, _: &Pose2<f64>, ride: &Ride) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(4e-4, 1e-5, 4e-4)) * ride.seconds
    }
    // No Jacobian: the default is numerical, and the unscented form needs none.
}

/// Where a lighthouse stands in the body frame, metres ahead and to the left.
struct Lighthouse(Vector2<f64>);

impl SensorModel for Lighthouse {
    type State = Pose2<f64>;
    type Measurement = Vector2<f64>;

    fn expected(&self, pose: &Pose2<f64>) -> Vector2<f64> {
        pose.inverse_transform(&self.0)
    }
    fn noise(&self, _: &Pose2<f64>) -> Matrix2<f64> {
        Matrix2::identity() * 0.01
    }
}

fn ride_along<F: KalmanAlgorithm<Pose2<f64>>>(name: &str, form: F) -> Result<(), KalmanError> {
    let bicycle = Bicycle { wheelbase: 1.1 };
    let lighthouses = [Lighthouse(Vector2::new(8.0, 6.0)), Lighthouse(Vector2::new(-5.0, 9.0))];
    let prior = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(1.0, 1.0, 0.5))?;
    let mut truth = Pose2::new(0.6, -0.5, 0.3);
    let ride = Ride { speed: 3.0, steering: 0.1, seconds: 0.2 };
    let mut filter = GaussianFilter::new(Bicycle { wheelbase: 1.1 }, form, prior)?;
    for _ in 0..100 {
        truth = bicycle.propagate(&truth, &ride);
        filter.predict(&ride)?;
        for lighthouse in &lighthouses {
            filter.update(lighthouse, &lighthouse.expected(&truth))?;
        }
    }
    let error = filter.estimate().mean().local(&truth);
    println!("{name:>12}: {:.3} m and {:.4} rad off", error.xy().norm(), error.z.abs());
    Ok(())
}

fn main() -> Result<(), KalmanError> {
    ride_along("extended", ExtendedKalmanAlgorithm)?;
    ride_along("iterated", IteratedExtendedKalmanAlgorithm::default())?;
    ride_along("unscented", UnscentedKalmanAlgorithm::default())?;
    ride_along("square root", SquareRootKalmanAlgorithm)
}
