//! A feature of your own on top of the walls: corners, where two of them meet, with the uncertainty that follows from theirs.
//!
//! `cargo run -p wayfix-line-extract --example 02_custom_corners`

use nalgebra::{Matrix2, Vector2};
use wayfix_line_extract::{LineExtractionError, LineExtractionParams, Scan, WallSegment, extract};

/// Where two walls meet, in the sensor's frame, m and m².
struct Corner {
    point: Vector2<f64>,
    covariance: Matrix2<f64>,
}

impl Corner {
    /// Of two neighbours, unless they are parallel to within 20° or end farther than `reach` from where they would meet.
    fn between(first: &WallSegment, second: &WallSegment, reach: f64) -> Option<Self> {
        // x cos α + y sin α = ρ for both walls.
        let lines = [first.estimate, second.estimate];
        let normals = Matrix2::from_rows(&lines.map(|wall| wall.line.normal().transpose()));
        if normals.determinant().abs() < 20_f64.to_radians().sin() {
            return None;
        }
        let inverse = normals.try_inverse()?;
        let point = inverse * Vector2::new(lines[0].line.rho(), lines[1].line.rho());
        let is_near = |end: &Vector2<f64>| (end - point).norm() < reach;
        if !(is_near(&first.end) && is_near(&second.start)) {
            return None;
        }
        // A wall that turns by dα moves sideways at the corner by what lies between it and the foot of the normal.
        let variance = lines.map(|wall| wall.variance_at(wall.line.direction().dot(&point)));
        let covariance = inverse * Matrix2::from_diagonal(&variance.into()) * inverse.transpose();
        Some(Self { point, covariance })
    }
}

fn main() -> Result<(), LineExtractionError> {
    // A room of 6 m by 4 m, the scanner in the middle, one beam a degree; a ripple of half a centimetre stands for noise.
    let ranges: Vec<f64> = (0..360)
        .map(|beam| {
            let (sin, cos) = f64::from(beam).to_radians().sin_cos();
            (3.0 / cos.abs().max(1e-9)).min(2.0 / sin.abs().max(1e-9)) + 0.005 * (1.7 * f64::from(beam)).sin()
        })
        .collect();
    let scan = Scan { angle_min: 0.0, angle_increment: 1_f64.to_radians(), ranges: &ranges, max_range: 30.0 };
    let walls = extract(&scan, &LineExtractionParams::default())?.segments;

    // Once round: the last wall is the neighbour of the first.
    let neighbours = walls.iter().zip(walls.iter().cycle().skip(1));
    let corners: Vec<Corner> =
        neighbours.filter_map(|(wall, next)| Corner::between(wall, next, 0.3)).collect();
    for Corner { point, covariance } in &corners {
        let [x, y] = [covariance[(0, 0)].sqrt(), covariance[(1, 1)].sqrt()];
        println!("({:+.3} ± {x:.3}, {:+.3} ± {y:.3}) m", point.x, point.y);
        assert!((point.x.abs() - 3.0).abs() < 0.02 && (point.y.abs() - 2.0).abs() < 0.02);
    }
    assert_eq!(corners.len(), 4);
    Ok(())
}
