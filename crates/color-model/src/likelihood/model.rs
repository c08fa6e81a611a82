use std::sync::Arc;

use nalgebra::Vector3;
use wayfix_color_map::{Camera, ColorMap, Projector};
use wayfix_estimation_traits::Pose3;

use super::span::log_likelihood;
use super::{
    FeatureLikelihood, FeatureParams, JointLikelihood, PixelLight, PixelParams, SumDensity, ViewLikelihood,
};
use crate::{Background, Classifier, ColorDensity, ColorModelError, LightTracker, PixelSums, YuvImage};

/// A likelihood that the localizer accepts: of a frame, from any camera pose, under each light of a tracker.
///
/// The localizer calls [`frame`](Self::frame) once for each image, and [`log_likelihoods`](Self::log_likelihoods) for each particle.
pub trait LikelihoodModel: Send + Sync {
    /// What is computed once for each frame.
    type Frame: Send + Sync;
    /// Working memory of a thread.
    type Scratch;

    /// Prepares a frame.
    ///
    /// # Errors
    /// Returns an error if the image does not fit the camera.
    fn frame(&self, context: &FrameContext<'_>) -> Result<Self::Frame, ColorModelError>;

    /// Working memory for one thread.
    fn scratch(&self, frame: &Self::Frame) -> Self::Scratch;

    /// $`\ln p(z | x, θ_j) - \ln p_{bg}(z)`$ under each light $`j`$ of `light`, in nats. [Schulz & Fox 2004, Eq. 16]
    fn log_likelihoods<T: LightTracker>(
        &self,
        frame: &Self::Frame,
        scratch: &mut Self::Scratch,
        view: &PoseView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
    );
}

/// An image and what is known about it before any pose.
pub struct FrameContext<'a> {
    /// The image.
    pub image: &'a YuvImage,
    /// The map.
    pub map: &'a Arc<ColorMap>,
    /// The camera.
    pub camera: Camera,
    /// Densities of the colours under the most probable light.
    pub colors: &'a [ColorDensity],
    /// Variance of a pixel about the mean of its colour, $`ν`$.
    pub pixel_noise: Vector3<f64>,
    /// Variance of an image's mean of a colour.
    pub mean_noise: Vector3<f64>,
}

/// What the map shows from one camera pose.
pub struct PoseView<'a> {
    /// Pose of the camera in the world.
    pub camera_pose: &'a Pose3<f64>,
    /// Sums of the pixels of each colour.
    pub sums: &'a [PixelSums],
}

/// Frame of the pixel likelihood.
#[derive(Clone, Copy, Debug)]
pub struct PixelFrame {
    pub(crate) n_pixels: usize,
    pub(crate) pixel_noise: Vector3<f64>,
    pub(crate) mean_noise: Vector3<f64>,
}

/// The pixel product, from the sums of spans.
impl LikelihoodModel for PixelParams {
    type Frame = PixelFrame;
    type Scratch = JointScratch;

    fn frame(&self, context: &FrameContext<'_>) -> Result<PixelFrame, ColorModelError> {
        let FrameContext { image, pixel_noise, mean_noise, .. } = *context;
        Ok(PixelFrame { n_pixels: image.pixels().len(), pixel_noise, mean_noise })
    }

    fn scratch(&self, _frame: &PixelFrame) -> JointScratch {
        JointScratch(JointLikelihood::new())
    }

    fn log_likelihoods<T: LightTracker>(
        &self,
        frame: &PixelFrame,
        JointScratch(joint): &mut JointScratch,
        view: &PoseView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
    ) {
        let PixelFrame { n_pixels, pixel_noise, mean_noise } = frame;
        if self.light == PixelLight::Common {
            joint.set_sums(view.sums, self, pixel_noise, *n_pixels);
        }
        for (at, value) in log_likelihoods.iter_mut().enumerate() {
            let belief = if self.light == PixelLight::Common { light.joint_belief(at) } else { None };
            *value = match belief {
                Some(belief) => joint.log_likelihood(belief, mean_noise),
                None => self.independent(view.sums, light, at, *n_pixels).unwrap_or(f64::NEG_INFINITY),
            };
        }
    }
}

/// Working memory of [`PixelParams`] as a [`LikelihoodModel`].
pub struct JointScratch(pub(crate) JointLikelihood);

impl PixelParams {
    /// Pixels that do not share the light.
    fn independent(
        &self,
        sums: &[PixelSums],
        light: &impl LightTracker,
        at: usize,
        n_pixels: usize,
    ) -> Result<f64, ColorModelError> {
        let densities =
            self.shaded(light.colors_in(at)?).iter().map(SumDensity::new).collect::<Result<Vec<_>, _>>()?;
        Ok(log_likelihood(sums, &densities, self, n_pixels))
    }
}

/// The features of the image, classified under the most probable light. [Schulz & Fox 2004, VI]
impl LikelihoodModel for FeatureParams {
    type Frame = FeatureLikelihood;
    type Scratch = FeatureLikelihood;

    fn frame(&self, context: &FrameContext<'_>) -> Result<FeatureLikelihood, ColorModelError> {
        let labels = Classifier::new(context.colors.iter().copied())?
            .with_background(Background::Uniform)
            .classify_image(context.image);
        FeatureLikelihood::new(&labels, Projector::new(Arc::clone(context.map), context.camera), *self)
    }

    fn scratch(&self, frame: &FeatureLikelihood) -> FeatureLikelihood {
        frame.clone()
    }

    fn log_likelihoods<T: LightTracker>(
        &self,
        _frame: &FeatureLikelihood,
        scratch: &mut FeatureLikelihood,
        view: &PoseView<'_>,
        _light: &T,
        log_likelihoods: &mut [f64],
    ) {
        log_likelihoods.fill(scratch.log_likelihood(view.camera_pose, &[]));
    }
}
