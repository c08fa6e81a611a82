use nalgebra::Vector3;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2, SampleMotion};

/// How the body moved between two frames, as far as is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryStep {
    /// Motion in the robot's frame before the motion; `None` when the odometry is missing.
    pub increment: Option<Pose2<f64>>,
    /// Seconds it took.
    pub seconds: f64,
}

/// How far walking odometry is from the truth: standard deviations, proportional to the motion, plus what grows with time.
///
/// The defaults are for legged robots, whose paws slip: a fifth of the way, a fifth of the turn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct OdometryNoise {
    /// Metres per metre walked, along and across.
    pub translation_per_metre: f64,
    /// Metres per radian turned.
    pub translation_per_radian: f64,
    /// Metres per square root of a second, moving or not: being pushed.
    pub translation_per_root_second: f64,
    /// Radians per metre walked.
    pub rotation_per_metre: f64,
    /// Radians per radian turned.
    pub rotation_per_radian: f64,
    /// Radians per square root of a second, moving or not.
    pub rotation_per_root_second: f64,
    /// Speed taken as standard deviation when odometry is missing, metres a second.
    pub unknown_speed: f64,
    /// Turning rate taken as standard deviation when odometry is missing, radians a second.
    pub unknown_turning: f64,
}

impl Default for OdometryNoise {
    fn default() -> Self {
        Self {
            translation_per_metre: 0.2,
            translation_per_radian: 0.05,
            translation_per_root_second: 0.03,
            rotation_per_metre: 0.2,
            rotation_per_radian: 0.2,
            rotation_per_root_second: 0.06,
            unknown_speed: 0.3,
            unknown_turning: 1.0,
        }
    }
}

impl OdometryNoise {
    /// Standard deviations of translation (metres, along and across alike) and rotation (radians) over a step.
    pub fn sigmas(&self, step: &OdometryStep) -> (f64, f64) {
        let root_seconds = step.seconds.sqrt();
        let Some(increment) = step.increment else {
            return (
                (self.unknown_speed * step.seconds).hypot(self.translation_per_root_second * root_seconds),
                (self.unknown_turning * step.seconds).hypot(self.rotation_per_root_second * root_seconds),
            );
        };
        let (walked, turned) = (increment.translation.norm(), increment.heading().abs());
        let sigma = |per_metre: f64, per_radian: f64, per_root_second: f64| {
            (per_metre * walked).hypot(per_radian * turned).hypot(per_root_second * root_seconds)
        };
        (
            sigma(self.translation_per_metre, self.translation_per_radian, self.translation_per_root_second),
            sigma(self.rotation_per_metre, self.rotation_per_radian, self.rotation_per_root_second),
        )
    }

    pub(crate) fn values(&self) -> [(&'static str, f64); 8] {
        [
            ("translation per metre", self.translation_per_metre),
            ("translation per radian", self.translation_per_radian),
            ("translation per root second", self.translation_per_root_second),
            ("rotation per metre", self.rotation_per_metre),
            ("rotation per radian", self.rotation_per_radian),
            ("rotation per root second", self.rotation_per_root_second),
            ("unknown speed", self.unknown_speed),
            ("unknown turning", self.unknown_turning),
        ]
    }
}

/// $`x_k = (x_{k-1} u_k) ⊞ n`$, the noise normal with [`sigmas`](OdometryNoise::sigmas).
impl SampleMotion for OdometryNoise {
    type State = Pose2<f64>;
    type Control = OdometryStep;

    fn sampler<R: Rng + ?Sized>(&self, step: &OdometryStep) -> impl Fn(&Pose2<f64>, &mut R) -> Pose2<f64> {
        let increment = step.increment.unwrap_or_else(Pose2::identity);
        let (translation, rotation) = self.sigmas(step);
        move |pose, rng| {
            let mut deviate = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
            let noise = Vector3::new(deviate(translation), deviate(translation), deviate(rotation));
            pose.compose(&increment).retract(&noise)
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn samples_follow_the_motion_and_spread_as_stated() {
        let step = OdometryStep { increment: Some(Pose2::new(0.5, 0.1, 0.3)), seconds: 1.0 };
        let (noise, start) = (OdometryNoise::default(), Pose2::new(1.0, 2.0, 3.0));
        let (sampler, mut rng) = (noise.sampler(&step), ChaCha8Rng::seed_from_u64(1));
        let expected = start.compose(&step.increment.unwrap());
        let (n, mut mean, mut variance) = (10_000, Vector3::zeros(), Vector3::zeros());
        for _ in 0..n {
            let error = expected.local(&sampler(&start, &mut rng));
            mean += error / f64::from(n);
            variance += error.component_mul(&error) / f64::from(n);
        }
        let (translation, rotation) = noise.sigmas(&step);
        for (axis, sigma) in [translation, translation, rotation].into_iter().enumerate() {
            assert!(mean[axis].abs() < 5.0 * sigma / f64::from(n).sqrt()); // five standard errors
            let standard_error = sigma * sigma * (2.0 / f64::from(n)).sqrt();
            assert!((variance[axis] - sigma * sigma).abs() < 5.0 * standard_error);
        }
    }

    #[test]
    fn missing_odometry_spreads_with_time() {
        let noise = OdometryNoise::default();
        let sigmas = |seconds| noise.sigmas(&OdometryStep { increment: None, seconds });
        let standing = OdometryStep { increment: Some(Pose2::identity()), seconds: 1.0 };
        assert!(sigmas(1.0).0 > noise.sigmas(&standing).0);
        assert!(sigmas(10.0).0 > 9.0 * sigmas(1.0).0 && sigmas(10.0).1 > 9.0 * sigmas(1.0).1);
    }
}
