use nalgebra::Vector2;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_estimation_traits::{Pose2, Pose3};

use super::{
    CameraSimulator, LampSetting, LeagueParams, LeaguePicture, LeagueScene, LeagueVenue, LeggedRobot,
    LinearRgb, SceneSurface, UnmappedObjects, field_map, landmarks,
};
use crate::SimulationError;
use crate::random::deviate::uniform;
use crate::random::{GaussMarkovProcess, RandomStreamPurpose, RandomStreams};

/// One frame with its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct LeagueFrame {
    /// Middle of the exposure, milliseconds after the start.
    pub milliseconds: u64,
    /// Odometry since the last frame, and its time (just before the shutter opens, milliseconds after the start); `None` at the first
    /// frame.
    pub odometry: Option<(u64, Pose2<f64>)>,
    /// True pose.
    pub pose: Pose2<f64>,
    /// Pose of the camera from the joint angles, in the robot frame on the ground.
    pub mount: Pose3<f64>,
    /// True pose of the camera in the world.
    pub camera_pose: Pose3<f64>,
    /// The light.
    pub lighting: LampSetting,
    /// The image with its true labels.
    pub picture: LeaguePicture,
}

/// Iterator over the frames of a drive.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::{league::{LeagueParams, LeagueDrive}, random::RandomStreams};
/// let params = LeagueParams { n_frames: 3, ..LeagueParams::default() };
/// let drive = LeagueDrive::new(&params, RandomStreams::new(ChaCha8Rng::seed_from_u64(1)))?;
/// let stamps: Vec<u64> = drive.map(|frame| frame.milliseconds).collect();
/// assert_eq!(stamps, [100, 200, 300]);
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
pub struct LeagueDrive {
    params: LeagueParams,
    streams: RandomStreams,
    venue: LeagueVenue,
    map: Vec<SceneSurface>,
    things: UnmappedObjects,
    robot: LeggedRobot,
    camera_simulator: CameraSimulator,
    /// Of red and of blue.
    balance: [GaussMarkovProcess; 2],
    milliseconds: u64,
    n_taken: usize,
}

/// The odometry is sent this long before the shutter opens.
const ODOMETRY_LEAD_MS: u64 = 1;

