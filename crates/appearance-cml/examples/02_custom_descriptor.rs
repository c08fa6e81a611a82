//! Views of your own: a lidar that sees all round instead of a camera. `cargo run -p wayfix-appearance-cml --example 02_custom_descriptor`
//!
//! One method makes anything a view that can be compared; map, search and localizer need to know nothing about it.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use wayfix_appearance_cml::{
    AppearanceLocalizer, LocalizerParams, StartPosePrior, ViewDescriptor, ViewDifference,
};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_gaussian_core::Gaussian;

const BEAMS: usize = 72;

/// Logarithms of the ranges, counterclockwise from straight ahead.
#[derive(Clone, Debug)]
struct Ring([f64; BEAMS]);

impl ViewDescriptor for Ring {
    /// Root mean square difference at the best rotation by whole beams: who has turned left by `n` beams sees the old beam `n` first.
    fn compare(&self, reference: &Self) -> ViewDifference {
        let squared = |turn: usize| -> f64 {
            (0..BEAMS).map(|beam| (self.0[beam] - reference.0[(beam + turn) % BEAMS]).powi(2)).sum()
        };
        let best = (0..BEAMS).min_by(|a, b| squared(*a).total_cmp(&squared(*b))).unwrap_or_default();
        let signed = if 2 * best > BEAMS { best as f64 - BEAMS as f64 } else { best as f64 };
        let distance = (squared(best) / BEAMS as f64).sqrt();
        ViewDifference { distance, rotation: signed * TAU / BEAMS as f64 }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let start = Pose2::new(2.0, 1.5, 0.0);
    let known = Gaussian::from_sigmas(start, &Vector3::new(0.02, 0.02, 0.01))?;
    let mut localizer: AppearanceLocalizer<Ring> =
        AppearanceLocalizer::new(LocalizerParams::default(), StartPosePrior::Known(known))?;

    // Three laps of a circle; wheels that turn the robot by 2 % more than it turns.
    let (mut robot, mut by_wheels) = (start, start);
    for _ in 0..3 * 72 {
        localizer.update(look(&robot))?;
        let told = Pose2::new(0.12, 0.0, 1.02 * TAU / 72.0);
        robot = robot.compose(&Pose2::new(0.12, 0.0, TAU / 72.0));
        by_wheels = by_wheels.compose(&told);
        localizer.predict(&told)?;
    }
    let estimate = localizer.estimate().ok_or("lost")?;
    let error = |pose: &Pose2<f64>| (pose.translation - robot.translation).norm();
    let (ours, wheels) = (error(estimate.mean()), error(&by_wheels));
    println!("{} references; {ours:.2} m off, wheels alone {wheels:.2} m", localizer.map().len());
    assert!(ours < wheels);
    Ok(())
}

/// What the lidar measures in an L-shaped room: 7 m × 5 m without the corner beyond (5, 3).
fn look(pose: &Pose2<f64>) -> Ring {
    let range = |beam: usize| {
        let (sin, cos) = (pose.heading() + TAU * beam as f64 / BEAMS as f64).sin_cos();
        let inside = |t: &f64| {
            let (x, y) = (pose.x() + t * cos, pose.y() + t * sin);
            (0.0..7.0).contains(&x) && (0.0..5.0).contains(&y) && (x < 5.0 || y < 3.0)
        };
        let steps = (1..1000).map(|k| 0.01 * f64::from(k));
        steps.take_while(inside).last().unwrap_or(0.01).ln()
    };
    Ring(std::array::from_fn(range))
}
