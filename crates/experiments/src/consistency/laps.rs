use std::f64::consts::TAU;

use anyhow::{Result, ensure};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::Deserialize;
use wayfix_scene_sim::{
    OdometryParams, PlanarDriveParams,
    drive::WheeledRobotParams,
    random::RandomStreams,
    route::{RoundedRectangleRoute, RouteParams},
    sensor::{GaussianOdometryParams, RangeBearingParams, range_bearing::RangeDependentSigma},
    world::{CorridorLoop, WorldLayout},
};
use wayfix_sensor_log::Record;
use wayfix_slam_ekf::{OdometryMotion, RangeBearingSensor};

/// Laps of a corridor with landmarks on its walls, with exactly the noise that filters assume.
///
/// ```
/// use wayfix_experiments::consistency::CorridorLaps;
/// let laps = CorridorLaps { length_m: 20.0, width_m: 10.0, n_laps: 1, ..CorridorLaps::default() };
/// assert_ne!(laps.simulate(1)?, laps.simulate(2)?);
/// assert_eq!(laps.motion().heading_variance_per_step, laps.odometry_sigma_rad.powi(2));
/// # Ok::<(), anyhow::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorridorLaps {
    /// Along the middle of the corridor, m.
    pub length_m: f64,
    /// Across, m.
    pub width_m: f64,
    /// From wall to wall, m.
    pub corridor_m: f64,
    /// From one landmark to the next on the same wall, m.
    pub spacing_m: f64,
    /// Number of laps.
    pub n_laps: u32,
    /// The anchored filter knows the position of every n-th landmark; only of the first if this is 0.
    pub anchor_every: u32,
    /// Range of the omnidirectional sensor, m.
    pub max_range_m: f64,
    /// Standard deviation of x and of y of every increment of two metres, m.
    pub odometry_sigma_m: f64,
    /// Standard deviation of its turn, rad.
    pub odometry_sigma_rad: f64,
    /// Standard deviation of ranges, m.
    pub range_sigma_m: f64,
    /// Standard deviation of bearings, rad.
    pub bearing_sigma_rad: f64,
}

/// Period of odometry and scans, ms; they are two metres apart.
const PERIOD_MS: u32 = 500;
const SPEED_MPS: f64 = 4.0;
const CORNER_RADIUS_M: f64 = 3.0;
/// More laps are a slip of the pen.
const MOST_LAPS: u32 = 1000;

impl Default for CorridorLaps {
    fn default() -> Self {
        Self {
            length_m: 60.0,
            width_m: 36.0,
            corridor_m: 6.0,
            spacing_m: 4.0,
            n_laps: 3,
            anchor_every: 12,
            max_range_m: 8.0,
            odometry_sigma_m: 0.06,
            odometry_sigma_rad: 0.02,
            range_sigma_m: 0.1,
            bearing_sigma_rad: 0.025,
        }
    }
}

impl CorridorLaps {
    /// A log of the laps: other noise for every seed.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range.
    pub fn simulate(&self, seed: u64) -> Result<Vec<Record>> {
        ensure!(self.n_laps <= MOST_LAPS, "{} laps are more than {MOST_LAPS}", self.n_laps);
        Ok(self.scene().simulate(&mut RandomStreams::new(ChaCha8Rng::seed_from_u64(seed)))?)
    }

    /// Motion model with the simulated noise.
    pub fn motion(&self) -> OdometryMotion {
        OdometryMotion {
            translation_variance_per_meter: 0.0,
            heading_variance_per_meter: 0.0,
            heading_variance_per_radian: 0.0,
            translation_variance_per_step: self.odometry_sigma_m.powi(2),
            heading_variance_per_step: self.odometry_sigma_rad.powi(2),
        }
    }

    /// Sensor model with the simulated noise.
    pub fn sensor(&self) -> RangeBearingSensor {
        RangeBearingSensor {
            range_sigma: self.range_sigma_m,
            bearing_sigma: self.bearing_sigma_rad,
            ..RangeBearingSensor::default()
        }
    }

    fn scene(&self) -> PlanarDriveParams {
        let around = RoundedRectangleRoute {
            length_m: self.length_m,
            width_m: self.width_m,
            corner_radius_m: CORNER_RADIUS_M,
        };
        let lap_m = 2.0 * (self.length_m + self.width_m) - (8.0 - TAU) * CORNER_RADIUS_M;
        let odometry = GaussianOdometryParams {
            period_ms: PERIOD_MS,
            increment_position_sigma_m: self.odometry_sigma_m,
            increment_heading_sigma_rad: self.odometry_sigma_rad,
        };
        PlanarDriveParams {
            layout: WorldLayout::CorridorLoop(CorridorLoop {
                length_m: self.length_m,
                width_m: self.width_m,
                corridor_m: self.corridor_m,
                spacing_m: self.spacing_m,
            }),
            n_unknown_codes: 0,
            other_robots: Vec::new(),
            route: RouteParams::RoundedRectangle(around),
            robot: WheeledRobotParams {
                speed_mps: SPEED_MPS,
                acceleration_mps2: 2.0,
                lookahead_m: 2.0,
                ..WheeledRobotParams::default()
            },
            odometry: OdometryParams::Gaussian(odometry),
            sensor: RangeBearingParams {
                period_ms: PERIOD_MS,
                max_range_m: self.max_range_m,
                range_noise: RangeDependentSigma { constant_m: self.range_sigma_m, per_meter: 0.0 },
                bearing_sigma_rad: self.bearing_sigma_rad,
                ..RangeBearingParams::default()
            },
            duration_ms: (1e3 * f64::from(self.n_laps) * lap_m / SPEED_MPS) as u64,
            truth_period_ms: PERIOD_MS,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_numbers_are_refused() {
        let good = CorridorLaps { n_laps: 1, ..CorridorLaps::default() };
        for bad in [
            CorridorLaps { length_m: f64::NAN, ..good },
            CorridorLaps { width_m: f64::INFINITY, ..good },
            CorridorLaps { width_m: 1.0, ..good }, // no block inside the corridor
            CorridorLaps { spacing_m: 0.0, ..good },
            CorridorLaps { max_range_m: -1.0, ..good },
            CorridorLaps { odometry_sigma_m: -0.1, ..good },
            CorridorLaps { bearing_sigma_rad: f64::NAN, ..good },
            CorridorLaps { n_laps: u32::MAX, ..good },
        ] {
            assert!(bad.simulate(1).is_err(), "{bad:?}");
        }
        assert!(good.simulate(1).is_ok());
    }
}
