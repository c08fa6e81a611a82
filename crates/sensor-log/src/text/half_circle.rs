use super::row::RowError;
use crate::{LaserScan, ProblemKind};

/// SICK scanners give 81.91 m where nothing came back, older ones 51.16 m; nobody measures that far indoors.
const RANGE_MAX_M: f64 = 50.0;

/// The scan of a laser that looks ahead over half a circle, from the right, in steps of a whole or half degree.
///
/// With 180 or 360 beams the last one of the half circle is missing.
pub(crate) fn half_circle(ranges: Vec<f64>) -> Result<LaserScan, RowError> {
    let degrees = match ranges.len() {
        180 | 181 => 1.0_f64,
        360 | 361 => 0.5,
        n_beams => {
            let reason = format!("{n_beams} beams; the angles are known for 180, 181, 360 and 361");
            return Err(RowError::new(ProblemKind::Inconsistent, reason));
        }
    };
    Ok(LaserScan {
        angle_min: -std::f64::consts::FRAC_PI_2,
        angle_increment: degrees.to_radians(),
        range_max: RANGE_MAX_M,
        ranges,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_circle_beams_are_spaced_and_other_counts_are_refused() {
        for (n_beams, last_degrees) in [(180, 89.0_f64), (181, 90.0), (360, 89.5), (361, 90.0)] {
            let scan = half_circle(vec![1.0; n_beams]).unwrap();
            assert_eq!(scan.bearing(0), -std::f64::consts::FRAC_PI_2);
            assert!((scan.bearing(n_beams - 1).to_degrees() - last_degrees).abs() < 1e-9);
        }
        assert_eq!(half_circle(vec![1.0; 179]).unwrap_err().kind, ProblemKind::Inconsistent);
        assert_eq!(half_circle(Vec::new()).unwrap_err().kind, ProblemKind::Inconsistent);
    }
}
