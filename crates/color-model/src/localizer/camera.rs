use nalgebra::{Vector3, Vector4, Vector6};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{Manifold, Pose2, Pose3};

/// Difference between the camera's pose and the pose that the joints report.
///
/// With the body's planar pose these make the six degrees of freedom of the camera's location in [Schulz & Fox 2004, IV].
/// ```
/// use nalgebra::Vector3;
/// use wayfix_color_model::CameraPoseError;
/// use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
/// let tilted = CameraPoseError { rotation: Vector3::new(0.0, 0.1, 0.0), height: 0.0 };
/// let camera = tilted.camera_pose(&Pose2::identity(), &Pose3::identity());
/// assert!((camera.rotation * Vector3::x()).z < 0.0); // a positive tilt points down
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraPoseError {
    /// Rotation about the camera's x, y and z axes: roll, tilt (positive is down) and pan (positive is left), rad.
    pub rotation: Vector3<f64>,
    /// Height above the reported one, m.
    pub height: f64,
}

impl CameraPoseError {
    /// The camera in the world, of a robot at `body` whose joints report the camera at `mount` in the robot's frame.
    pub fn camera_pose(&self, body: &Pose2<f64>, mount: &Pose3<f64>) -> Pose3<f64> {
        let (sin, cos) = (0.5 * body.heading()).sin_cos();
        let turn = nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(cos, 0.0, 0.0, sin));
        let position = turn * mount.translation + body.translation.push(self.height);
        let looking = Pose3 { translation: position, rotation: turn * mount.rotation };
        let [roll, tilt, pan] = self.rotation.into();
        looking.retract(&Vector6::new(0.0, 0.0, 0.0, roll, tilt, pan))
    }
}

/// Standard deviations of [`CameraPoseError`], and how long an error lasts.
/// ```
/// use rand::SeedableRng;
/// use wayfix_color_model::{CameraPoseError, CameraPoseNoise};
/// let noise = CameraPoseNoise { rotation_sigma: 0.0, height_sigma: 0.0, correlation_time: 0.2 };
/// let error = CameraPoseError { height: 0.01, ..CameraPoseError::default() };
/// let later = noise.after(&error, 0.2, &mut rand_chacha::ChaCha8Rng::seed_from_u64(1));
/// assert!((later.height - 0.01 * (-1.0_f64).exp()).abs() < 1e-15); // no new error is added
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CameraPoseNoise {
    /// Standard deviation of roll, tilt and pan, rad. Default 0.025: the body of a walking four-legged robot sways by 1° to 2°.
    pub rotation_sigma: f64,
    /// Standard deviation of the height, m. Default 0.008: a body on four legs goes up and down by a centimetre.
    pub height_sigma: f64,
    /// Time constant of the errors' correlation, s; 0 draws independent errors for each frame. Default 0.2: half a step of the gait.
    pub correlation_time: f64,
}

impl Default for CameraPoseNoise {
    fn default() -> Self {
        Self { rotation_sigma: 0.025, height_sigma: 0.008, correlation_time: 0.2 }
    }
}

impl CameraPoseNoise {
    /// The error `seconds` later: $`e' = ρ e + \sqrt{1 - ρ^2}\, n`$, $`ρ = e^{-t/τ}`$, with constant standard deviations.
    pub fn after<R: Rng + ?Sized>(
        &self,
        error: &CameraPoseError,
        seconds: f64,
        rng: &mut R,
    ) -> CameraPoseError {
        let rho = if self.correlation_time > 0.0 { (-seconds / self.correlation_time).exp() } else { 0.0 };
        let fresh = (1.0 - rho * rho).sqrt();
        let drawn = self.sample(rng);
        CameraPoseError {
            rotation: error.rotation * rho + drawn.rotation * fresh,
            height: error.height * rho + drawn.height * fresh,
        }
    }

    /// A draw from the distribution of errors.
    pub fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> CameraPoseError {
        self.scaled(&Vector4::from_fn(|_, _| rng.sample(StandardNormal)))
    }

    /// The error with these standard normal deviates.
    pub(crate) fn scaled(&self, deviates: &Vector4<f64>) -> CameraPoseError {
        CameraPoseError {
            rotation: deviates.xyz() * self.rotation_sigma,
            height: deviates.w * self.height_sigma,
        }
    }
}

/// The camera's location in six degrees of freedom: the planar body pose and the error of the camera's mount.
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_color_model::{CameraLocation, CameraPoseError};
/// # use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
/// let mount = Pose3 { translation: Vector3::new(0.1, 0.0, 0.2), ..Pose3::identity() }; // in front of the body and above it
/// let error = CameraPoseError { height: 0.01, ..CameraPoseError::default() };
/// let location = CameraLocation { body: Pose2::new(1.0, 2.0, std::f64::consts::FRAC_PI_2), error };
/// assert!((location.camera_pose(&mount).translation - Vector3::new(1.0, 2.1, 0.21)).norm() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraLocation {
    /// Pose of the body on the ground.
    pub body: Pose2<f64>,
    /// Difference between the camera's pose and the pose that the joints report.
    pub error: CameraPoseError,
}

impl CameraLocation {
    /// Pose of the camera in the world, if the joints report it at `mount` in the body frame.
    pub fn camera_pose(&self, mount: &Pose3<f64>) -> Pose3<f64> {
        self.error.camera_pose(&self.body, mount)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn the_camera_rides_on_the_body() {
        let mount = Pose3 { translation: Vector3::new(0.1, 0.0, 0.2), rotation: UnitQuaternion::identity() };
        let body = Pose2::new(1.0, 2.0, std::f64::consts::FRAC_PI_2);
        let error = CameraPoseError { rotation: Vector3::new(0.0, 0.1, 0.0), height: 0.01 };
        let camera = error.camera_pose(&body, &mount);
        assert!((camera.translation - Vector3::new(1.0, 2.1, 0.21)).norm() < 1e-12);
        // A positive tilt points down: the optical axis of a robot that faces +y.
        let axis = camera.rotation * Vector3::x();
        assert!((axis - Vector3::new(0.0, 0.1_f64.cos(), -0.1_f64.sin())).norm() < 1e-12);
    }

    #[test]
    fn errors_keep_their_spread_and_forget_in_the_stated_time() {
        let noise = CameraPoseNoise::default();
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let (n, mut variance, mut product) = (20_000, 0.0, 0.0);
        for _ in 0..n {
            let before = noise.sample(&mut rng);
            let after = noise.after(&before, 0.1, &mut rng);
            variance += after.rotation.y.powi(2) / f64::from(n);
            product += after.rotation.y * before.rotation.y / f64::from(n);
        }
        let (expected, rho) = (noise.rotation_sigma.powi(2), (-0.1 / noise.correlation_time).exp());
        // Five standard errors of a variance and (at most as large) of a covariance.
        let bound = 5.0 * expected * (2.0 / f64::from(n)).sqrt();
        assert!((variance - expected).abs() < bound && (product - rho * expected).abs() < bound);
    }
}
