//! A rolling ball, seen by a camera that sometimes misses it and sometimes sees something else.
//!
//! `cargo run -p wayfix-kalman --example 01_track_a_ball`

use nalgebra::{Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};
use wayfix_gaussian_core::{ChiSquaredGate, Gaussian};
use wayfix_kalman::{GatedUpdate, KalmanFilter, LinearMotion, LinearSensor};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 1. How the ball moves: position and velocity in metres and m/s, a frame every 0.1 s, some friction nobody models.
    let transition = Matrix4::new(
        1.0, 0.0, 0.1, 0.0, //
        0.0, 1.0, 0.0, 0.1, //
        0.0, 0.0, 1.0, 0.0, //
        0.0, 0.0, 0.0, 1.0,
    );
    let motion =
        LinearMotion::new(transition, Matrix4::from_diagonal(&Vector4::new(1e-5, 1e-5, 1e-3, 1e-3)))?;

    // 2. What the camera sees: the position, 2 cm off.
    let camera = LinearSensor::new(Matrix2x4::identity(), Matrix2::identity() * 0.02 * 0.02)?;

    // 3. What is known at first: somewhere within a metre, speed within 2 m/s.
    let prior = Gaussian::from_sigmas(Vector4::zeros(), &Vector4::new(1.0, 1.0, 2.0, 2.0))?;
    let mut filter = KalmanFilter::new(motion, prior)?;

    // 4. A gate that lets 99.9 % of true sightings through.
    let gate = ChiSquaredGate::from_probability(2, 0.999)?;

    // 5. Frame by frame: predict, then update with what was seen, if anything.
    for frame in 0..40 {
        filter.predict(None)?;
        match filter.update_gated(&camera, sighting(frame).as_ref(), &gate)? {
            GatedUpdate::Accepted { .. } => {}
            GatedUpdate::Rejected { innovation, threshold } => {
                println!("frame {frame}: not the ball (NIS {:.0} above {threshold:.1})", innovation.nis());
            }
            GatedUpdate::Missing => println!("frame {frame}: nothing seen"),
        }
    }

    // 6. The answer, with its uncertainty.
    let (mean, sigmas) = (filter.estimate().mean(), filter.estimate().sigmas());
    println!("position ({:.2} ± {:.2}, {:.2} ± {:.2}) m", mean.x, sigmas.x, mean.y, sigmas.y);
    println!("velocity ({:.2} ± {:.2}, {:.2} ± {:.2}) m/s", mean.z, sigmas.z, mean.w, sigmas.w);
    Ok(())
}

/// A ball from (0.2, 0.1) at (1.0, 0.5) m/s; an alternating 1 cm stands in for noise.
fn sighting(frame: u32) -> Option<Vector2<f64>> {
    let seconds = 0.1 * f64::from(frame + 1);
    let jitter = if frame.is_multiple_of(2) { 0.01 } else { -0.01 };
    match frame {
        12..15 => None,
        25 => Some(Vector2::new(-3.0, 4.0)),
        _ => Some(Vector2::new(0.2 + seconds + jitter, 0.1 + 0.5 * seconds - jitter)),
    }
}
