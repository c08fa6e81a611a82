use wayfix_estimation_traits::{Pose2, Pose3};
use wayfix_particle::RaoBlackwellParticle;

use super::{CameraError, light::Light};

/// Where the camera is, in six degrees of freedom: where the robot stands, and how far the camera is from where the joints say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraLocation {
    /// Where the robot stands.
    pub body: Pose2<f64>,
    /// How far the camera is from where the joints say.
    pub error: CameraError,
}

impl CameraLocation {
    /// The camera in the world, when joints report it at `mount` in the robot's frame.
    pub fn camera_pose(&self, mount: &Pose3<f64>) -> Pose3<f64> {
        self.error.camera_pose(&self.body, mount)
    }
}

/// One hypothesis: a camera location and, conditioned on it, what the colours look like. [Schulz & Fox 2004, Eq. 12]
pub(crate) type ColorParticle = RaoBlackwellParticle<CameraLocation, Light>;
