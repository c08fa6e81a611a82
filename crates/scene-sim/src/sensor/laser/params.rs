use std::f64::consts::{FRAC_PI_2, TAU};

use super::People;
use crate::random::NoiseShape;
use crate::sensor::range_bearing::RangeDependentSigma;
use crate::{SimulationError, check};

/// The most beams a scan has.
const MOST_BEAMS: usize = 100_000;

/// Parameters of a laser scanner. The default is the data sheet of a SICK LMS 200 in a clean room: half a turn in steps of 1°, a statistical
/// error of 5 mm, ranges in whole centimetres, a beam of 4.4 mrad. The only error source is the mixing of surfaces at edges.
/// ```
/// use wayfix_scene_sim::sensor::LaserParams;
/// let params = LaserParams { n_beams: 361, beam_step_rad: 0.5_f64.to_radians(), ..Default::default() };
/// assert!(params.validate().is_ok());
/// assert!(LaserParams { range_resolution_m: -0.01, ..params }.validate().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaserParams {
    /// Time from one scan to the next, milliseconds; each is taken in an instant. Default 200.
    pub period_ms: u32,
    /// Direction of the first beam, radians, 0 ahead, counter-clockwise. Default −π/2.
    pub first_beam_rad: f64,
    /// From one beam to the next, radians. Default 1°.
    pub beam_step_rad: f64,
    /// Beams of a scan. Default 181.
    pub n_beams: usize,
    /// Maximum range of an echo, m. Default 30.
    pub max_range_m: f64,
    /// Range reported for no echo, m; scans state it as their `range_max`. Default 81.91.
    pub no_echo_range_m: f64,
    /// Standard deviation of the white range error. Default 0.005 m, not growing.
    pub range_noise: RangeDependentSigma,
    /// Shape of the white range error. Default Gaussian.
    pub noise_shape: NoiseShape,
    /// Added to every range, metres. Default 0.
    pub range_bias_m: f64,
    /// Standard deviation of each beam's true direction about its stated one, radians. Default 0.0005.
    pub bearing_sigma_rad: f64,
    /// Ranges are whole multiples of this, metres; 0 for any range. Default 0.01.
    pub range_resolution_m: f64,
    /// Opening angle of a beam, radians. Default 0.0044.
    pub beam_width_rad: f64,
    /// Share of the beams on the edge between two surfaces that report a range in between. Default 0.5.
    pub mixed_pixel_share: f64,
    /// Share of beams without echo, independent of the surface. Default 0.
    pub dropout_share: f64,
    /// Share of beams with a random range short of the surface: dust, glare. Default 0.
    pub spurious_share: f64,
    /// People in the field of view. Default none.
    pub people: People,
}

impl Default for LaserParams {
    fn default() -> Self {
        Self {
            period_ms: 200,
            first_beam_rad: -FRAC_PI_2,
            beam_step_rad: 1.0_f64.to_radians(),
            n_beams: 181,
            max_range_m: 30.0,
            no_echo_range_m: 81.91,
            range_noise: RangeDependentSigma { constant_m: 0.005, per_meter: 0.0 },
            noise_shape: NoiseShape::Gaussian,
            range_bias_m: 0.0,
            bearing_sigma_rad: 0.0005,
            range_resolution_m: 0.01,
            beam_width_rad: 0.0044,
            mixed_pixel_share: 0.5,
            dropout_share: 0.0,
            spurious_share: 0.0,
            people: People::default(),
        }
    }
}

impl LaserParams {
    /// Whether the numbers make a scanner.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::period("period of the scans (ms)", self.period_ms)?;
        check::finite("direction of the first beam (rad)", self.first_beam_rad)?;
        check::finite("angle between beams (rad)", self.beam_step_rad)?;
        check::count("beams of a scan", self.n_beams, MOST_BEAMS)?;
        let view = self.beam_step_rad.abs() * self.n_beams.saturating_sub(1) as f64;
        check::at_most("field of view (rad)", view, TAU, "at most a turn")?;
        check::positive("farthest range of the laser (m)", self.max_range_m)?;
        let must = "finite and above the farthest range";
        check::above("range of a beam without echo (m)", self.no_echo_range_m, self.max_range_m, must)?;
        self.range_noise.validate()?;
        self.noise_shape.validate()?;
        check::finite("range bias of the laser (m)", self.range_bias_m)?;
        check::not_negative("σ of a beam's direction (rad)", self.bearing_sigma_rad)?;
        check::not_negative("quantum of the ranges (m)", self.range_resolution_m)?;
        check::not_negative("opening angle of a beam (rad)", self.beam_width_rad)?;
        check::share("share of mixed beams", self.mixed_pixel_share)?;
        check::share("share of beams that are lost", self.dropout_share)?;
        check::share("share of spurious echoes", self.spurious_share)?;
        self.people.validate()
    }
}
