use std::f64::consts::TAU;

use anyhow::{Result, ensure};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::Deserialize;
use wayfix_scene_sim::{
    OdometryParams, PlanarParams,
    drive::DriveParams,
    random::Streams,
    route::{Circle, RouteParams},
    sensor::{GaussianOdometryParams, RangeBearingParams, range_bearing::RangeSigma},
    world::{Layout, Roadside},
};
use wayfix_sensor_log::Record;
use wayfix_slam_ekf::{IncrementMotion, RangeBearingSensor};

/// Laps of a circle among landmarks, with exactly the noise that filters assume.
///
/// ```
/// use wayfix::consistency::Laps;
/// let laps = Laps { radius_m: 5.0, n_laps: 1, ..Laps::default() };
/// assert_ne!(laps.simulate(1)?, laps.simulate(2)?);
/// assert_eq!(laps.motion().heading_variance_per_step, laps.odometry_sigma_rad.powi(2));
/// # Ok::<(), anyhow::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Laps {
    /// Radius of the circle, m.
    pub radius_m: f64,
    /// How often around.
    pub n_laps: u32,
    /// Landmarks on both sides of the way.
    pub n_landmarks: usize,
    /// Of these, how many places the anchored filter is told.
    pub n_anchors: u32,
    /// How far the sensor sees, all around, m.
    pub reach_m: f64,
    /// Standard deviation of x and of y of every increment of two metres, m.
    pub odometry_sigma_m: f64,
    /// Standard deviation of its turn, rad.
    pub odometry_sigma_rad: f64,
    /// Standard deviation of ranges, m.
    pub range_sigma_m: f64,
    /// Standard deviation of bearings, rad.
    pub bearing_sigma_rad: f64,
}

/// Odometry and looks come together, this often; two metres apart.
const PERIOD_MS: u32 = 500;
const SPEED_MPS: f64 = 4.0;
/// More laps are a slip of the pen.
const MOST_LAPS: u32 = 1000;

impl Default for Laps {
    fn default() -> Self {
        Self {
            radius_m: 30.0,
            n_laps: 3,
            n_landmarks: 60,
            n_anchors: 6,
            reach_m: 10.0,
            odometry_sigma_m: 0.07,
            odometry_sigma_rad: 0.012,
            range_sigma_m: 0.1,
            bearing_sigma_rad: 0.02,
        }
    }
}

impl Laps {
    /// A log of the laps: other landmarks and other noise for every seed.
    ///
    /// # Errors
    /// When a number has no meaning.
    pub fn simulate(&self, seed: u64) -> Result<Vec<Record>> {
        ensure!(self.n_laps <= MOST_LAPS, "{} laps are more than {MOST_LAPS}", self.n_laps);
        Ok(self.scene().simulate(&mut Streams::new(ChaCha8Rng::seed_from_u64(seed)))?)
    }

    /// What the filter may assume of odometry: how it was simulated.
    pub fn motion(&self) -> IncrementMotion {
        IncrementMotion {
            translation_variance_per_meter: 0.0,
            heading_variance_per_meter: 0.0,
            heading_variance_per_radian: 0.0,
            translation_variance_per_step: self.odometry_sigma_m.powi(2),
            heading_variance_per_step: self.odometry_sigma_rad.powi(2),
        }
    }

    /// What it may assume of sightings.
    pub fn sensor(&self) -> RangeBearingSensor {
        RangeBearingSensor {
            range_sigma: self.range_sigma_m,
            bearing_sigma: self.bearing_sigma_rad,
            ..RangeBearingSensor::default()
        }
    }

    fn scene(&self) -> PlanarParams {
        let lap_s = TAU * self.radius_m / SPEED_MPS;
        let odometry = GaussianOdometryParams {
            period_ms: PERIOD_MS,
            sigma_m: self.odometry_sigma_m,
            sigma_rad: self.odometry_sigma_rad,
        };
        PlanarParams {
            layout: Layout::Roadside(Roadside { n_landmarks: self.n_landmarks, clear_m: 1.0, verge_m: 7.0 }),
            n_unknown_codes: 0,
            other_robots: Vec::new(),
            route: RouteParams::Circle(Circle { radius_m: self.radius_m }),
            drive: DriveParams {
                speed_mps: SPEED_MPS,
                acceleration_mps2: 2.0,
                lookahead_m: 2.0,
                ..DriveParams::default()
            },
            odometry: OdometryParams::Gaussian(odometry),
            sensor: RangeBearingParams {
                period_ms: PERIOD_MS,
                max_range_m: self.reach_m,
                range_noise: RangeSigma { constant_m: self.range_sigma_m, per_metre: 0.0 },
                bearing_sigma_rad: self.bearing_sigma_rad,
                ..RangeBearingParams::default()
            },
            duration_ms: (1e3 * f64::from(self.n_laps) * lap_s) as u64,
            truth_period_ms: PERIOD_MS,
        }
    }
}
