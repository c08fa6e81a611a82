//! Three walls of a room from one synthetic scan: `cargo run -p wayfix-line-extract --example 01_walls_of_a_scan`

use wayfix_line_extract::{LineExtractionError, LineExtractionParams, Scan, extract};

fn main() -> Result<(), LineExtractionError> {
    // A laser of 181 beams at the origin, walls ahead (x = 4), to the left (y = 2) and to the right (y = -1.5).
    let increment = 1_f64.to_radians();
    let bearing = |beam: usize| (beam as f64 - 90.0) * increment;
    let mut ranges: Vec<f64> = (0..181)
        .map(|beam| {
            let (sin, cos) = bearing(beam).sin_cos();
            let side = if sin > 0.0 { 2.0 / sin } else { 1.5 / -sin };
            // A ripple of a centimetre stands for noise.
            side.min(4.0 / cos.max(1e-9)) + 0.01 * (2.4 * beam as f64).sin()
        })
        .collect();
    ranges[100..105].fill(f64::INFINITY); // a window

    let scan = Scan { angle_min: bearing(0), angle_increment: increment, ranges: &ranges, max_range: 30.0 };
    let seen = extract(&scan, &LineExtractionParams::default())?;
    println!("{} of {} beams came back; walls:", seen.counts.valid, ranges.len());
    for wall in &seen.segments {
        let (line, p) = (&wall.estimate.line, &wall.estimate.covariance);
        println!(
            "  ρ = {:.3} ± {:.3} m, α = {:6.1} ± {:.2}°, {:.2} m long, {} echoes, rms {:.1} mm",
            line.rho(),
            p[(0, 0)].sqrt(),
            line.alpha().to_degrees(),
            p[(1, 1)].sqrt().to_degrees(),
            wall.length(),
            wall.n_points,
            1e3 * wall.rms_m
        );
    }
    Ok(())
}
