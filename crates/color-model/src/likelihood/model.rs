use std::sync::Arc;

use nalgebra::Vector3;
use wayfix_color_map::{ColorMap, MapRenderer, PinholeCamera};
use wayfix_estimation_traits::Pose3;

use super::span::log_likelihood;
use super::{
    CameraPoseLikelihood, FeatureLikelihood, FeatureLikelihoodParams, LightErrorCorrelation, LightOfTiles,
    PixelLikelihoodParams, PixelSumDensity, TileLight, TileLikelihood,
};
use crate::{
    BackgroundColorModel, ColorDensity, ColorModelError, LightingTracker, PixelClassifier, PixelSums,
    TileSums, TiledImage, YuvImage,
};

/// A likelihood that the localizer accepts: of a frame, from any camera pose, under each light of a tracker.
///
/// The localizer calls [`frame`](Self::frame) once for each image, and [`log_likelihoods`](Self::log_likelihoods) for each particle.
/// ```
/// # use {nalgebra::*, std::sync::Arc, wayfix_color_map::*, wayfix_color_model::*, wayfix_estimation_traits::*, wayfix_gaussian_core::Gaussian};
/// # let (image, [pixel_color_variance, mean_color_variance]) = (YuvImage::new(2, 2, vec![[90, 110, 100]; 4])?, [Vector3::repeat(64.0); 2]);
/// # let (map, camera) = (Arc::new(ColorMap::new(vec!["green".into()], vec![])?), PinholeCamera::from_field_of_view(2, 2, 1.0, 1.0)?);
/// # let light = LightingFilter::new(Gaussian::new(DVector::from_vec(vec![90.0, 110.0, 100.0]), DMatrix::identity(3, 3))?, Default::default())?;
/// # let input = LikelihoodFrameInput { image: &image, map: &map, camera, colors: &[], pixel_color_variance, mean_color_variance };
/// # let tiled = TiledImage::new(&image, 16, |_| 12.0)?; let mut tiles = TileSums::new(&tiled, 1);
/// # [0, 1].map(|row| tiles.add_run(&tiled, (row, 0, 2), 0)); tiles.add_covered_rows(&tiled);
/// // The map shows green in all four pixels; the background has 12 nats.
/// let view = PredictedMapView { camera_pose: &Pose3::identity(), image: &tiled, tiles: &tiles };
/// let (model, mut log, mut shown) = (PixelLikelihoodParams::as_published(), [0.0], [PixelSums::default()]);
/// let frame = model.frame(&input)?;
/// model.log_likelihoods(&frame, &mut model.scratch(&frame), &view, &light, &mut log, &mut shown);
/// let pixel = PixelSumDensity::new(&light.color(ColorId(0)))?.log([90, 110, 100]) + 12.0;
/// assert!((log[0] - 4.0 * pixel).abs() < 1e-9 && shown[0].count() == 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait LikelihoodModel: Send + Sync {
    /// What is computed once for each frame.
    type Frame: Send + Sync;
    /// Working memory of a thread.
    type Scratch;

    /// Prepares a frame.
    ///
    /// # Errors
    /// Returns an error if the frame cannot be prepared. The localizer has checked the size of the image.
    fn frame(&self, context: &LikelihoodFrameInput<'_>) -> Result<Self::Frame, ColorModelError>;

    /// Working memory for one thread.
    fn scratch(&self, frame: &Self::Frame) -> Self::Scratch;

    /// Whether a part of an image may be in the shade.
    fn mixes_lights(&self) -> bool {
        false
    }

    /// $`\ln p(z | x, θ_j) - \ln p_{bg}(z)`$ under each light $`j`$ of `light`, in nats. [Schulz & Fox 2004, Eq. 16]
    ///
    /// `shown` takes the pixels of each colour in each light: all colours of the first light, then those of the next. It is empty before.
    fn log_likelihoods<T: LightingTracker>(
        &self,
        frame: &Self::Frame,
        scratch: &mut Self::Scratch,
        view: &PredictedMapView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
        shown: &mut [PixelSums],
    );
}

