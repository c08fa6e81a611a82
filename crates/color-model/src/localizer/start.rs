use rand::{Rng, RngExt, distr::Distribution};
use wayfix_color_map::ColorMap;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use crate::ColorModelError;

/// Prior of the start pose.
#[derive(Clone, Debug, PartialEq)]
pub enum StartPosePrior {
    /// Normally distributed.
    Near(Gaussian<Pose2<f64>>),
    /// Uniform over the map, with any heading.
    Anywhere,
}

/// A rectangle of the ground, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Area {
    min: [f64; 2],
    max: [f64; 2],
}

impl Area {
    /// The ground below a map.
    pub(crate) fn of(map: &ColorMap) -> Result<Self, ColorModelError> {
        let extent = map.extent().ok_or(ColorModelError::EmptyMap)?;
        Ok(Self { min: [extent.min.x, extent.min.y], max: [extent.max.x, extent.max.y] })
    }

    /// Moves the pose to the nearest one inside: boards stop a robot at the border.
    pub(crate) fn clamp(&self, pose: &mut Pose2<f64>) {
        for axis in 0..2 {
            pose.translation[axis] = pose.translation[axis].clamp(self.min[axis], self.max[axis]);
        }
    }

    /// Whether a pose is inside.
    pub(crate) fn contains(&self, pose: &Pose2<f64>) -> bool {
        (0..2).all(|axis| (self.min[axis]..=self.max[axis]).contains(&pose.translation[axis]))
    }

    /// Size of the area, m².
    pub(crate) fn size(&self) -> f64 {
        (self.max[0] - self.min[0]) * (self.max[1] - self.min[1])
    }

    pub(crate) fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> Pose2<f64> {
        let mut between =
            |axis: usize| self.min[axis] + rng.random::<f64>() * (self.max[axis] - self.min[axis]);
        let (x, y) = (between(0), between(1));
        Pose2::new(x, y, (rng.random::<f64>() - 0.5) * std::f64::consts::TAU)
    }
}

impl StartPosePrior {
    /// A pose that the start allows.
    pub(crate) fn draw<R: Rng + ?Sized>(&self, area: &Area, rng: &mut R) -> Pose2<f64> {
        match self {
            Self::Near(about) => about.sampler().sample(rng),
            Self::Anywhere => area.sample(rng),
        }
    }

    /// $`\ln p`$ of a pose, up to a constant.
    pub(crate) fn log_prior(&self, pose: &Pose2<f64>) -> f64 {
        match self {
            // An exact start has no density; it is drawn at its mean.
            Self::Near(about) => about.mahalanobis_squared(pose).map_or(0.0, |squared| -0.5 * squared),
            Self::Anywhere => 0.0,
        }
    }
}
