//! A cart that maps a warehouse aisle by aisle with a laser and bad wheels: a whole robot out of three crates.
//!
//! `wayfix-estimation-traits` for poses, `wayfix-line-extract` for walls in scans, `wayfix-slam-ekf` for the map.
//! Run it with `cargo run --release` in this folder.

mod cart;
mod warehouse;

use std::error::Error;

use cart::Cart;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_line_extract::{LineExtractor, LineExtractionParams, Scan};
use wayfix_slam_ekf::{
    LandmarkConfirmationParams, EkfSlam, OdometryMotion, JointCompatibility, JointCompatibilityParams, LinearizationPoint,
    Observation, WallMeasurement, SlamParams, WallSensor,
};

fn main() -> Result<(), Box<dyn Error>> {
    let start = Pose2::new(2.0, 2.0, 0.0);
    let mut cart = Cart::new(start);

    let mut extractor = LineExtractor::new(LineExtractionParams::default())?;
    let motion = OdometryMotion {
        translation_variance_per_meter: 1e-3,
        heading_variance_per_meter: 2e-3,
        ..OdometryMotion::default()
    };
    let filter = SlamParams {
        linearization_point: LinearizationPoint::FirstEstimates, // laps: the standard form would grow too sure of its heading
        confirmation: LandmarkConfirmationParams { min_detections: 3, max_consecutive_misses: Some(10), ..LandmarkConfirmationParams::default() },
        ..SlamParams::default()
    };
    let mut association = JointCompatibility::new(JointCompatibilityParams::default())?;
    let mut slam = EkfSlam::new(WallSensor::default(), filter, start)?;

    let mut by_wheels = start;
    while let Some(increment) = cart.drive() {
        slam.predict(&motion, &increment)?;
        by_wheels = by_wheels.compose(&increment);

        let ranges = cart.scan();
        let scan = Scan {
            angle_min: -std::f64::consts::FRAC_PI_2,
            angle_increment: 0.5_f64.to_radians(),
            ranges: &ranges,
            max_range: 20.0,
        };
        let walls = extractor.extract(&scan)?;
        let long = walls.segments.iter().filter(|wall| wall.length() > 0.7);
        let seen: Vec<_> =
            long.map(|wall| Observation { label: None, measurement: WallMeasurement::from(wall) }).collect();
        slam.update(&seen, &mut association)?;
    }

    let off = |pose: &Pose2<f64>| (pose.translation - cart.pose().translation).norm();
    let (map, wheels) = (off(slam.robot()), off(&by_wheels));
    println!("{:.0} m driven, {} walls in the map", cart.driven(), slam.n_landmarks());
    println!("off by {map:.3} m, by wheels alone {wheels:.2} m");
    assert!(map < 0.25 && map < 0.25 * wheels, "a map keeps a cart on its way");
    Ok(())
}
