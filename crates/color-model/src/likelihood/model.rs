use std::sync::Arc;

use nalgebra::Vector3;
use wayfix_color_map::{ColorMap, MapRenderer, PinholeCamera};
use wayfix_estimation_traits::Pose3;

use super::span::log_likelihood;
use super::{
    CameraPoseLikelihood, FeatureLikelihood, FeatureLikelihoodParams, JointLikelihood, LightErrorCorrelation,
    PixelLikelihoodParams, PixelSumDensity,
};
use crate::{
    BackgroundColorModel, ColorDensity, ColorModelError, LightingTracker, PixelClassifier, PixelSums,
    YuvImage,
};

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
    fn frame(&self, context: &LikelihoodFrameInput<'_>) -> Result<Self::Frame, ColorModelError>;

    /// Working memory for one thread.
    fn scratch(&self, frame: &Self::Frame) -> Self::Scratch;

    /// $`\ln p(z | x, θ_j) - \ln p_{bg}(z)`$ under each light $`j`$ of `light`, in nats. [Schulz & Fox 2004, Eq. 16]
    fn log_likelihoods<T: LightingTracker>(
        &self,
        frame: &Self::Frame,
        scratch: &mut Self::Scratch,
        view: &PredictedMapView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
    );
}

/// An image and what is known about it before any pose.
pub struct LikelihoodFrameInput<'a> {
    /// The image.
    pub image: &'a YuvImage,
    /// The map.
    pub map: &'a Arc<ColorMap>,
    /// The camera.
    pub camera: PinholeCamera,
    /// Densities of the colours under the most probable light.
    pub colors: &'a [ColorDensity],
    /// Variance of a pixel about the mean of its colour, $`ν`$.
    pub pixel_color_variance: Vector3<f64>,
    /// Variance of an image's mean of a colour.
    pub mean_color_variance: Vector3<f64>,
}

/// What the map shows from one camera pose.
pub struct PredictedMapView<'a> {
    /// Pose of the camera in the world.
    pub camera_pose: &'a Pose3<f64>,
    /// Sums of the pixels of each colour.
    pub sums: &'a [PixelSums],
}

/// Frame of the pixel likelihood.
#[derive(Clone, Copy, Debug)]
pub struct PixelLikelihoodFrame {
    pub(crate) n_pixels: usize,
    pub(crate) pixel_color_variance: Vector3<f64>,
    pub(crate) mean_color_variance: Vector3<f64>,
}

/// The pixel product, from the sums of spans.
impl LikelihoodModel for PixelLikelihoodParams {
    type Frame = PixelLikelihoodFrame;
    type Scratch = PixelLikelihoodScratch;

    fn frame(&self, context: &LikelihoodFrameInput<'_>) -> Result<PixelLikelihoodFrame, ColorModelError> {
        let LikelihoodFrameInput { image, pixel_color_variance, mean_color_variance, .. } = *context;
        Ok(PixelLikelihoodFrame { n_pixels: image.pixels().len(), pixel_color_variance, mean_color_variance })
    }

    fn scratch(&self, _frame: &PixelLikelihoodFrame) -> PixelLikelihoodScratch {
        PixelLikelihoodScratch::new()
    }

    fn log_likelihoods<T: LightingTracker>(
        &self,
        frame: &PixelLikelihoodFrame,
        PixelLikelihoodScratch(joint): &mut PixelLikelihoodScratch,
        view: &PredictedMapView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
    ) {
        let PixelLikelihoodFrame { n_pixels, pixel_color_variance, mean_color_variance } = frame;
        if self.light_error_correlation == LightErrorCorrelation::Common {
            joint.set_sums(view.sums, self, pixel_color_variance, *n_pixels);
        }
        for (at, value) in log_likelihoods.iter_mut().enumerate() {
            let belief = if self.light_error_correlation == LightErrorCorrelation::Common {
                light.joint_belief(at)
            } else {
                None
            };
            *value = match belief {
                Some(belief) => joint.log_likelihood(belief, mean_color_variance),
                None => self.independent(view.sums, light, at, *n_pixels).unwrap_or(f64::NEG_INFINITY),
            };
        }
    }
}

/// Working memory of [`PixelLikelihoodParams`] as a [`LikelihoodModel`].
pub struct PixelLikelihoodScratch(pub(crate) JointLikelihood);

impl PixelLikelihoodScratch {
    pub(crate) fn new() -> Self {
        Self(JointLikelihood::new())
    }
}

impl PixelLikelihoodParams {
    /// Pixels that do not share the light.
    fn independent(
        &self,
        sums: &[PixelSums],
        light: &impl LightingTracker,
        at: usize,
        n_pixels: usize,
    ) -> Result<f64, ColorModelError> {
        let densities = self
            .shaded(light.colors_in(at)?)
            .iter()
            .map(PixelSumDensity::new)
            .collect::<Result<Vec<_>, _>>()?;
        Ok(log_likelihood(sums, &densities, self, n_pixels))
    }
}

/// The features of the image, classified under the most probable light. [Schulz & Fox 2004, VI]
impl LikelihoodModel for FeatureLikelihoodParams {
    type Frame = FeatureLikelihood;
    type Scratch = FeatureLikelihood;

    fn frame(&self, context: &LikelihoodFrameInput<'_>) -> Result<FeatureLikelihood, ColorModelError> {
        let labels = PixelClassifier::new(context.colors.iter().copied())?
            .with_background(BackgroundColorModel::Uniform)
            .classify_image(context.image);
        FeatureLikelihood::new(&labels, MapRenderer::new(Arc::clone(context.map), context.camera), *self)
    }

    fn scratch(&self, frame: &FeatureLikelihood) -> FeatureLikelihood {
        frame.clone()
    }

    fn log_likelihoods<T: LightingTracker>(
        &self,
        _frame: &FeatureLikelihood,
        scratch: &mut FeatureLikelihood,
        view: &PredictedMapView<'_>,
        _light: &T,
        log_likelihoods: &mut [f64],
    ) {
        log_likelihoods.fill(scratch.log_likelihood(view.camera_pose, &[]));
    }
}
