use nalgebra::Vector2;
use wayfix_sensor_log::Record;

use crate::drive::WheeledRobotParams;
use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::route::RouteParams;
use crate::sensor::{
    GaussianOdometry, GaussianOdometryParams, RangeBearingDetector, RangeBearingParams, SimulatedSensor,
    WheelOdometry, WheelOdometryParams,
};
use crate::world::{FloorPlan, OtherRobot, PlanarWorld, WorldLayout};
use crate::{Simulation, SimulationError, check};

/// Everything about one drive in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarDriveParams {
    /// Landmarks and walls.
    pub layout: WorldLayout,
    /// Number of objects with unlisted codes 1000, 1001, …, placed randomly among the landmarks; at most 1000.
    pub n_unknown_codes: usize,
    /// Robots that drive about; at most 100.
    pub other_robots: Vec<OtherRobotParams>,
    /// Route of the robot.
    pub route: RouteParams,
    /// Motion of the robot.
    pub robot: WheeledRobotParams,
    /// Odometry.
    pub odometry: OdometryParams,
    /// Sensor.
    pub sensor: RangeBearingParams,
    /// Duration, milliseconds.
    pub duration_ms: u64,
    /// Time from one true pose to the next, milliseconds.
    pub truth_period_ms: u32,
}

/// A robot that is sighted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherRobotParams {
    /// Its number.
    pub id: u32,
    /// Route.
    pub route: RouteParams,
    /// Speed, m/s.
    pub speed_mps: f64,
}

/// Which odometry the robot has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OdometryParams {
    /// The textbook's.
    Gaussian(GaussianOdometryParams),
    /// Encoders.
    Wheels(WheelOdometryParams),
}

impl PlanarDriveParams {
    /// The log, in time order.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range, and [`SimulationError::NoRoom`] if objects do not fit.
    pub fn simulate(&self, streams: &mut RandomStreams) -> Result<Vec<Record>, SimulationError> {
        let route = self.route.build(streams.of(RandomStreamPurpose::Route))?;
        let plan = self.layout.build(&route, streams.of(RandomStreamPurpose::Landmarks))?;
        let world = PlanarWorld {
            unknown_codes: self.unknown_codes(&plan, streams)?,
            other_robots: self.other_robots(streams)?,
            plan,
        };
        let simulation = Simulation {
            robot: self.robot,
            duration_ms: self.duration_ms,
            truth_period_ms: self.truth_period_ms,
            ..Simulation::new(&world, route)
        };
        let looks: Box<dyn SimulatedSensor> = Box::new(RangeBearingDetector::new(self.sensor)?);
        simulation.run(&mut [self.odometry.instrument()?, looks], streams)
    }

    fn unknown_codes(
        &self,
        plan: &FloorPlan,
        streams: &mut RandomStreams,
    ) -> Result<Vec<(u32, Vector2<f64>)>, SimulationError> {
        check::count("things with unknown codes", self.n_unknown_codes, 1000)?;
        let rng = streams.of(RandomStreamPurpose::UnknownCodes);
        let points = || plan.landmarks.iter().map(|l| Vector2::new(l.x, l.y));
        let (low, high) = (points().reduce(|a, b| a.inf(&b)), points().reduce(|a, b| a.sup(&b)));
        let (low, high) = (low.unwrap_or_default(), high.unwrap_or_default());
        let anywhere = |code| {
            let x = deviate::uniform(low.x, high.x, rng);
            let y = deviate::uniform(low.y, high.y, rng);
            (code, Vector2::new(x, y))
        };
        Ok((1000..).take(self.n_unknown_codes).map(anywhere).collect())
    }

    fn other_robots(&self, streams: &mut RandomStreams) -> Result<Vec<OtherRobot>, SimulationError> {
        check::count("other robots", self.other_robots.len(), 100)?;
        let rng = streams.of(RandomStreamPurpose::OtherRobots);
        self.other_robots
            .iter()
            .map(|robot| {
                check::not_negative("speed of another robot (m/s)", robot.speed_mps)?;
                let route = robot.route.build(rng)?;
                Ok(OtherRobot { id: robot.id, route, speed_mps: robot.speed_mps })
            })
            .collect()
    }
}

impl OdometryParams {
    pub(super) fn instrument(&self) -> Result<Box<dyn SimulatedSensor>, SimulationError> {
        Ok(match self {
            Self::Gaussian(params) => Box::new(GaussianOdometry::new(*params)?),
            Self::Wheels(params) => Box::new(WheelOdometry::new(*params)?),
        })
    }
}
