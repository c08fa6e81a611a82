use wayfix_sensor_log::Record;

use super::{OdometryParams, Scenario, ScenarioParams};
use crate::drive::{WheelSlipParams, WheeledRobotParams};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::route::{RoundedRectangleRoute, RouteParams};
use crate::sensor::laser::People;
use crate::sensor::{Laser, LaserParams, WheelOdometryParams};
use crate::world::{OfficeFloor, PlanarWorld, WorldLayout};
use crate::{Simulation, SimulationError};

/// Everything about one drive with a laser; the log has the walls as truth.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserDriveParams {
    /// Walls.
    pub layout: WorldLayout,
    /// Route of the robot.
    pub route: RouteParams,
    /// Motion of the robot.
    pub robot: WheeledRobotParams,
    /// Odometry.
    pub odometry: OdometryParams,
    /// Laser.
    pub laser: LaserParams,
    /// Duration, milliseconds.
    pub duration_ms: u64,
    /// Time from one true pose to the next, milliseconds.
    pub truth_period_ms: u32,
}

impl LaserDriveParams {
    /// The log, in time order.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range, and [`SimulationError::NoRoom`] if objects do not fit.
    pub fn simulate(&self, streams: &mut RandomStreams) -> Result<Vec<Record>, SimulationError> {
        let route = self.route.build(streams.of(RandomStreamPurpose::Route))?;
        let world = PlanarWorld::new(self.layout.build(&route, streams.of(RandomStreamPurpose::Landmarks))?);
        let simulation = Simulation {
            robot: self.robot,
            duration_ms: self.duration_ms,
            truth_period_ms: self.truth_period_ms,
            true_walls: true,
            ..Simulation::new(&world, route)
        };
        let odometry = self.odometry.instrument()?;
        simulation.run(&mut [odometry, Box::new(Laser::new(self.laser)?)], streams)
    }
}

/// One lap of a loop of 90 m on an office floor of 303 m², as in [Andrade-Cetto 2005, Fig. 7], and nearly 4 m beyond its start. The wheels
/// differ by 0.13 %, which alone turns the odometry by 22° per lap. The scan period of a quarter of a second keeps the log below 3 MB.
pub(super) fn office_laser() -> Scenario {
    let params = LaserDriveParams {
        layout: WorldLayout::OfficeFloor(OfficeFloor {
            length_m: 28.4,
            width_m: 17.4,
            corridor_m: 2.0,
            n_rooms: 5,
            room_m: 4.0,
            room_depth_m: 3.0,
            door_m: 0.9,
            spacing_m: 5.0,
        }),
        route: RouteParams::RoundedRectangle(RoundedRectangleRoute {
            length_m: 28.4,
            width_m: 17.4,
            corner_radius_m: 1.0,
        }),
        robot: WheeledRobotParams {
            speed_mps: 0.8,
            left_radius_error: 0.0008,
            right_radius_error: -0.0005,
            wheel_separation_error: 0.01,
            slip: WheelSlipParams { slip_sigma: 0.03, correlation_time_s: 1.0, wheel_correlation: 0.5 },
            ..WheeledRobotParams::default()
        },
        odometry: OdometryParams::Wheels(WheelOdometryParams {
            period_ms: 250,
            ..WheelOdometryParams::default()
        }),
        laser: LaserParams {
            period_ms: 250,
            dropout_share: 0.01,
            spurious_share: 0.01,
            people: People { mean: 0.5, ..People::default() },
            ..LaserParams::default()
        },
        duration_ms: 118_000,
        truth_period_ms: 250,
    };
    Scenario { name: "office_laser", seed: 7, params: ScenarioParams::Laser(Box::new(params)) }
}