impl LeagueDrive {
    /// The robot at its start, the camera ready.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn new(params: &LeagueParams, mut streams: RandomStreams) -> Result<Self, SimulationError> {
        let venue = match params.venue_seed {
            Some(seed) => LeagueVenue::draw(
                RandomStreams::new(ChaCha8Rng::seed_from_u64(seed)).of(RandomStreamPurpose::Venue),
            )?,
            None => LeagueVenue::draw(streams.of(RandomStreamPurpose::Venue))?,
        };
        Self::in_venue(params, venue, streams)
    }

    /// The same in a custom venue.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn in_venue(
        params: &LeagueParams,
        mut venue: LeagueVenue,
        mut streams: RandomStreams,
    ) -> Result<Self, SimulationError> {
        params.validate(&venue.camera)?;
        venue.camera.exposure_mode = params.exposure_mode;
        if matches!(params.lamp_settings.first(), Some((0, LampSetting::Sunny))) {
            venue.expose_for_sun();
        }
        let grey = |paint: &LinearRgb| LinearRgb::repeat(paint.mean() * (1.0 - params.paint_chroma));
        venue.paints = venue.paints.map(|paint| grey(&paint) + paint * params.paint_chroma);
        let robot = LeggedRobot::new(params.robot, params.start, landmarks(), &mut streams)?;
        let camera_simulator = CameraSimulator::new(venue.camera)?;
        let drift = GaussMarkovProcess::new(venue.camera.white_balance_correlation_s);
        Ok(Self {
            map: SceneSurface::of_map(&field_map()?),
            things: UnmappedObjects::draw(streams.of(RandomStreamPurpose::UnmappedObjects)),
            robot,
            camera_simulator,
            balance: [drift.clone(), drift],
            milliseconds: 0,
            n_taken: 0,
            params: params.clone(),
            streams,
            venue,
        })
    }

    /// The venue.
    pub fn venue(&self) -> &LeagueVenue {
        &self.venue
    }

    fn walk_until(&mut self, milliseconds: u64) {
        while self.milliseconds < milliseconds {
            self.robot.step(&mut self.streams);
            self.milliseconds += 1;
        }
    }

    fn kidnap(&mut self) {
        let from = self.robot.pose().translation;
        let margin = self.params.robot.walk.min_board_distance_m;
        let rng = self.streams.of(RandomStreamPurpose::Kidnap);
        let mut to = Pose2::new(0.0, 0.0, 0.0);
        // The field is 4.2 m long: most places are far enough.
        for _ in 0..100 {
            let at = super::field::spot(margin, rng);
            to = Pose2::new(at.x, at.y, uniform(-std::f64::consts::PI, std::f64::consts::PI, rng));
            if Vector2::metric_distance(&at, &from) > 1.0 {
                break;
            }
        }
        self.robot.put(to);
    }

    fn lighting(&self) -> LampSetting {
        let past = self.params.lamp_settings.iter().take_while(|(frame, _)| *frame <= self.n_taken);
        past.last().map_or(LampSetting::Bright, |(_, lighting)| *lighting)
    }

    fn balance(&mut self) -> LinearRgb {
        let period_s = f64::from(self.params.period_ms) * 1e-3;
        let sigma = self.venue.camera.white_balance_drift_sigma;
        let rng = self.streams.of(RandomStreamPurpose::WhiteBalance);
        let [red, blue] = self.balance.each_mut().map(|x| libm::exp(sigma * x.advance(period_s, rng)));
        LinearRgb::new(red, 1.0, blue)
    }

    fn frame(&mut self) -> LeagueFrame {
        let middle = u64::from(self.params.period_ms) * (self.n_taken as u64 + 1);
        let exposure = u64::from(self.venue.camera.exposure_ms);
        let opens = middle - exposure / 2;
        let odometry = self.odometry(opens - ODOMETRY_LEAD_MS);
        if self.params.kidnap_frames.contains(&self.n_taken) {
            self.kidnap();
        }
        self.walk_until(opens);
        let opening = self.robot.camera_pose();
        self.walk_until(middle);
        let (pose, mount, camera_pose) =
            (self.robot.pose(), self.robot.reported_mount(), self.robot.camera_pose());
        self.walk_until(opens + exposure);
        let closing = self.robot.camera_pose();
        let (lighting, picture) = (self.lighting(), self.picture(&pose, [&opening, &closing]));
        LeagueFrame { milliseconds: middle, odometry, pose, mount, camera_pose, lighting, picture }
    }

    /// Ignored before the first frame.
    fn odometry(&mut self, milliseconds: u64) -> Option<(u64, Pose2<f64>)> {
        self.walk_until(milliseconds);
        let seconds = f64::from(self.params.period_ms) * 1e-3;
        let moved = self.robot.odometry(seconds, &mut self.streams);
        (self.n_taken > 0).then_some((milliseconds, moved))
    }

    fn picture(&mut self, pose: &Pose2<f64>, camera: [&Pose3<f64>; 2]) -> LeaguePicture {
        let mut surfaces = self.map.clone();
        if self.params.with_unmapped_objects {
            surfaces.extend(self.things.surfaces(self.milliseconds as f64 * 1e-3, pose));
        }
        let balance = self.balance();
        let scene = LeagueScene {
            surfaces,
            paints: &self.venue.paints,
            light: self.venue.light(self.lighting()),
            backdrop: &self.venue.hall,
        };
        self.camera_simulator.take(&scene, camera, &balance, self.streams.of(RandomStreamPurpose::Picture))
    }
}

impl Iterator for LeagueDrive {
    type Item = LeagueFrame;

    fn next(&mut self) -> Option<LeagueFrame> {
        if self.n_taken >= self.params.n_frames {
            return None;
        }
        let frame = self.frame();
        self.n_taken += 1;
        Some(frame)
    }
}
