use super::row::RowError;
use crate::{LaserScan, ReadReport, RowProblemKind};

/// Range limit, m. SICK scanners return 81.91 m for no echo, older ones 51.16 m, and indoor ranges are shorter.
const RANGE_MAX_M: f64 = 50.0;

/// The scan of a forward-looking laser with a half-circle field of view, from the right.
///
/// With 180 or 360 beams, in steps of a whole or half degree, the last beam of the half circle is missing. Any other number of beams spans it.
pub(crate) fn half_circle(ranges: Vec<f64>) -> Result<LaserScan, RowError> {
    let angle_increment = match ranges.len() {
        180 | 181 => 1.0_f64.to_radians(),
        360 | 361 => 0.5_f64.to_radians(),
        n_beams @ 0..=1 => {
            let reason = format!("{n_beams} beams have no field of view");
            return Err(RowError::new(RowProblemKind::Inconsistent, reason));
        }
        n_beams => std::f64::consts::PI / (n_beams - 1) as f64,
    };
    Ok(LaserScan {
        angle_min: -std::f64::consts::FRAC_PI_2,
        angle_increment,
        range_max: RANGE_MAX_M,
        beam_period: 0.0,
        ranges,
    })
}

/// Whether a scan with this number of beams certainly covers a half circle.
pub(crate) fn is_half_circle(n_beams: usize) -> bool {
    matches!(n_beams, 180 | 181 | 360 | 361)
}

/// Warns of an assumed field of view: only the beam counts of a SICK scanner determine it.
pub(crate) fn warn_of_assumed_field_of_view(n_beams: usize, report: &mut ReadReport) {
    if !is_half_circle(n_beams) {
        let text = format!(
            "the log does not state the field of view of scans with {n_beams} beams; 180° is assumed (a ROBOTLASER1 line states another)"
        );
        report.warn("laser_field_of_view_assumed", text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_beams_cover_the_half_circle() {
        for (n_beams, last_degrees) in
            [(180, 89.0_f64), (181, 90.0), (360, 89.5), (361, 90.0), (91, 90.0), (541, 90.0)]
        {
            let scan = half_circle(vec![1.0; n_beams]).unwrap();
            assert_eq!(scan.bearing(0), -std::f64::consts::FRAC_PI_2);
            assert_abs_diff_eq!(scan.bearing(n_beams - 1).to_degrees(), last_degrees, epsilon = 1e-9);
        }
        assert_eq!(half_circle(vec![1.0]).unwrap_err().kind, RowProblemKind::Inconsistent);
        assert_eq!(half_circle(Vec::new()).unwrap_err().kind, RowProblemKind::Inconsistent);
    }

    #[test]
    fn a_field_of_view_is_assumed_only_for_other_numbers_of_beams() {
        let mut report = ReadReport::default();
        [180, 181, 360, 361]
            .into_iter()
            .for_each(|n_beams| warn_of_assumed_field_of_view(n_beams, &mut report));
        assert!(report.warnings.is_empty());
        [541, 541].into_iter().for_each(|n_beams| warn_of_assumed_field_of_view(n_beams, &mut report));
        assert_eq!(report.warnings.len(), 1);
        assert!(report.warnings[0].text.contains("541"));
    }
}
