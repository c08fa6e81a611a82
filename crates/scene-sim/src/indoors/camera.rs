use std::f64::consts::{FRAC_PI_2, PI};

use crate::{SimulationError, check};

/// An omnidirectional camera, and the unwrapping of its image.
///
/// The columns of a view run from left to right in the order of a clockwise turn: column k is centred on the azimuth $`π - (k + ½)\,2π/n`$, the
/// front is in the middle, and the first row has the highest elevation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OmniCameraParams {
    /// Sectors, an even number. Default 120.
    pub n_columns: usize,
    /// Rings. Default 20.
    pub n_rings: usize,
    /// Upper edge of the highest ring above the horizon, radians. Default 30°.
    pub max_elevation_rad: f64,
    /// Lower edge of the lowest ring, radians. Default −30°.
    pub min_elevation_rad: f64,
    /// Height above the floor, metres. Default 1.2.
    pub height_m: f64,
    /// Rays across and down a pixel. Default 2 and 2.
    pub rays_per_pixel: [usize; 2],
    /// Standard deviation of the noise of a pixel, grey values. Default 2.
    pub pixel_noise_sigma: f64,
    /// Share of a change of light that the automatic exposure compensates, 0 to 1. Default 0.8.
    pub exposure_compensation_share: f64,
}

impl Default for OmniCameraParams {
    fn default() -> Self {
        Self {
            n_columns: 120,
            n_rings: 20,
            max_elevation_rad: PI / 6.0,
            min_elevation_rad: -PI / 6.0,
            height_m: 1.2,
            rays_per_pixel: [2, 2],
            pixel_noise_sigma: 2.0,
            exposure_compensation_share: 0.8,
        }
    }
}

impl OmniCameraParams {
    /// Whether the numbers make a camera.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::above("columns of the camera", self.n_columns as f64, 3.5, "at least 4")?;
        check::count("columns of the camera", self.n_columns, 4096)?;
        check::at_most("columns of the camera modulo 2", (self.n_columns % 2) as f64, 0.0, "0")?;
        check::above("rings of the camera", self.n_rings as f64, 0.5, "at least 1")?;
        check::count("rings of the camera", self.n_rings, 1024)?;
        check::above("lowest elevation (rad)", self.min_elevation_rad, -FRAC_PI_2, "above −π/2")?;
        check::above(
            "highest elevation (rad)",
            self.max_elevation_rad,
            self.min_elevation_rad,
            "above the lowest",
        )?;
        check::above("highest elevation (rad)", FRAC_PI_2 - self.max_elevation_rad, 0.0, "below π/2")?;
        check::above("height of the camera (m)", self.height_m, 0.0, "above 0")?;
        check::at_most("height of the camera (m)", self.height_m, 2.5, "below the ceiling, at most 2.5")?;
        for rays in self.rays_per_pixel {
            check::above("rays of a pixel", rays as f64, 0.5, "at least 1")?;
            check::count("rays of a pixel", rays, 16)?;
        }
        check::not_negative("noise of the camera (grey values)", self.pixel_noise_sigma)?;
        check::share("share of the light that the exposure takes back", self.exposure_compensation_share)
    }
}
