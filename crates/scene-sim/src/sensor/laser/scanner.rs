use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{LaserScan, RecordData};

use super::LaserParams;
use super::people::Person;
use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::sensor::{SensorReading, SimulatedSensor, TrueState};
use crate::world::Wall;
use crate::{SimulationError, plane};

/// The instrument to [`LaserParams`], at the robot's origin.
///
/// Every scan draws the same number of deviates for every beam, whatever it hits.
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_estimation_traits::{Pose2, nalgebra::Vector2};
/// use wayfix_scene_sim::{random::RandomStreams, sensor::{Laser, LaserParams, TrueState, SimulatedSensor}, world::{FloorPlan, PlanarWorld, Wall}};
/// use wayfix_sensor_log::RecordData;
///
/// let ahead = Wall { from: Vector2::new(3.0, -1.0), to: Vector2::new(3.0, 1.0) };
/// let world = PlanarWorld::new(FloorPlan { landmarks: vec![], walls: vec![ahead] });
/// let pose = Pose2::new(0.0, 0.0, 0.0);
/// let moment = TrueState { milliseconds: 0, pose, wheel_angles: [0.0; 2], world: &world };
/// let mut laser = Laser::new(LaserParams::default())?;
/// let reading = laser.sense(&moment, &mut RandomStreams::new(ChaCha8Rng::seed_from_u64(1)));
/// let Some(RecordData::Scan(scan)) = reading.map(|r| r.data) else { panic!("no scan") };
/// assert!((scan.ranges[90] - 3.0).abs() < 0.03); // straight ahead: 5σ and half a quantum
/// assert_eq!(scan.echoes().count(), 37); // those within atan(1/3) = 18.4°
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Laser {
    params: LaserParams,
}

/// A surface is smooth where the beam's middle is within this of the mean of its two edges, metres; else there is an edge.
const SMOOTH_M: f64 = 0.1;

impl Laser {
    /// A scanner.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn new(params: LaserParams) -> Result<Self, SimulationError> {
        params.validate()?;
        Ok(Self { params })
    }

    /// Reported range of a beam.
    fn range(&self, bearing: f64, scene: &LeagueScene<'_>, errors: &Errors) -> f64 {
        let hit = self.hit(bearing + self.params.bearing_sigma_rad * errors.direction, scene, errors);
        let Some(hit) = hit.filter(|hit| *hit <= self.params.max_range_m && !errors.lost) else {
            return self.params.no_echo_range_m;
        };
        let range = match errors.spurious {
            Some(share) => share * hit,
            None => hit + self.params.range_bias_m + self.params.range_noise.at(hit) * errors.range,
        };
        quantized(range, self.params.range_resolution_m).clamp(0.0, self.params.max_range_m)
    }

    /// Length of the beam: to the surface in its middle, or at an edge to a point between the two surfaces that it hits.
    fn hit(&self, bearing: f64, scene: &LeagueScene<'_>, errors: &Errors) -> Option<f64> {
        let half = 0.5 * self.params.beam_width_rad;
        let middle = scene.distance(bearing);
        let edges = scene.distance(bearing - half).zip(scene.distance(bearing + half));
        match (middle, edges, errors.mixed) {
            (Some(middle), Some((right, left)), Some(share))
                if (middle - 0.5 * (right + left)).abs() > SMOOTH_M =>
            {
                Some(right + share * (left - right))
            }
            _ => middle,
        }
    }
}

impl SimulatedSensor for Laser {
    fn period_ms(&self) -> u32 {
        self.params.period_ms
    }

    fn sense(&mut self, moment: &TrueState<'_>, streams: &mut RandomStreams) -> Option<SensorReading> {
        let LaserParams { first_beam_rad, beam_step_rad, n_beams, no_echo_range_m: no_echo_m, .. } =
            self.params;
        let mut scan = LaserScan {
            angle_min: first_beam_rad,
            angle_increment: beam_step_rad,
            range_max: no_echo_m,
            beam_period: 0.0,
            ranges: vec![],
        };
        let people = self.params.people.draw(first_beam_rad, scan.bearing(n_beams), streams);
        let scene = LeagueScene { pose: moment.pose, walls: &moment.world.walls(), people: &people };
        scan.ranges = (0..n_beams)
            .map(|beam| self.range(scan.bearing(beam), &scene, &Errors::draw(&self.params, streams)))
            .collect();
        Some(SensorReading { data: RecordData::Scan(scan), stamp_offset_ms: 0 })
    }
}

/// The surfaces.
struct LeagueScene<'a> {
    pose: Pose2<f64>,
    walls: &'a [Wall],
    people: &'a [Person],
}

impl LeagueScene<'_> {
    /// To the nearest surface in a direction of the robot's frame.
    fn distance(&self, bearing: f64) -> Option<f64> {
        let (in_world, in_body): (Vector2<f64>, Vector2<f64>) =
            (plane::direction(self.pose.heading() + bearing), plane::direction(bearing));
        let walls = self.walls.iter().filter_map(|wall| wall.distance(&self.pose.translation, &in_world));
        let people = self.people.iter().filter_map(|person| person.distance(&in_body));
        walls.chain(people).reduce(f64::min)
    }
}

/// All random numbers of one beam, drawn before its surface is known.
struct Errors {
    direction: f64,
    range: f64,
    /// Position between the two surfaces, if the beam mixes them.
    mixed: Option<f64>,
    lost: bool,
    /// Share of the distance at which a particle reflects the beam, if any.
    spurious: Option<f64>,
}

impl Errors {
    fn draw(params: &LaserParams, streams: &mut RandomStreams) -> Self {
        let direction = deviate::normal(streams.of(RandomStreamPurpose::BearingNoise));
        let range = params.noise_shape.draw(streams.of(RandomStreamPurpose::RangeNoise));
        let lost = deviate::chance(params.dropout_share, streams.of(RandomStreamPurpose::Dropout));
        let mut share_if = |share, source| {
            let rng = streams.of(source);
            let (happens, where_between) = (deviate::chance(share, rng), deviate::unit(rng));
            happens.then_some(where_between)
        };
        let mixed = share_if(params.mixed_pixel_share, RandomStreamPurpose::MixedPixels);
        let spurious = share_if(params.spurious_share, RandomStreamPurpose::Clutter);
        Self { direction, range, mixed, lost, spurious }
    }
}

fn quantized(range: f64, quantum_m: f64) -> f64 {
    if quantum_m > 0.0 { (range / quantum_m).round() * quantum_m } else { range }
}
