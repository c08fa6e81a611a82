use nalgebra::{Vector3, Vector4, Vector6};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{Manifold, Pose2, Pose3};

/// How far the camera is from where the joints say: what a walking body does to it.
///
/// With the body's planar pose these make the six degrees of freedom of the camera's location in [Schulz & Fox 2004, IV].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraError {
    /// Rotation about the camera's x, y and z axes: roll, tilt (positive looks down) and pan (positive looks left), radians.
    pub rotation: Vector3<f64>,
    /// Height above where it should be, metres.
    pub height: f64,
}

impl CameraError {
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

/// Standard deviations of [`CameraError`], and how long an error lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct CameraNoise {
    /// Of roll, radians.
    pub roll: f64,
    /// Of tilt, radians.
    pub tilt: f64,
    /// Of pan, radians.
    pub pan: f64,
    /// Of height, metres.
    pub height: f64,
    /// Time constant of the errors' correlation, seconds; 0 draws new ones each frame.
    pub seconds: f64,
}

impl Default for CameraNoise {
    fn default() -> Self {
        let degree = std::f64::consts::PI / 180.0;
        Self { roll: 1.5 * degree, tilt: 1.5 * degree, pan: 1.0 * degree, height: 0.008, seconds: 0.2 }
    }
}

impl CameraNoise {
    /// The error `seconds` later: $`e' = ρ e + \sqrt{1 - ρ^2}\, n`$, $`ρ = e^{-t/τ}`$, whose standard deviations stay the same.
    pub fn after<R: Rng + ?Sized>(&self, error: &CameraError, seconds: f64, rng: &mut R) -> CameraError {
        self.mixed(error, self.kept(seconds), rng)
    }

    /// An error of which nothing is known.
    pub fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> CameraError {
        self.mixed(&CameraError::default(), 0.0, rng)
    }

    pub(crate) fn mixed<R: Rng + ?Sized>(&self, error: &CameraError, rho: f64, rng: &mut R) -> CameraError {
        let deviates = Vector4::from_fn(|_, _| rng.sample(StandardNormal));
        self.blended(error, rho, &deviates)
    }

    /// The same with the standard normal deviates that the rest is made of.
    pub(crate) fn blended(&self, error: &CameraError, rho: f64, deviates: &Vector4<f64>) -> CameraError {
        let deviates = deviates * (1.0 - rho * rho).sqrt();
        let sigmas = Vector3::new(self.roll, self.tilt, self.pan);
        CameraError {
            rotation: error.rotation * rho + sigmas.component_mul(&deviates.xyz()),
            height: error.height * rho + self.height * deviates.w,
        }
    }

    /// Share of an error that is left after some time.
    pub(crate) fn kept(&self, seconds: f64) -> f64 {
        if self.seconds > 0.0 { (-seconds / self.seconds).exp() } else { 0.0 }
    }

    pub(crate) fn values(&self) -> [(&'static str, f64); 5] {
        [
            ("roll noise", self.roll),
            ("tilt noise", self.tilt),
            ("pan noise", self.pan),
            ("height noise", self.height),
            ("time constant of camera errors", self.seconds),
        ]
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
        let error = CameraError { rotation: Vector3::new(0.0, 0.1, 0.0), height: 0.01 };
        let camera = error.camera_pose(&body, &mount);
        assert!((camera.translation - Vector3::new(1.0, 2.1, 0.21)).norm() < 1e-12);
        // A positive tilt looks down: the optical axis of a robot that faces +y.
        let axis = camera.rotation * Vector3::x();
        assert!((axis - Vector3::new(0.0, 0.1_f64.cos(), -0.1_f64.sin())).norm() < 1e-12);
    }

    #[test]
    fn errors_keep_their_spread_and_forget_in_the_stated_time() {
        let noise = CameraNoise::default();
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let (n, mut variance, mut product) = (20_000, 0.0, 0.0);
        for _ in 0..n {
            let before = noise.sample(&mut rng);
            let after = noise.after(&before, 0.1, &mut rng);
            variance += after.rotation.y.powi(2) / f64::from(n);
            product += after.rotation.y * before.rotation.y / f64::from(n);
        }
        let (expected, rho) = (noise.tilt.powi(2), (-0.1 / noise.seconds).exp());
        // Five standard errors of a variance and (at most as large) of a covariance.
        let bound = 5.0 * expected * (2.0 / f64::from(n)).sqrt();
        assert!((variance - expected).abs() < bound && (product - rho * expected).abs() < bound);
    }
}
