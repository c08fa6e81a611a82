use rand::{Rng, RngExt, distr::Distribution};
use wayfix_color_map::ColorMap;
use wayfix_estimation_traits::{Pose2, wrap_angle};
use wayfix_gaussian_core::Gaussian;

use crate::ColorModelError;

/// Where the robot may be at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// About here.
    Near(Gaussian<Pose2<f64>>),
    /// Anywhere above the map, facing anywhere.
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

    /// The nearest pose inside: boards stop a robot that would walk out.
    pub(crate) fn clamp(&self, pose: &mut Pose2<f64>) {
        for axis in 0..2 {
            pose.translation[axis] = pose.translation[axis].clamp(self.min[axis], self.max[axis]);
        }
    }

    /// Whether a pose is inside.
    pub(crate) fn contains(&self, pose: &Pose2<f64>) -> bool {
        (0..2).all(|axis| (self.min[axis]..=self.max[axis]).contains(&pose.translation[axis]))
    }

    /// The pose after half a turn of the world about the middle.
    pub(crate) fn opposite(&self, pose: &Pose2<f64>) -> Pose2<f64> {
        let [x, y] = [0, 1].map(|axis| self.min[axis] + self.max[axis]);
        Pose2::new(x - pose.x(), y - pose.y(), wrap_angle(pose.heading() + std::f64::consts::PI))
    }

    pub(crate) fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> Pose2<f64> {
        let mut between =
            |axis: usize| self.min[axis] + rng.random::<f64>() * (self.max[axis] - self.min[axis]);
        let (x, y) = (between(0), between(1));
        Pose2::new(x, y, (rng.random::<f64>() - 0.5) * std::f64::consts::TAU)
    }
}

impl Start {
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
            // A start without uncertainty is drawn where it is; it cannot be weighed.
            Self::Near(about) => about.mahalanobis_squared(pose).map_or(0.0, |squared| -0.5 * squared),
            Self::Anywhere => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_opposite_of_the_opposite_is_here() {
        let area = Area { min: [-1.0, 0.0], max: [3.0, 2.0] };
        let pose = Pose2::new(2.5, 0.5, 0.3);
        let opposite = area.opposite(&pose);
        assert_eq!((opposite.x(), opposite.y()), (-0.5, 1.5));
        assert!((opposite.heading() - (0.3 - std::f64::consts::PI)).abs() < 1e-12);
        let back = area.opposite(&opposite);
        assert!((back.x() - 2.5).abs() < 1e-12 && (back.heading() - 0.3).abs() < 1e-12);
    }
}
