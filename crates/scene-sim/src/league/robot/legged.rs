use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};

use super::head::Head;
use super::odometry::GaitOdometry;
use super::walker::{Walker, advance_phase};
use super::{BodySwayParams, LeggedRobotParams};
use crate::random::{GaussMarkovProcess, RandomStreamPurpose, RandomStreams};
use crate::{SimulationError, space};

/// The neck in the robot's frame on the ground, metres.
const NECK_M: [f64; 3] = [0.07, 0.0, 0.19];
/// The camera in the frame of the head, metres.
const NOSE_M: [f64; 3] = [0.08, 0.0, 0.03];
/// Correlation time of the slow part of the sway, seconds.
const UNSTEADY_S: f64 = 1.0;

/// A four-legged robot that walks and turns its camera, simulated in steps of a millisecond.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_scene_sim::{league::{LeggedRobot, LeggedRobotParams, landmarks}, random::RandomStreams};
/// let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(1));
/// let start = Pose2::new(0.0, 0.0, 0.0);
/// let mut robot = LeggedRobot::new(LeggedRobotParams::default(), Some(start), landmarks(), &mut streams)?;
/// (0..10_000).for_each(|_| robot.step(&mut streams));
/// assert!((robot.pose().translation - start.translation).norm() > 0.2, "it walks");
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LeggedRobot {
    walker: Walker,
    head: Head,
    odometry: GaitOdometry,
    landmarks: Vec<Vector3<f64>>,
    sway: BodySwayParams,
    /// Phase of the stride, radians.
    phase: f64,
    /// Strength of the sway, smoothed.
    strength: f64,
    unsteady: [GaussMarkovProcess; 2],
    /// Roll and pitch beside the gait's, radians.
    slow: [f64; 2],
}

const STEP_S: f64 = 1e-3;

impl LeggedRobot {
    /// A robot at rest at `start`, or at a random pose; its camera points at `landmarks`.
    /// # Errors
    /// Returns [`SimulationError::Parameter`] if a parameter is out of range.
    pub fn new(
        params: LeggedRobotParams,
        start: Option<Pose2<f64>>,
        landmarks: Vec<Vector3<f64>>,
        streams: &mut RandomStreams,
    ) -> Result<Self, SimulationError> {
        params.validate()?;
        let anywhere = Walker::anywhere(&params.walk, streams.of(RandomStreamPurpose::Walk));
        let slow = GaussMarkovProcess::new(UNSTEADY_S);
        Ok(Self {
            walker: Walker::new(params.walk, start.unwrap_or(anywhere)),
            head: Head::new(params.head, streams.of(RandomStreamPurpose::Joints)),
            odometry: GaitOdometry::new(params.odometry, streams.of(RandomStreamPurpose::Gait)),
            landmarks,
            sway: params.sway,
            phase: 0.0,
            strength: 0.0,
            unsteady: [slow.clone(), slow],
            slow: [0.0; 2],
        })
    }

    /// Lets a millisecond pass.
    pub fn step(&mut self, streams: &mut RandomStreams) {
        let moved = self.walker.step(STEP_S, streams.of(RandomStreamPurpose::Walk));
        self.odometry.add(&moved);
        self.head.step(STEP_S, &self.walker.pose, &self.landmarks, streams.of(RandomStreamPurpose::Gaze));
        self.strength += (self.walker.activity().min(1.0) - self.strength) * 0.01;
        self.phase = advance_phase(self.phase, TAU * STEP_S / self.sway.stride_period_s);
        self.wobble(streams);
    }

    /// True pose.
    pub fn pose(&self) -> Pose2<f64> {
        self.walker.pose
    }

    /// True pose of the camera in the world (x along the optical axis).
    pub fn camera_pose(&self) -> Pose3<f64> {
        let (sin, _) = libm::sincos(self.phase);
        let (sin_twice, cos_twice) = libm::sincos(2.0 * self.phase);
        let lift = Vector3::z() * (self.strength * self.sway.height_amplitude_m * cos_twice);
        let roll = self.slow[0] + self.strength * self.sway.roll_amplitude_rad * sin;
        let pitch = self.slow[1] + self.strength * self.sway.pitch_amplitude_rad * sin_twice;
        let body = Pose3 { translation: lift, rotation: space::pitch(pitch) * space::roll(roll) };
        let camera = body.compose(&mounted(self.head.true_rotation()));
        space::on_ground(&self.walker.pose).compose(&camera)
    }

    /// Camera pose according to the joint angles, in the robot frame on the ground, in the nominal stance.
    pub fn reported_mount(&self) -> Pose3<f64> {
        mounted(self.head.reported_rotation())
    }

    /// Odometry since the last call.
    pub fn odometry(&mut self, seconds: f64, streams: &mut RandomStreams) -> Pose2<f64> {
        self.odometry.take(seconds, streams.of(RandomStreamPurpose::Gait))
    }

    /// Kidnaps the robot; its odometry does not measure it.
    pub fn put(&mut self, pose: Pose2<f64>) {
        self.walker.put(pose);
        self.head.settle(&pose);
    }

    /// The slow part of the sway.
    fn wobble(&mut self, streams: &mut RandomStreams) {
        let rng = streams.of(RandomStreamPurpose::Joints);
        for (slow, process) in self.slow.iter_mut().zip(&mut self.unsteady) {
            *slow = self.sway.tilt_error_sigma_rad * process.advance(STEP_S, rng);
        }
    }
}

fn mounted(rotation: UnitQuaternion<f64>) -> Pose3<f64> {
    Pose3 { translation: Vector3::from(NECK_M) + rotation * Vector3::from(NOSE_M), rotation }
}
