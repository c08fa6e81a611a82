use nalgebra::{UnitQuaternion, Vector2, Vector3};
use rand::Rng;
use wayfix_estimation_traits::Pose2;

use super::RobotHeadParams;
use crate::random::deviate::{chance, normal, uniform};
use crate::{plane, space};

/// Gaze of the robot.
#[derive(Clone, Debug)]
pub(super) struct Head {
    params: RobotHeadParams,
    /// Pan (to the left) and tilt (down), radians.
    angles: Vector2<f64>,
    rates: Vector2<f64>,
    target: Target,
    left_s: f64,
    /// Number of gazes at each landmark.
    n_looks: Vec<u32>,
    /// Constant errors of pan, tilt and roll.
    biases: [f64; 3],
}

#[derive(Clone, Copy, Debug)]
enum Target {
    Point(Vector3<f64>),
    Angles(Vector2<f64>),
}

/// Height of the camera in the nominal stance, m, for aiming only.
const EYE_M: f64 = 0.22;
/// Furthest tilt, up and down, radians.
const TILT_LIMITS_RAD: [f64; 2] = [-0.35, 0.8];
/// Angle below the target of the gaze, to have the carpet in view too, rad.
const AIM_BELOW_RAD: f64 = 0.12;

impl Head {
    pub(super) fn new<R: Rng + ?Sized>(params: RobotHeadParams, rng: &mut R) -> Self {
        Self {
            params,
            angles: Vector2::new(0.0, AIM_BELOW_RAD),
            rates: Vector2::zeros(),
            target: Target::Angles(Vector2::zeros()),
            left_s: 0.0,
            n_looks: Vec::new(),
            biases: [(); 3].map(|()| params.angle_bias_sigma_rad * normal(rng)),
        }
    }

    /// Advances the time: turns towards the target, and occasionally chooses another among `landmarks`.
    pub(super) fn step<R: Rng + ?Sized>(
        &mut self,
        step_s: f64,
        body: &Pose2<f64>,
        landmarks: &[Vector3<f64>],
        rng: &mut R,
    ) {
        self.left_s -= step_s;
        if self.left_s <= 0.0 {
            self.target = self.choose(body, landmarks, rng);
            self.left_s = 0.2 + self.params.mean_gaze_duration_s * uniform(0.5, 1.5, rng);
        }
        let wanted = self.wanted(body);
        let top = self.params.speed_radps;
        let rates = ((wanted - self.angles) * 12.0).map(|rate| rate.clamp(-top, top));
        self.rates += (rates - self.rates) * (step_s / (0.02 + step_s));
        self.angles += self.rates * step_s;
    }

    /// Turns to the target at once.
    pub(super) fn settle(&mut self, body: &Pose2<f64>) {
        self.angles = self.wanted(body);
        self.rates = Vector2::zeros();
    }

    /// From the frame of the neck to that of the camera.
    pub(super) fn true_rotation(&self) -> UnitQuaternion<f64> {
        let [pan, tilt, roll] = self.biases;
        space::yaw(self.angles.x + pan) * space::pitch(self.angles.y + tilt) * space::roll(roll)
    }

    /// The rotation according to the joint angles.
    pub(super) fn reported_rotation(&self) -> UnitQuaternion<f64> {
        let old = self.angles - self.rates * self.params.angle_latency_s;
        let quantum = self.params.angle_resolution_rad;
        let said = old.map(|angle| if quantum > 0.0 { (angle / quantum).round() * quantum } else { angle });
        space::yaw(said.x) * space::pitch(said.y)
    }

    fn wanted(&self, body: &Pose2<f64>) -> Vector2<f64> {
        let angles = match self.target {
            Target::Angles(angles) => angles,
            Target::Point(point) => {
                let (range, bearing) = plane::range_and_bearing(body, &point.xy());
                Vector2::new(bearing, AIM_BELOW_RAD + libm::atan2(EYE_M - point.z, range))
            }
        };
        let pan = self.params.pan_limit_rad;
        Vector2::new(angles.x.clamp(-pan, pan), angles.y.clamp(TILT_LIMITS_RAD[0], TILT_LIMITS_RAD[1]))
    }

    /// The visible landmark with the fewest gazes, or the carpet; with no landmark in reach, to one side.
    fn choose<R: Rng + ?Sized>(
        &mut self,
        body: &Pose2<f64>,
        landmarks: &[Vector3<f64>],
        rng: &mut R,
    ) -> Target {
        let (down, aside) = (chance(self.params.downward_gaze_share, rng), uniform(-1.0, 1.0, rng));
        self.n_looks.resize(landmarks.len(), 0);
        let in_reach =
            |at: &Vector3<f64>| plane::range_and_bearing(body, &at.xy()).1.abs() < self.params.pan_limit_rad;
        let candidates = self.n_looks.iter_mut().zip(landmarks).filter(|(_, at)| in_reach(at));
        match candidates.min_by_key(|(n_looks, _)| **n_looks) {
            Some((n_looks, at)) if !down => {
                *n_looks += 1;
                Target::Point(*at)
            }
            _ => Target::Angles(Vector2::new(aside, if down { 0.5 } else { AIM_BELOW_RAD })),
        }
    }
}
