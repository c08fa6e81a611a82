//! Poses, how they are composed, and how an error in the odometry grows.
//!
//! `cargo run -p wayfix-estimation-traits --example 01_drive_a_square`

use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2, numerical_jacobian};

fn main() {
    // 1. Metres and radians; x forward, y left. A side of the square, then a quarter turn to the left.
    let side = Pose2::new(2.0, 0.0, std::f64::consts::FRAC_PI_2);
    let mut pose = Pose2::new(0.0, 0.0, 0.0);
    for corner in 1..=4 {
        pose = pose.compose(&side);
        println!(
            "corner {corner}: ({:.2}, {:.2}) m, {:.0}°",
            pose.x(),
            pose.y(),
            pose.heading().to_degrees()
        );
    }

    // 2. Four sides lead home. Differences of poses are tangent vectors in the body frame: forward, left, turn.
    let home = Pose2::new(0.0, 0.0, 0.0);
    assert!(home.local(&pose).norm() < 1e-12);

    // 3. Odometry that turns by half a degree too little at each corner ends elsewhere; angles wrap by themselves.
    let short = side.retract(&Vector3::new(0.0, 0.0, -0.5_f64.to_radians()));
    let drifted = (0..4).fold(home, |pose, _| pose.compose(&short));
    let error = home.local(&drifted);
    println!("half a degree a corner: {:.3} m and {:.1}° off", error.xy().norm(), error.z.to_degrees());
    assert!((error.z.to_degrees() + 2.0).abs() < 1e-9);

    // 4. How the end depends on the start, to first order: what an extended Kalman filter asks of a motion model.
    let jacobian: Matrix3<f64> = numerical_jacobian(|start: &Pose2<f64>| start.compose(&side), &home);
    println!("d end / d start = {jacobian:.3}");
}
