use nalgebra::{Vector3, Vector4};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};

use super::{CameraPoseNoise, buffer::BufferedFrame, camera::CameraLocation, estimate::PLACE_RADIUS};

/// Camera locations at all frames of a buffer: the newest body pose, and the errors of odometry and camera as standard normal deviates.
#[derive(Clone, Debug)]
pub(crate) struct Trajectory {
    pub(crate) newest: Pose2<f64>,
    /// Odometry from the frame before to a frame, and the camera error at it.
    errors: Vec<(Vector3<f64>, Vector4<f64>)>,
}

impl Trajectory {
    /// The trajectory that is at `pose` at frame `at` and follows the odometry.
    pub(crate) fn through(pose: &Pose2<f64>, at: usize, frames: &[BufferedFrame]) -> Self {
        let later = frames.iter().skip(at + 1);
        let newest = later.fold(*pose, |body, frame| body.compose(&frame.odometry.increment));
        Self { newest, errors: vec![(Vector3::zeros(), Vector4::zeros()); frames.len()] }
    }

    /// $`\ln p`$ of the errors, up to a constant.
    pub(crate) fn log_prior(&self) -> f64 {
        let squares =
            self.errors.iter().map(|(odometry, camera)| odometry.norm_squared() + camera.norm_squared());
        -0.5 * squares.sum::<f64>()
    }

    /// Moves the trajectory as a whole by a normal step of `scale` radii of a place.
    pub(crate) fn moved<R: Rng + ?Sized>(&self, scale: f64, rng: &mut R) -> Self {
        let step = Vector3::from_fn(|_, _| PLACE_RADIUS * scale * rng.sample::<f64, _>(StandardNormal));
        Self { newest: self.newest.retract(&step), ..self.clone() }
    }

    /// Changes the errors at one frame by normal deviates of `scale`.
    pub(crate) fn perturbed<R: Rng + ?Sized>(&self, scale: f64, rng: &mut R) -> Self {
        let mut perturbed = self.clone();
        let at = rng.random_range(0..self.errors.len());
        let mut deviate = || scale * rng.sample::<f64, _>(StandardNormal);
        let (odometry, camera) = &mut perturbed.errors[at];
        odometry.iter_mut().chain(camera.iter_mut()).for_each(|error| *error += deviate());
        perturbed
    }

    /// The camera location at every frame, the newest last.
    pub(crate) fn locations(&self, frames: &[BufferedFrame], noise: &CameraPoseNoise) -> Vec<CameraLocation> {
        let mut body = self.newest;
        let mut locations: Vec<CameraLocation> = Vec::with_capacity(frames.len());
        for (frame, (odometry, camera)) in frames.iter().zip(&self.errors).rev() {
            locations.push(CameraLocation { body, error: noise.scaled(camera) });
            let error = frame.odometry.sigmas().component_mul(odometry);
            let back = Pose2::identity().retract(&error).inverse();
            body = body.compose(&back).compose(&frame.odometry.increment.inverse());
        }
        locations.reverse();
        locations
    }
}
