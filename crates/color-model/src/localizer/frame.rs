use std::sync::Arc;

use wayfix_color_map::{ColorMap, MapRenderer, PinholeCamera};
use wayfix_estimation_traits::Pose3;

use super::{background::ImageHistogram, camera::CameraLocation};
use crate::{
    BackgroundColorModel, ColorDensity, ColorModelError, LightingFilterParams, LightingTracker,
    LikelihoodFrameInput, LikelihoodModel, PixelLikelihoodParams, PixelSumDensity, PixelSums,
    PredictedMapView, PrefixSumImage, YuvImage, gather,
};

/// Everything that does not change with the frame.
pub(crate) struct Scene<'a, L> {
    pub(crate) map: &'a Arc<ColorMap>,
    pub(crate) camera: PinholeCamera,
    pub(crate) pixels: &'a PixelLikelihoodParams,
    pub(crate) likelihood: &'a L,
    pub(crate) background: Option<&'a BackgroundColorModel>,
    pub(crate) noise: LightingFilterParams,
}

/// A frame, ready to weigh any pose.
pub(crate) struct PreparedFrame<'a, L: LikelihoodModel> {
    scene: &'a Scene<'a, L>,
    mount: &'a Pose3<f64>,
    /// Without the outliers of each colour.
    sums: Vec<PrefixSumImage>,
    frame: L::Frame,
}

/// Whether the image is of the camera's size and the mount is a pose.
pub(crate) fn check_frame(
    camera: &PinholeCamera,
    image: &YuvImage,
    mount: &Pose3<f64>,
) -> Result<(), ColorModelError> {
    let expected = (camera.width() as usize, camera.height() as usize);
    let got = (image.width() as usize, image.height() as usize);
    if expected != got {
        return Err(ColorModelError::FrameSize { expected, got });
    }
    let is_unit = (mount.rotation.norm() - 1.0).abs() < f64::from(f32::EPSILON);
    if !(is_unit && mount.translation.iter().all(|value| value.is_finite())) {
        return Err(ColorModelError::NotFinite { what: "camera mount" });
    }
    Ok(())
}

/// Working memory of a thread.
pub(crate) struct Scratch<S> {
    projector: MapRenderer,
    likelihood: S,
}

impl<'a, L: LikelihoodModel> PreparedFrame<'a, L> {
    /// Marks the outliers of each colour: the pixels that the background explains better than the colour, less the cost of an outlier, under all lights that
    /// particles have; `lights` are the densities of all colours under each. Such a pixel belongs to an object that hides the colour there.
    ///
    /// The marks depend on the colour and not on the pose, so the sums over spans stay exact.
    pub(crate) fn new(
        scene: &'a Scene<'a, L>,
        image: &YuvImage,
        mount: &'a Pose3<f64>,
        lights: &[Vec<ColorDensity>],
    ) -> Result<Self, ColorModelError> {
        let Scene { map, camera, pixels, likelihood, background, noise } = scene;
        let histogram = ImageHistogram::new(std::iter::once(image), &noise.pixel_color_variance, pixels);
        let nats =
            |pixel| background.map_or_else(|| histogram.nats(pixel), |learned| -learned.log_density(pixel));
        let log_outlier = pixels.outlier_share.ln();
        let sums_of = |color: usize| {
            let densities = pixels.shaded(lights.iter().filter_map(|colors| colors.get(color).copied()));
            let densities = densities.iter().map(PixelSumDensity::new).collect::<Result<Vec<_>, _>>()?;
            let mut best = PixelCache::default();
            PrefixSumImage::with_background(image, |pixel| {
                let nats = nats(pixel);
                let best = best.get(pixel, |pixel| {
                    densities.iter().map(|density| density.log(pixel)).fold(f64::NEG_INFINITY, f64::max)
                });
                (best + nats > log_outlier).then_some(nats)
            })
        };
        let sums = map_colors(map.colors().len(), sums_of)?;
        let context = LikelihoodFrameInput {
            image,
            map,
            camera: *camera,
            colors: lights.first().map_or(&[], Vec::as_slice),
            pixel_color_variance: noise.pixel_color_variance,
            mean_color_variance: noise.mean_color_variance,
        };
        let frame = likelihood.frame(&context)?;
        Ok(Self { scene, mount, sums, frame })
    }

    pub(crate) fn n_colors(&self) -> usize {
        self.scene.map.colors().len()
    }

    pub(crate) fn scratch(&self) -> Scratch<L::Scratch> {
        Scratch {
            projector: MapRenderer::new(Arc::clone(self.scene.map), self.scene.camera),
            likelihood: self.scene.likelihood.scratch(&self.frame),
        }
    }

    /// Sums the pixels of each colour that the map shows at `location`, and gives the log-likelihood under each light. [Schulz & Fox 2004, Eq. 16]
    pub(crate) fn view<T: LightingTracker>(
        &self,
        scratch: &mut Scratch<L::Scratch>,
        location: &CameraLocation,
        light: &T,
        sums: &mut [PixelSums],
        log_likelihoods: &mut [f64],
    ) {
        let camera_pose = &location.camera_pose(self.mount);
        let margin = self.scene.pixels.edge_margin_pixels;
        if gather(&mut scratch.projector, |color| self.sums.get(color.index()), camera_pose, margin, sums)
            .is_err()
        {
            return log_likelihoods.fill(f64::NEG_INFINITY);
        }
        let view = PredictedMapView { camera_pose, sums };
        self.scene.likelihood.log_likelihoods(
            &self.frame,
            &mut scratch.likelihood,
            &view,
            light,
            log_likelihoods,
        );
        for value in log_likelihoods.iter_mut().filter(|value| value.is_nan()) {
            *value = f64::NEG_INFINITY;
        }
    }
}

#[cfg(feature = "parallel")]
fn map_colors<X: Send, E: Send>(
    n: usize,
    job: impl Fn(usize) -> Result<X, E> + Sync + Send,
) -> Result<Vec<X>, E> {
    use rayon::prelude::*;
    (0..n).into_par_iter().map(job).collect()
}

#[cfg(not(feature = "parallel"))]
fn map_colors<X, E>(n: usize, job: impl Fn(usize) -> Result<X, E>) -> Result<Vec<X>, E> {
    (0..n).map(job).collect()
}

/// A function of a pixel, computed once for each of 64³ cells of YUV.
struct PixelCache(Vec<f32>);

/// Bits of a channel that select a cell, and the bits below.
const BITS: u32 = 6;
const BELOW: u32 = u8::BITS - BITS;

impl Default for PixelCache {
    fn default() -> Self {
        Self(vec![f32::NAN; 1 << (3 * BITS)])
    }
}

impl PixelCache {
    fn get(&mut self, pixel: [u8; 3], compute: impl Fn([u8; 3]) -> f64) -> f64 {
        let cell = pixel.iter().fold(0, |cell, channel| (cell << BITS) | usize::from(channel >> BELOW));
        let value = &mut self.0[cell];
        if value.is_nan() {
            let middle = pixel.map(|channel| (channel >> BELOW << BELOW) | (1 << (BELOW - 1)));
            *value = compute(middle) as f32;
        }
        f64::from(*value)
    }
}
