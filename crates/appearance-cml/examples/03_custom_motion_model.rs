//! A motion model of your own: a tracked robot whose tracks slip. `cargo run -p wayfix-appearance-cml --example 03_custom_motion_model`
//!
//! Any `MotionModel` on `Pose2` moves the belief of the localizer.

use nalgebra::{Matrix3, Vector3};
use wayfix_appearance_cml::{
    AppearanceLocalizer, AppearanceMap, LinearSearch, LocalizerParams, StartPosePrior, ViewDescriptor,
    ViewDifference,
};
use wayfix_estimation_traits::{LieGroup, MotionModel, Pose2};
use wayfix_gaussian_core::Gaussian;

/// The tracks report a longer distance than the robot drives.
#[derive(Clone, Copy, Debug)]
struct SlippingTracks {
    slip: f64,
}

impl MotionModel for SlippingTracks {
    type State = Pose2<f64>;
    type Control = Pose2<f64>;

    // The numerical Jacobian of the trait is good enough here.
    fn propagate(&self, pose: &Pose2<f64>, increment: &Pose2<f64>) -> Pose2<f64> {
        let driven = increment.translation * (1.0 - self.slip);
        pose.compose(&Pose2::new(driven.x, driven.y, increment.heading()))
    }

    fn noise(&self, _: &Pose2<f64>, increment: &Pose2<f64>) -> Matrix3<f64> {
        let distance = increment.translation.norm();
        Matrix3::from_diagonal(&Vector3::new(1e-3, 1e-4, 1e-5)) * distance + Matrix3::identity() * 1e-12
    }
}

/// A corridor that gets brighter.
#[derive(Clone, Debug)]
struct Brightness(f64);

impl ViewDescriptor for Brightness {
    fn compare(&self, reference: &Self) -> ViewDifference {
        ViewDifference { distance: (self.0 - reference.0).abs(), rotation: 0.0 }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(0.01, 0.01, 0.01))?;
    let mut localizer: AppearanceLocalizer<Brightness, LinearSearch<_>, _> =
        AppearanceLocalizer::with_motion_model(
            LocalizerParams::default(),
            AppearanceMap::default(),
            StartPosePrior::Known(start),
            SlippingTracks { slip: 0.1 },
        )?;
    for step in 0..40 {
        localizer.update(Brightness(0.225 * f64::from(step)))?;
        localizer.predict(&Pose2::new(0.25, 0.0, 0.0))?;
    }
    let x = localizer.estimate().ok_or("lost")?.mean().x();
    println!("the tracks report 10 m, the robot is at {x:.2} m");
    assert!((x - 9.0).abs() < 0.1);
    Ok(())
}