/// An image and what is known about it before any pose.
/// ```
/// # use {nalgebra::*, std::sync::Arc, wayfix_color_map::*, wayfix_color_model::*};
/// # let (image, [pixel_color_variance, mean_color_variance]) = (YuvImage::new(2, 2, vec![[90, 110, 100]; 4])?, [Vector3::repeat(64.0); 2]);
/// # let (map, camera) = (Arc::new(ColorMap::new(vec!["green".into()], vec![])?), PinholeCamera::from_field_of_view(2, 2, 1.0, 1.0)?);
/// # let input = LikelihoodFrameInput { image: &image, map: &map, camera, colors: &[], pixel_color_variance, mean_color_variance };
/// let features = FeatureLikelihoodParams::default();
/// assert!(features.frame(&input).is_ok());
/// let other_size = LikelihoodFrameInput { camera: PinholeCamera::from_field_of_view(4, 4, 1.0, 1.0)?, ..input };
/// assert!(matches!(features.frame(&other_size), Err(ColorModelError::ImageSize { .. })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
/// ```
/// # use {nalgebra::*, std::sync::Arc, wayfix_color_map::*, wayfix_color_model::*, wayfix_estimation_traits::*, wayfix_gaussian_core::Gaussian};
/// # let (image, [pixel_color_variance, mean_color_variance]) = (YuvImage::new(2, 2, vec![[90, 110, 100]; 4])?, [Vector3::repeat(64.0); 2]);
/// # let (map, camera) = (Arc::new(ColorMap::new(vec!["green".into()], vec![])?), PinholeCamera::from_field_of_view(2, 2, 1.0, 1.0)?);
/// # let light = LightingFilter::new(Gaussian::new(DVector::from_vec(vec![90.0, 110.0, 100.0]), DMatrix::identity(3, 3))?, Default::default())?;
/// # let input = LikelihoodFrameInput { image: &image, map: &map, camera, colors: &[], pixel_color_variance, mean_color_variance };
/// let tiled = TiledImage::new(&image, 16, |_| 12.0)?;
/// let out_of_sight = TileSums::new(&tiled, 1); // the map shows nothing
/// let view = PredictedMapView { camera_pose: &Pose3::identity(), image: &tiled, tiles: &out_of_sight };
/// let (model, mut log, mut shown) = (PixelLikelihoodParams::as_published(), [f64::NAN], [PixelSums::default()]);
/// let frame = model.frame(&input)?;
/// model.log_likelihoods(&frame, &mut model.scratch(&frame), &view, &light, &mut log, &mut shown);
/// assert_eq!(log, [0.0]); // as probable as the background
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PredictedMapView<'a> {
    /// Pose of the camera in the world.
    pub camera_pose: &'a Pose3<f64>,
    /// The image.
    pub image: &'a TiledImage,
    /// Sums of the pixels of each colour in each tile.
    pub tiles: &'a TileSums,
}

/// Frame of the pixel likelihood.
/// ```
/// # use {nalgebra::*, std::sync::Arc, wayfix_color_map::*, wayfix_color_model::*, wayfix_estimation_traits::*, wayfix_gaussian_core::Gaussian};
/// # let (image, [pixel_color_variance, mean_color_variance]) = (YuvImage::new(2, 2, vec![[90, 110, 100]; 4])?, [Vector3::repeat(64.0); 2]);
/// # let (map, camera) = (Arc::new(ColorMap::new(vec!["green".into()], vec![])?), PinholeCamera::from_field_of_view(2, 2, 1.0, 1.0)?);
/// # let light = LightingFilter::new(Gaussian::new(DVector::from_vec(vec![90.0, 110.0, 100.0]), DMatrix::identity(3, 3))?, Default::default())?;
/// # let input = LikelihoodFrameInput { image: &image, map: &map, camera, colors: &[], pixel_color_variance, mean_color_variance };
/// # let tiled = TiledImage::new(&image, 16, |_| 12.0)?; let mut tiles = TileSums::new(&tiled, 1);
/// # tiles.add_run(&tiled, (0, 0, 2), 0); tiles.add_covered_rows(&tiled);
/// # let view = PredictedMapView { camera_pose: &Pose3::identity(), image: &tiled, tiles: &tiles };
/// # let model = PixelLikelihoodParams::default();
/// let log_likelihood = |frame: &PixelLikelihoodFrame| {
///     let (mut log, mut shown) = ([0.0], [PixelSums::default()]);
///     model.log_likelihoods(frame, &mut model.scratch(frame), &view, &light, &mut log, &mut shown);
///     log[0]
/// };
/// // The pixels have the mean colour of the light: less noise makes them more probable.
/// let noisy = LikelihoodFrameInput { pixel_color_variance: 4.0 * input.pixel_color_variance, ..input };
/// assert!(log_likelihood(&model.frame(&input)?) > log_likelihood(&model.frame(&noisy)?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PixelLikelihoodFrame {
    pub(crate) pixel_color_variance: Vector3<f64>,
    pub(crate) mean_color_variance: Vector3<f64>,
}

/// The pixel product, from the sums of spans.
impl LikelihoodModel for PixelLikelihoodParams {
    type Frame = PixelLikelihoodFrame;
    type Scratch = TileScratch;

    fn frame(&self, context: &LikelihoodFrameInput<'_>) -> Result<PixelLikelihoodFrame, ColorModelError> {
        let LikelihoodFrameInput { pixel_color_variance, mean_color_variance, .. } = *context;
        Ok(PixelLikelihoodFrame { pixel_color_variance, mean_color_variance })
    }

    fn scratch(&self, _frame: &PixelLikelihoodFrame) -> TileScratch {
        TileScratch::default()
    }

    fn mixes_lights(&self) -> bool {
        self.light_error_correlation == LightErrorCorrelation::Tile
    }

