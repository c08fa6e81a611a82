use nalgebra::{Vector3, Vector4};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};

use super::{CameraError, CameraNoise, particle::CameraLocation, shots::Shot};

/// Where the camera was at every shot: the newest body pose, and what went wrong, in standard normal deviates.
#[derive(Clone, Debug)]
pub(crate) struct Trajectory {
    pub(crate) newest: Pose2<f64>,
    /// Of the odometry between a shot and the one before.
    walks: Vec<Vector3<f64>>,
    /// Of the camera's error at a shot, taken as independent of the one before.
    errors: Vec<Vector4<f64>>,
}

impl Trajectory {
    /// One that is at `pose` at shot `at` and goes as odometry says.
    pub(crate) fn through(pose: &Pose2<f64>, at: usize, shots: &[Shot]) -> Self {
        let newest = shots.iter().skip(at + 1).fold(*pose, |body, shot| body.compose(&shot.walked.increment));
        Self {
            newest,
            walks: vec![Vector3::zeros(); shots.len()],
            errors: vec![Vector4::zeros(); shots.len()],
        }
    }

    /// $`\ln p`$ of what went wrong, up to a constant.
    pub(crate) fn log_prior(&self) -> f64 {
        let walks = self.walks.iter().skip(1).map(|walk| walk.norm_squared());
        let errors = self.errors.iter().map(|error| error.norm_squared());
        -0.5 * walks.chain(errors).sum::<f64>()
    }

    /// Another near it: moved as a whole by a normal step.
    pub(crate) fn moved<R: Rng + ?Sized>(&self, sigmas: &Vector3<f64>, rng: &mut R) -> Self {
        let step = sigmas.map(|sigma| sigma * rng.sample::<f64, _>(StandardNormal));
        Self { newest: self.newest.retract(&step), ..self.clone() }
    }

    /// Another whose odometry erred a little differently.
    pub(crate) fn rewalked<R: Rng + ?Sized>(&self, fresh: f64, rng: &mut R) -> Self {
        let mut normal = |deviate: f64| deviate + fresh * rng.sample::<f64, _>(StandardNormal);
        let walks = self.walks.iter().map(|walk| walk.map(&mut normal)).collect();
        Self { walks, ..self.clone() }
    }

    /// Another whose camera erred a little differently at one shot.
    pub(crate) fn jolted<R: Rng + ?Sized>(&self, at: usize, fresh: f64, rng: &mut R) -> Self {
        let mut jolted = self.clone();
        jolted.errors[at]
            .iter_mut()
            .for_each(|deviate| *deviate += fresh * rng.sample::<f64, _>(StandardNormal));
        jolted
    }

    /// The camera's location at every shot, the newest last.
    pub(crate) fn locations(&self, shots: &[Shot], camera: &CameraNoise) -> Vec<CameraLocation> {
        let mut body = self.newest;
        let mut locations: Vec<CameraLocation> = Vec::with_capacity(shots.len());
        for ((shot, walk), deviates) in shots.iter().zip(&self.walks).zip(&self.errors).rev() {
            let error = camera.blended(&CameraError::default(), 0.0, deviates);
            locations.push(CameraLocation { body, error });
            let (translation, rotation) = shot.walked.sigmas();
            let noise = Vector3::new(translation, translation, rotation).component_mul(walk);
            let back = Pose2::identity().retract(&noise).inverse();
            body = body.compose(&back).compose(&shot.walked.increment.inverse());
        }
        locations.reverse();
        locations
    }
}
