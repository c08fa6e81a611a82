use wayfix_sensor_log::{Record, RecordData, Stamp, TrueWall};

use crate::drive::{DifferentialDrive, PurePursuit, WheeledRobotParams};
use crate::random::RandomStreams;
use crate::route::Route;
use crate::sensor::{SimulatedSensor, TrueState};
use crate::world::SensorWorld;
use crate::{SimulationError, check};

/// The truth is integrated at 1 kHz: two orders finer than any log.
const STEP_S: f64 = 1e-3;
/// The longest drive, milliseconds: one day.
const LONGEST_MS: u64 = 86_400_000;

/// One robot on one route through one world.
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::{Simulation, random::RandomStreams, route::CircleRoute, world::{FloorPlan, PlanarWorld}};
/// use wayfix_sensor_log::RecordData;
///
/// let world = PlanarWorld::new(FloorPlan::default());
/// let simulation = Simulation::new(&world, CircleRoute { radius_m: 2.0 }.route()?);
/// let records = simulation.run(&mut [], &mut RandomStreams::new(ChaCha8Rng::seed_from_u64(1)))?;
/// let Some(RecordData::TruePose(end)) = records.last().map(|r| &r.data) else { panic!("no truth") };
/// assert!((end.translation.norm() - 2.0).abs() < 0.05); // pursuit cuts corners by about lookahead²/(8·radius)
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone)]
pub struct Simulation<'a> {
    /// The world.
    pub world: &'a dyn SensorWorld,
    /// Route of the robot; it starts at rest at the beginning.
    pub route: Route,
    /// The robot. Default as [`WheeledRobotParams`].
    pub robot: WheeledRobotParams,
    /// Duration, milliseconds, at most a day. Default 60 000.
    pub duration_ms: u64,
    /// Time from one true pose in the log to the next, milliseconds. Default 100.
    pub truth_period_ms: u32,
    /// Whether the walls go to the log as truth, after the landmarks and numbered from 0. Default false.
    pub true_walls: bool,
    /// Stamp of the start. Default 1.6e9 s, as on the clock of a robot's computer, to expose stamps stored in too few bits.
    pub start: Stamp,
}

impl<'a> Simulation<'a> {
    /// The defaults, for a world and a route.
    pub fn new(world: &'a dyn SensorWorld, route: Route) -> Self {
        Self {
            world,
            route,
            robot: WheeledRobotParams::default(),
            duration_ms: 60_000,
            truth_period_ms: 100,
            true_walls: false,
            start: Stamp::from_nanoseconds(1_600_000_000_000_000_000),
        }
    }

    /// Runs the simulation and returns the log in time order; at equal stamps truth comes first, then `sensors` in their order.
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range; `streams` is then unchanged.
    pub fn run(
        &self,
        sensors: &mut [Box<dyn SimulatedSensor>],
        streams: &mut RandomStreams,
    ) -> Result<Vec<Record>, SimulationError> {
        self.validate(sensors)?;
        let mut robot = DifferentialDrive::new(self.robot, self.route.at(0.0))?;
        let mut driver = PurePursuit::default();
        let mut records = self.surveyed();
        for milliseconds in 0..=self.duration_ms {
            let moment = TrueState {
                milliseconds,
                pose: robot.pose(),
                wheel_angles: robot.wheel_angles(),
                world: self.world,
            };
            self.log(&moment, sensors, streams, &mut records);
            let (linear, angular) = driver.command(STEP_S, &self.route, &robot.pose(), &self.robot);
            robot.step(STEP_S, linear, angular, streams);
        }
        records.sort_by_key(|record| record.stamp);
        Ok(records)
    }

    fn validate(&self, sensors: &[Box<dyn SimulatedSensor>]) -> Result<(), SimulationError> {
        if self.duration_ms > LONGEST_MS {
            let what = "milliseconds of driving";
            return Err(SimulationError::TooMany { what, limit: LONGEST_MS, got: self.duration_ms });
        }
        check::period("period of the true poses (ms)", self.truth_period_ms)?;
        sensors.iter().try_for_each(|sensor| check::period("period of a sensor (ms)", sensor.period_ms()))
    }

    /// Static objects with their true positions.
    fn surveyed(&self) -> Vec<Record> {
        let walls = if self.true_walls { self.world.walls() } else { Vec::new() };
        let walls = walls.iter().zip(0..).map(|(wall, id)| TrueWall { id, start: wall.from, end: wall.to });
        let landmarks = self.world.landmarks().into_iter().map(RecordData::TrueLandmark);
        landmarks
            .chain(walls.map(RecordData::TrueWall))
            .map(|data| Record { stamp: self.start, data })
            .collect()
    }

    /// Whatever is due at this moment.
    fn log(
        &self,
        moment: &TrueState<'_>,
        sensors: &mut [Box<dyn SimulatedSensor>],
        streams: &mut RandomStreams,
        records: &mut Vec<Record>,
    ) {
        let is_due = |period_ms: u32| moment.milliseconds.is_multiple_of(u64::from(period_ms));
        if is_due(self.truth_period_ms) {
            records.push(Record { stamp: self.stamp(moment, 0), data: RecordData::TruePose(moment.pose) });
        }
        for sensor in sensors.iter_mut().filter(|sensor| is_due(sensor.period_ms())) {
            if let Some(reading) = sensor.sense(moment, streams) {
                records
                    .push(Record { stamp: self.stamp(moment, reading.stamp_offset_ms), data: reading.data });
            }
        }
    }

    fn stamp(&self, moment: &TrueState<'_>, stamp_offset_ms: i64) -> Stamp {
        let after_start = moment.milliseconds.saturating_add_signed(stamp_offset_ms);
        Stamp::from_nanoseconds(
            self.start.nanoseconds().saturating_add(after_start.saturating_mul(1_000_000)),
        )
    }
}