    fn log_likelihoods<T: LightingTracker>(
        &self,
        frame: &PixelLikelihoodFrame,
        scratch: &mut TileScratch,
        view: &PredictedMapView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
        shown: &mut [PixelSums],
    ) {
        if self.mixes_lights() {
            let n_lights = log_likelihoods.len();
            scratch.lights.clear();
            for at in 0..n_lights {
                match TileLight::new(light, at, self, &frame.pixel_color_variance) {
                    Ok(light) => scratch.lights.push(light),
                    Err(_) => return log_likelihoods.fill(f64::NEG_INFINITY),
                }
            }
            let TileScratch { tiles, lights } = scratch;
            tiles.clear();
            tiles.add_tiles(view.image, view.tiles.regions(), 1.0);
            tiles.weigh(lights);
            for (at, value) in log_likelihoods.iter_mut().enumerate() {
                // A shade never shines alone.
                if light.light_probability(at) == 0.0 {
                    *value = f64::NEG_INFINITY;
                    continue;
                }
                let in_light = LightOfTiles { light: at, shade: light.shade_of(at), n_lights };
                let n_tiles = tiles.n_tiles();
                let (log, is_shaded) = tiles.log_likelihood(view.image, in_light, 0..n_tiles);
                *value = log;
                let in_light = LightOfTiles { shade: in_light.shade.filter(|_| is_shaded), ..in_light };
                tiles.show(view.tiles.regions(), in_light, self, shown);
            }
        } else {
            show_to_all(view.tiles, log_likelihoods.len(), shown);
            for (at, (value, sums)) in log_likelihoods.iter_mut().zip(per_light(shown, light)).enumerate() {
                *value = self.independent(sums, light, at).unwrap_or(f64::NEG_INFINITY);
            }
        }
    }
}

/// Working memory of [`PixelLikelihoodParams`] as a [`LikelihoodModel`].
/// ```
/// # use {nalgebra::*, std::sync::Arc, wayfix_color_map::*, wayfix_color_model::*, wayfix_estimation_traits::*, wayfix_gaussian_core::Gaussian};
/// # let (image, [pixel_color_variance, mean_color_variance]) = (YuvImage::new(2, 2, vec![[90, 110, 100]; 4])?, [Vector3::repeat(64.0); 2]);
/// # let (map, camera) = (Arc::new(ColorMap::new(vec!["green".into()], vec![])?), PinholeCamera::from_field_of_view(2, 2, 1.0, 1.0)?);
/// # let light = LightingFilter::new(Gaussian::new(DVector::from_vec(vec![90.0, 110.0, 100.0]), DMatrix::identity(3, 3))?, Default::default())?;
/// # let input = LikelihoodFrameInput { image: &image, map: &map, camera, colors: &[], pixel_color_variance, mean_color_variance };
/// # let tiled = TiledImage::new(&image, 16, |_| 12.0)?;
/// # let [mut one_row, nothing] = [TileSums::new(&tiled, 1), TileSums::new(&tiled, 1)];
/// # one_row.add_run(&tiled, (0, 0, 2), 0); one_row.add_covered_rows(&tiled);
/// # let model = PixelLikelihoodParams::default();
/// let (frame, mut scratch) = (model.frame(&input)?, TileScratch::default());
/// let logs = [&one_row, &nothing, &one_row].map(|tiles| {
///     let view = PredictedMapView { camera_pose: &Pose3::identity(), image: &tiled, tiles };
///     let (mut log, mut shown) = ([0.0], [PixelSums::default()]);
///     model.log_likelihoods(&frame, &mut scratch, &view, &light, &mut log, &mut shown);
///     log[0]
/// });
/// assert!(logs[0] == logs[2] && logs[0] > logs[1]); // nothing is left of the view before
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Default)]
pub struct TileScratch {
    tiles: TileLikelihood,
    lights: Vec<TileLight>,
}

/// Adds all pixels to every light.
fn show_to_all(tiles: &TileSums, n_lights: usize, shown: &mut [PixelSums]) {
    let Some(n_colors) = shown.len().checked_div(n_lights) else { return };
    for sums in shown.chunks_exact_mut(n_colors.max(1)) {
        tiles.regions().for_each(|region| sums[region.color].add(&region.sums()));
    }
}

/// The sums under each light.
fn per_light<'a>(
    shown: &'a [PixelSums],
    light: &impl LightingTracker,
) -> impl Iterator<Item = &'a [PixelSums]> {
    shown.chunks_exact((shown.len() / light.n_lights().max(1)).max(1))
}

impl PixelLikelihoodParams {
    /// Pixels that do not share the light.
    fn independent(
        &self,
        sums: &[PixelSums],
        light: &impl LightingTracker,
        at: usize,
    ) -> Result<f64, ColorModelError> {
        let densities = self
            .shaded(light.colors_in(at)?)
            .iter()
            .map(PixelSumDensity::new)
            .collect::<Result<Vec<_>, _>>()?;
        Ok(log_likelihood(sums, &densities, self))
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
        shown: &mut [PixelSums],
    ) {
        show_to_all(view.tiles, log_likelihoods.len(), shown);
        log_likelihoods.fill(scratch.log_likelihood(view.camera_pose, &[]));
    }
}
