use nalgebra::{Vector3, Vector4};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};

use crate::localizer::{CameraPoseError, CameraPoseNoise, buffer::BufferedFrame, camera::CameraLocation};

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

    /// With the same error of the camera at all frames.
    pub(crate) fn with_camera_error(mut self, error: &CameraPoseError, noise: &CameraPoseNoise) -> Self {
        let share = |error: f64, sigma: f64| if sigma > 0.0 { error / sigma } else { 0.0 };
        let rotation = error.rotation.map(|angle| share(angle, noise.rotation_sigma));
        let deviates = rotation.push(share(error.height, noise.height_sigma));
        self.errors.iter_mut().for_each(|(_, camera)| *camera = deviates);
        self
    }

    /// $`\ln p`$ of the errors, up to a constant.
    pub(crate) fn log_prior(&self) -> f64 {
        let squares =
            self.errors.iter().map(|(odometry, camera)| odometry.norm_squared() + camera.norm_squared());
        -0.5 * squares.sum::<f64>()
    }

    /// Moves the trajectory as a whole by a normal step of these standard deviations along x, y and the heading.
    pub(crate) fn moved<R: Rng + ?Sized>(&self, sigmas: &Vector3<f64>, rng: &mut R) -> Self {
        self.moved_by(&sigmas.map(|sigma| sigma * rng.sample::<f64, _>(StandardNormal)))
    }

    /// Moves the trajectory as a whole along x, y and the heading.
    pub(crate) fn moved_by(&self, step: &Vector3<f64>) -> Self {
        Self { newest: self.newest.retract(step), ..self.clone() }
    }

    /// Changes the camera's errors at all frames alike by a `step` along an `axis`: a constant error of the mount.
    pub(crate) fn with_mount_off(&self, axis: usize, step: f64) -> Self {
        let mut changed = self.clone();
        changed.errors.iter_mut().for_each(|(_, camera)| camera[axis] += step);
        changed
    }

    /// Changes the camera's error at each frame along an `axis` by its step: a body that sways.
    pub(crate) fn with_sway(&self, axis: usize, steps: &[Vector4<f64>]) -> Self {
        let mut changed = self.clone();
        for ((_, camera), step) in changed.errors.iter_mut().zip(steps) {
            camera[axis] += step[axis];
        }
        changed
    }

    /// Changes the error of the odometry at one frame by a `step` along an `axis`.
    pub(crate) fn with_odometry_off(&self, at: usize, axis: usize, step: f64) -> Self {
        let mut changed = self.clone();
        changed.errors[at].0[axis] += step;
        changed
    }

    /// Takes over the error of the camera at one frame.
    pub(crate) fn take_camera_error(&mut self, other: &Self, at: usize) {
        self.errors[at].1 = other.errors[at].1;
    }

    /// $`\ln p`$ of the camera's error at one frame, up to a constant.
    pub(crate) fn log_prior_of_camera(&self, at: usize) -> f64 {
        -0.5 * self.errors[at].1.norm_squared()
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
