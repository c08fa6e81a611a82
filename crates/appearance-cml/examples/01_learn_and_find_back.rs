//! A robot learns what a room looks like, is switched off, and finds out where it is when it wakes up: six steps to copy.
//!
//! `cargo run --release -p wayfix-appearance-cml --example 01_learn_and_find_back`

use nalgebra::Vector3;
use wayfix_appearance_cml::{
    AppearanceLocalizer, AppearanceMapError, LocalizerParams, Panorama, PanoramaDescriptor,
    PanoramaDescriptorExtractor, PanoramaDescriptorParams, StartPosePrior,
};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_gaussian_core::Gaussian;

const COLUMNS: usize = 120;
const ROWS: usize = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 1. What is compared of two views; one object for each size of panorama.
    let features = PanoramaDescriptorExtractor::new(PanoramaDescriptorParams::default(), COLUMNS, ROWS)?;

    // 2. The first day the robot knows where it starts, and nothing else.
    let start = Pose2::new(1.5, 1.5, 0.0);
    let known = Gaussian::from_sigmas(start, &Vector3::new(0.02, 0.02, 0.01))?;
    let mut localizer: AppearanceLocalizer<PanoramaDescriptor> =
        AppearanceLocalizer::new(LocalizerParams::default(), StartPosePrior::Known(known))?;

    // 3. At every step a view, and then the way to the next as the wheels tell it, 1 % too long.
    let mut robot = start;
    for step in lap().chain(lap()) {
        localizer.update(features.describe(&look(&robot)?)?)?;
        robot = robot.compose(&step);
        localizer.predict(&Pose2::new(1.01 * step.x(), step.y(), step.heading()))?;
    }
    let error = (localizer.estimate().ok_or("lost")?.mean().translation - robot.translation).norm();
    println!("two laps: {} references, {error:.2} m off", localizer.map().len());
    assert!(error < 0.3);

    // 4. The map goes on living; `MapArchive` makes bytes of it for a file.
    let map = localizer.map().clone();

    // 5. Another day, somewhere on the lap.
    let mut robot = lap().take(70).fold(start, |pose, step| pose.compose(&step));
    let mut localizer =
        AppearanceLocalizer::with_map(LocalizerParams::default(), map, StartPosePrior::Anywhere)?;
    for step in lap().skip(70) {
        localizer.update(features.describe(&look(&robot)?)?)?;
        robot = robot.compose(&step);
        localizer.predict(&step)?;
    }

    // 6. Ask where it is. `None` would mean that it could be in several places.
    let found = localizer.estimate().ok_or("nowhere")?;
    let error = (found.mean().translation - robot.translation).norm();
    println!("woken up: {error:.2} m off");
    assert!(error < 0.3);
    Ok(())
}

/// Once round a rectangle with rounded corners, 0.1 m a step.
fn lap() -> impl Iterator<Item = Pose2<f64>> {
    let turn = std::f64::consts::FRAC_PI_2 / 8.0;
    let side = |length: usize| (0..length).map(|_| 0.0).chain((0..8).map(move |_| turn));
    let turns = side(40).chain(side(20)).chain(side(40)).chain(side(20));
    turns.map(|turn| Pose2::new(0.1, 0.0, turn))
}

/// What the camera sees in a room of 8 m × 6 m with wallpaper; columns go to the right.
fn look(pose: &Pose2<f64>) -> Result<Panorama, AppearanceMapError> {
    let mut bytes = Vec::with_capacity(3 * COLUMNS * ROWS);
    for row in 0..ROWS {
        let slope = (0.5 - row as f64 / ROWS as f64).tan();
        for column in 0..COLUMNS {
            let azimuth = pose.heading() - std::f64::consts::TAU * column as f64 / COLUMNS as f64;
            let (sin, cos) = azimuth.sin_cos();
            let to_wall = |at: f64, along: f64, length: f64| {
                if along > 0.0 { (length - at) / along } else { at / (-along).max(1e-9) }
            };
            let distance = to_wall(pose.x(), cos, 8.0).min(to_wall(pose.y(), sin, 6.0));
            bytes.extend(wallpaper(pose.x() + distance * cos, pose.y() + distance * sin, distance * slope));
        }
    }
    Panorama::from_rgb(COLUMNS, ROWS, bytes)
}

/// Waves that never repeat within the room.
fn wallpaper(x: f64, y: f64, height: f64) -> [u8; 3] {
    let wave = |a: f64, b: f64, c: f64| {
        128.0 + 60.0 * (a * x + (b * y).sin()).sin() + 40.0 * (c * y - 1.3 * x + 2.0 * height).cos()
    };
    [wave(2.1, 0.9, 1.7) as u8, wave(1.3, 1.9, 0.7) as u8, wave(0.6, 1.2, 2.3) as u8]
}
