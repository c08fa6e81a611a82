use nalgebra::{Matrix2, Vector2};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_smoother::Prior;

use super::{
    AntennaPosition, Heading, MountedRangeBearing, PointSmoother, PoseObservation, smoother::inverse,
};
use crate::{ROBUST_KERNEL, SlamSmootherError};

/// A detection of a point whose landmark is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// m.
    pub range: f64,
    /// rad, 0 ahead, counter-clockwise.
    pub bearing: f64,
    /// Covariance of range and bearing.
    pub covariance: Matrix2<f64>,
}

impl PointSmoother {
    /// Adds a detection from the newest pose. An unknown landmark starts where it is seen.
    ///
    /// # Errors
    /// * [`SlamSmootherError::OutOfRange`] for a range that is not positive and finite.
    /// * [`SlamSmootherError::Smoother`] for other numbers that are not finite.
    pub fn detect(&mut self, landmark: u32, detection: &Detection) -> Result<(), SlamSmootherError> {
        let Detection { range, bearing, covariance } = *detection;
        let index = self.newest();
        if !(range > 0.0 && range.is_finite() && bearing.is_finite()) {
            let (what, wanted) = ("range of a detection from pose", "positive and finite, as its bearing");
            return Err(SlamSmootherError::OutOfRange { what, index, value: range, wanted });
        }
        let information = inverse(&covariance, "covariance of a detection from pose", index)?;
        let pose = self.last().pose;
        let id = match self.landmarks.get(&landmark) {
            Some(id) => *id,
            None => {
                let distance = range * (-self.graph.value(self.scale)?.x).exp();
                let (sin, cos) = bearing.sin_cos();
                let sensor = self.graph.value(pose)?.compose(&self.params.mount);
                self.graph.add_variable(sensor.transform(&(Vector2::new(cos, sin) * distance)))
            }
        };
        let residual = MountedRangeBearing { mount: self.params.mount, range, bearing };
        match self.graph.add(residual, (pose, id, self.scale), information) {
            Ok(added) => {
                self.landmarks.insert(landmark, id);
                Ok(self.graph.set_kernel(added, ROBUST_KERNEL)?)
            }
            Err(error) => {
                if !self.landmarks.contains_key(&landmark) {
                    self.graph.remove_variables(&[id.index()])?;
                }
                Err(error.into())
            }
        }
    }

    /// Adds a measurement of the pose that the robot has after a further motion from the newest one.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] for a covariance that is none, and numbers that are not finite.
    pub fn observe(
        &mut self,
        observation: &PoseObservation,
        motion: &Pose2<f64>,
    ) -> Result<(), SlamSmootherError> {
        let (pose, index) = (self.last().pose, self.newest());
        let name = "covariance of a measured pose at pose";
        let added = match *observation {
            PoseObservation::Position { antenna, measured, covariance } => {
                let residual = AntennaPosition { antenna: motion.transform(&antenna), measured };
                self.graph.add(residual, (pose,), inverse(&covariance, name, index)?)?
            }
            PoseObservation::Heading { measured, variance } => {
                let residual = Heading { measured: measured - motion.heading() };
                self.graph.add(residual, (pose,), inverse(&variance, name, index)?)?
            }
            PoseObservation::Pose { measured, covariance } => {
                let back = measured.compose(&motion.inverse());
                let carry = motion.adjoint();
                let covariance = carry * covariance * carry.transpose();
                self.graph.add(Prior::new(back), (pose,), inverse(&covariance, name, index)?)?
            }
        };
        Ok(self.graph.set_kernel(added, ROBUST_KERNEL)?)
    }
}
