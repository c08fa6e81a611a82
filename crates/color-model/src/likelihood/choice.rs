use super::{
    FeatureLikelihood, FeatureLikelihoodParams, LikelihoodFrameInput, LikelihoodModel, PixelLikelihoodFrame,
    PixelLikelihoodParams, PredictedMapView, TileScratch,
};
use crate::{ColorModelError, LightingTracker, PixelSums};

/// The likelihoods of this crate, to choose from at run time.
///
/// ```
/// use wayfix_color_model::{ImageLikelihoodChoice, PixelLikelihoodParams};
/// assert_eq!(ImageLikelihoodChoice::default(), ImageLikelihoodChoice::Pixels(PixelLikelihoodParams::default()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImageLikelihoodChoice {
    /// All pixels that the map shows. [Schulz & Fox 2004, Eq. 16]
    Pixels(PixelLikelihoodParams),
    /// Bearings and areas of blobs. [Schulz & Fox 2004, VI]
    Features(FeatureLikelihoodParams),
}

impl Default for ImageLikelihoodChoice {
    fn default() -> Self {
        Self::Pixels(PixelLikelihoodParams::default())
    }
}

/// What is computed for each frame, or for each thread, under either likelihood.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::Vector3;
/// # use wayfix_color_map::{ColorMap, PinholeCamera};
/// # use wayfix_color_model::{EitherLikelihood, FeatureLikelihoodParams, ImageLikelihoodChoice, LikelihoodFrameInput, LikelihoodModel, YuvImage};
/// # let image = YuvImage::new(2, 2, vec![[90, 110, 100]; 4])?;
/// # let (map, camera) = (Arc::new(ColorMap::new(vec!["green".into()], vec![])?), PinholeCamera::from_field_of_view(2, 2, 1.0, 1.0)?);
/// # let (pixel_color_variance, mean_color_variance) = (Vector3::new(144.0, 36.0, 36.0), Vector3::new(64.0, 16.0, 16.0));
/// # let input = LikelihoodFrameInput { image: &image, map: &map, camera, colors: &[], pixel_color_variance, mean_color_variance };
/// let features = ImageLikelihoodChoice::Features(FeatureLikelihoodParams::default());
/// let frame = features.frame(&input)?;
/// assert!(matches!(frame, EitherLikelihood::Features(_)));
/// // The working memory follows the frame, not the model.
/// assert!(matches!(ImageLikelihoodChoice::default().scratch(&frame), EitherLikelihood::Features(_)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub enum EitherLikelihood<P, F> {
    /// Of pixels.
    Pixels(P),
    /// Of features.
    Features(F),
}

impl LikelihoodModel for ImageLikelihoodChoice {
    type Frame = EitherLikelihood<PixelLikelihoodFrame, FeatureLikelihood>;
    type Scratch = EitherLikelihood<TileScratch, FeatureLikelihood>;

    fn frame(&self, context: &LikelihoodFrameInput<'_>) -> Result<Self::Frame, ColorModelError> {
        Ok(match self {
            Self::Pixels(pixels) => EitherLikelihood::Pixels(pixels.frame(context)?),
            Self::Features(features) => EitherLikelihood::Features(features.frame(context)?),
        })
    }

    fn scratch(&self, frame: &Self::Frame) -> Self::Scratch {
        match frame {
            EitherLikelihood::Pixels(_) => EitherLikelihood::Pixels(TileScratch::default()),
            EitherLikelihood::Features(features) => EitherLikelihood::Features(features.clone()),
        }
    }

    fn mixes_lights(&self) -> bool {
        matches!(self, Self::Pixels(pixels) if pixels.mixes_lights())
    }

    fn log_likelihoods<T: LightingTracker>(
        &self,
        frame: &Self::Frame,
        scratch: &mut Self::Scratch,
        view: &PredictedMapView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
        shown: &mut [PixelSums],
    ) {
        use EitherLikelihood::{Features, Pixels};
        match (self, frame, scratch) {
            (Self::Pixels(params), Pixels(frame), Pixels(scratch)) => {
                params.log_likelihoods(frame, scratch, view, light, log_likelihoods, shown);
            }
            (Self::Features(params), Features(frame), Features(scratch)) => {
                params.log_likelihoods(frame, scratch, view, light, log_likelihoods, shown);
            }
            // A frame of another likelihood has no effect.
            _ => log_likelihoods.fill(0.0),
        }
    }
}
