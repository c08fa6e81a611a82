use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::RecordData;

use super::ambient_light::AmbientLight;
use super::params::IndoorDriveParams;
use super::rooms::building::Building;
use super::rooms::crowd::Crowd;
use super::view::ViewRenderer;
use crate::drive::{DifferentialDrive, PurePursuit};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::route::Route;
use crate::scenery::RgbPicture;
use crate::sensor::{SimulatedSensor, TrueState, WheelOdometry};
use crate::{SimulationError, check};

/// Time between two steps of the integration, milliseconds.
const STEP_MS: u64 = 10;

/// One view with its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct IndoorDriveStep {
    /// Since the start.
    pub milliseconds: u64,
    /// Odometry since the last view, in the robot frame before; `None` at the first.
    pub odometry: Option<Pose2<f64>>,
    /// True pose of the robot.
    pub pose: Pose2<f64>,
    /// The view, with the parameters [`OmniCameraParams`](super::OmniCameraParams).
    pub view: RgbPicture,
}

/// A drive through a building, view by view, until shortly before the end of the route.
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::{indoors::{IndoorDrive, IndoorDriveParams, RetailStore, RetailStoreParams}, random::RandomStreams};
/// let mut rng = ChaCha8Rng::seed_from_u64(1);
/// let building = RetailStore::draw(RetailStoreParams::area(), &mut rng)?.building();
/// let route = building.aisles().tour(30.0, &mut rng)?;
/// let drive = IndoorDrive::new(&building, route, IndoorDriveParams::default(), RandomStreams::new(rng))?;
/// let steps: Vec<_> = drive.collect();
/// let odometry: f64 = steps.iter().filter_map(|step| step.odometry).map(|moved| moved.translation.norm()).sum();
/// assert!(odometry > 25.0 && steps[0].view.rgb.len() == 3 * 120 * 20);
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
pub struct IndoorDrive<'a> {
    building: &'a Building,
    route: Route,
    params: IndoorDriveParams,
    streams: RandomStreams,
    robot: DifferentialDrive,
    driver: PurePursuit,
    wheels: WheelOdometry,
    crowd: Crowd,
    ambient_light: AmbientLight,
    view_renderer: ViewRenderer,
    milliseconds: u64,
    n_left: usize,
}

impl<'a> IndoorDrive<'a> {
    /// The robot at the start of its route.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn new(
        building: &'a Building,
        route: Route,
        params: IndoorDriveParams,
        mut streams: RandomStreams,
    ) -> Result<Self, SimulationError> {
        params.validate()?;
        let step_m = params.robot.speed_mps * f64::from(params.view_period_ms) * 1e-3;
        check::positive("distance between two views (m)", step_m)?;
        let crowd = Crowd::draw(params.n_people, &building.aisles, streams.of(RandomStreamPurpose::Crowd));
        let ambient_light =
            AmbientLight::new(params.ambient_light, building.n_lamps, building.n_curtains, &mut streams);
        Ok(Self {
            building,
            robot: DifferentialDrive::new(params.robot, route.at(0.0))?,
            driver: PurePursuit::default(),
            wheels: WheelOdometry::new(params.odometry())?,
            view_renderer: ViewRenderer::new(params.camera)?,
            n_left: (route.length_m() / step_m) as usize,
            milliseconds: 0,
            route,
            params,
            streams,
            crowd,
            ambient_light,
        })
    }

    fn advance(&mut self, seconds: f64) {
        let pose = self.robot.pose();
        let (linear, angular) = self.driver.command(seconds, &self.route, &pose, &self.params.robot);
        self.robot.step(seconds, linear, angular, &mut self.streams);
        self.milliseconds += STEP_MS;
    }

    fn step(&mut self) -> IndoorDriveStep {
        let pose = self.robot.pose();
        let moment = TrueState {
            milliseconds: self.milliseconds,
            pose,
            wheel_angles: self.robot.wheel_angles(),
            world: self.building,
        };
        let odometry = match self.wheels.sense(&moment, &mut self.streams).map(|reading| reading.data) {
            Some(RecordData::OdometryIncrement(moved)) => Some(moved),
            _ => None,
        };
        let people: Vec<_> = self.crowd.standing(&self.building.aisles, pose.translation).collect();
        let rng = self.streams.of(RandomStreamPurpose::Picture);
        let view = self.view_renderer.render_view(self.building, &self.ambient_light, &people, &pose, rng);
        IndoorDriveStep { milliseconds: self.milliseconds, odometry, pose, view }
    }
}

impl Iterator for IndoorDrive<'_> {
    type Item = IndoorDriveStep;

    fn next(&mut self) -> Option<IndoorDriveStep> {
        self.n_left = self.n_left.checked_sub(1)?;
        let step = self.step();
        let period_ms = u64::from(self.params.view_period_ms);
        let seconds = period_ms as f64 * 1e-3;
        for _ in 0..period_ms / STEP_MS {
            self.advance(STEP_MS as f64 * 1e-3);
        }
        self.crowd.advance(seconds, &self.building.aisles, self.streams.of(RandomStreamPurpose::Crowd));
        self.ambient_light.advance(seconds, &mut self.streams);
        Some(step)
    }
}
