use nalgebra::Vector3;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2, SampleMotion};

/// Motion of the body over an interval, as odometry reports it.
/// ```
/// # use nalgebra::Vector2;
/// # use rand::SeedableRng;
/// # use wayfix_color_model::{OdometryNoise, OdometryStep};
/// # use wayfix_estimation_traits::{Pose2, SampleMotion};
/// # let exact = OdometryNoise { translation_sigma_per_root_second: 0.0, rotation_sigma_per_root_second: 0.0, ..OdometryNoise::default() };
/// # let exact = OdometryNoise { relative_sigma: 0.0, ..exact };
/// # let rng = &mut rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let forward = OdometryStep { increment: Some(Pose2::new(1.0, 0.0, 0.0)), seconds: 2.0 };
/// let moved = exact.sampler(&forward)(&Pose2::new(0.0, 0.0, std::f64::consts::FRAC_PI_2), rng);
/// assert!((moved.translation - Vector2::new(0.0, 1.0)).norm() < 1e-12); // along the heading, without noise
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryStep {
    /// Motion in the body frame before the motion; `None` if there is no odometry.
    pub increment: Option<Pose2<f64>>,
    /// Length of the interval, s.
    pub seconds: f64,
}

/// A motion model that the localizer accepts: samples for particles, and standard deviations for the global search.
/// ```
/// use rand::Rng;
/// use wayfix_color_model::{OdometryModel, OdometryStep};
/// use wayfix_estimation_traits::{LieGroup, Pose2, SampleMotion};
/// /// Exact odometry.
/// struct Exact;
/// impl SampleMotion for Exact {
///     type State = Pose2<f64>;
///     type Control = OdometryStep;
///     fn sampler<R: Rng + ?Sized>(&self, step: &OdometryStep) -> impl Fn(&Pose2<f64>, &mut R) -> Pose2<f64> {
///         let increment = step.increment.unwrap_or_else(Pose2::identity);
///         move |pose, _| pose.compose(&increment)
///     }
/// }
/// impl OdometryModel for Exact {
///     fn sigmas(&self, _: &OdometryStep) -> (f64, f64) {
///         (0.0, 0.0)
///     }
/// }
/// assert_eq!(Exact.sigmas(&OdometryStep { increment: None, seconds: 1.0 }), (0.0, 0.0));
/// ```
pub trait OdometryModel: SampleMotion<State = Pose2<f64>, Control = OdometryStep> {
    /// Standard deviations of the translation, m on each axis, and of the rotation, rad, over a step.
    fn sigmas(&self, step: &OdometryStep) -> (f64, f64);
}

/// Noise of the odometry of a walking robot: a share of the motion, and a random walk in time.
/// ```
/// use wayfix_color_model::{OdometryModel, OdometryNoise, OdometryStep};
/// use wayfix_estimation_traits::Pose2;
/// let step = OdometryStep { increment: Some(Pose2::new(1.0, 0.0, 0.0)), seconds: 1.0 };
/// let (translation, rotation) = OdometryNoise::default().sigmas(&step);
/// assert!((translation - 0.2_f64.hypot(0.03)).abs() < 1e-12); // m
/// assert!((rotation - 0.2_f64.hypot(0.06)).abs() < 1e-12); // rad
/// let (unknown, _) = OdometryNoise::default().sigmas(&OdometryStep { increment: None, ..step });
/// assert!((unknown - 0.3_f64.hypot(0.03)).abs() < 1e-12); // without odometry
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct OdometryNoise {
    /// Standard deviation as a share of the motion: m per m, rad per rad, and rad per m. Default 0.2: the feet of legged robots slip.
    pub relative_sigma: f64,
    /// Standard deviation of the translation, m per square root of a second, also at rest: other robots push. Default 0.03.
    pub translation_sigma_per_root_second: f64,
    /// Standard deviation of the rotation, rad per square root of a second, also at rest. Default 0.06: such a push at an arm of half a metre.
    pub rotation_sigma_per_root_second: f64,
    /// Standard deviation of the speed without odometry, m/s. Default 0.3: the top speed of a walking robot.
    pub speed_sigma_without_odometry: f64,
    /// Standard deviation of the turning rate without odometry, rad/s. Default 1: the top rate of a walking robot.
    pub turn_rate_sigma_without_odometry: f64,
}

impl Default for OdometryNoise {
    fn default() -> Self {
        Self {
            relative_sigma: 0.2,
            translation_sigma_per_root_second: 0.03,
            rotation_sigma_per_root_second: 0.06,
            speed_sigma_without_odometry: 0.3,
            turn_rate_sigma_without_odometry: 1.0,
        }
    }
}

impl OdometryNoise {
    pub(crate) fn values(&self) -> [(&'static str, f64); 5] {
        [
            ("relative sigma", self.relative_sigma),
            ("translation per root second", self.translation_sigma_per_root_second),
            ("rotation per root second", self.rotation_sigma_per_root_second),
            ("speed sigma without odometry", self.speed_sigma_without_odometry),
            ("turn rate sigma without odometry", self.turn_rate_sigma_without_odometry),
        ]
    }
}

impl OdometryModel for OdometryNoise {
    fn sigmas(&self, step: &OdometryStep) -> (f64, f64) {
        let (translation, rotation) = match step.increment {
            Some(increment) => {
                let walked = increment.translation.norm();
                (self.relative_sigma * walked, self.relative_sigma * walked.hypot(increment.heading()))
            }
            None => (
                self.speed_sigma_without_odometry * step.seconds,
                self.turn_rate_sigma_without_odometry * step.seconds,
            ),
        };
        let root = step.seconds.sqrt();
        (
            translation.hypot(self.translation_sigma_per_root_second * root),
            rotation.hypot(self.rotation_sigma_per_root_second * root),
        )
    }
}

/// Odometry between two frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OdometryDelta {
    pub(crate) increment: Pose2<f64>,
    pub(crate) seconds: f64,
    /// Variances of the translation on each axis, and of the rotation.
    variances: (f64, f64),
}

impl Default for OdometryDelta {
    fn default() -> Self {
        Self { increment: Pose2::identity(), seconds: 0.0, variances: (0.0, 0.0) }
    }
}

impl OdometryDelta {
    pub(crate) fn add(&mut self, step: &OdometryStep, model: &impl OdometryModel) {
        let (translation, rotation) = model.sigmas(step);
        let increment = step.increment.unwrap_or_else(Pose2::identity);
        let variances = (translation * translation, rotation * rotation);
        *self = self.then(&Self { increment, seconds: step.seconds, variances });
    }

    pub(crate) fn then(&self, next: &Self) -> Self {
        Self {
            increment: self.increment.compose(&next.increment),
            seconds: self.seconds + next.seconds,
            variances: (self.variances.0 + next.variances.0, self.variances.1 + next.variances.1),
        }
    }

    /// Standard deviations of the translation on each axis, and of the rotation.
    pub(crate) fn sigmas(&self) -> Vector3<f64> {
        let translation = self.variances.0.sqrt();
        Vector3::new(translation, translation, self.variances.1.sqrt())
    }
}

/// $`x_k = (x_{k-1} u_k) ⊞ n`$ with normal noise of [`sigmas`](OdometryModel::sigmas).
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
