use std::sync::Arc;

use wayfix_color_map::{ColorMap, MapRenderer, PinholeCamera};
use wayfix_estimation_traits::Pose3;

use super::{background::ImageHistogram, camera::CameraLocation};
use crate::{
    BackgroundColorModel, ColorDensity, ColorModelError, LightingFilterParams, LightingTracker,
    LikelihoodFrameInput, LikelihoodModel, PixelLikelihoodParams, PixelSums, PredictedMapView, TileSums,
    TiledImage, YuvImage, likelihood::gather_tiles,
};

/// Everything that does not change with the frame.
pub(crate) struct Scene<'a, L> {
    pub(crate) map: &'a Arc<ColorMap>,
    pub(crate) camera: PinholeCamera,
    /// 0 for the first camera.
    pub(crate) camera_number: usize,
    pub(crate) pixels: &'a PixelLikelihoodParams,
    pub(crate) likelihood: &'a L,
    pub(crate) background: Option<&'a BackgroundColorModel>,
    pub(crate) noise: LightingFilterParams,
}

/// A frame, ready to weigh any pose.
pub(crate) struct PreparedFrame<'a, L: LikelihoodModel> {
    scene: &'a Scene<'a, L>,
    mount: &'a Pose3<f64>,
    image: TiledImage,
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
    renderer: MapRenderer,
    tiles: TileSums,
    likelihood: S,
}

impl<'a, L: LikelihoodModel> PreparedFrame<'a, L> {
    /// Prepares a frame; `colors` are the densities of all colours under the most probable light.
    pub(crate) fn new(
        scene: &'a Scene<'a, L>,
        image: &YuvImage,
        mount: &'a Pose3<f64>,
        colors: &[ColorDensity],
    ) -> Result<Self, ColorModelError> {
        let Scene { map, camera, pixels, likelihood, background, noise, .. } = scene;
        let histogram = ImageHistogram::new(std::iter::once(image), &noise.pixel_color_variance, pixels);
        let nats =
            |pixel| background.map_or_else(|| histogram.nats(pixel), |learned| -learned.log_density(pixel));
        let tiled = TiledImage::new(image, pixels.tile_pixels, nats)?;
        let tiled = if background.is_none() { tiled.with_unmapped_colors(histogram.widths()) } else { tiled };
        let context = LikelihoodFrameInput {
            image,
            map,
            camera: *camera,
            colors,
            pixel_color_variance: noise.pixel_color_variance,
            mean_color_variance: noise.mean_color_variance,
        };
        let frame = likelihood.frame(&context)?;
        Ok(Self { scene, mount, image: tiled, frame })
    }

    /// Number of its camera.
    pub(crate) fn camera(&self) -> usize {
        self.scene.camera_number
    }

    pub(crate) fn n_colors(&self) -> usize {
        self.scene.map.colors().len()
    }

    pub(crate) fn scratch(&self) -> Scratch<L::Scratch> {
        Scratch {
            renderer: MapRenderer::new(Arc::clone(self.scene.map), self.scene.camera),
            tiles: TileSums::new(&self.image, self.n_colors()),
            likelihood: self.scene.likelihood.scratch(&self.frame),
        }
    }

    /// Number of tiles of the image.
    pub(crate) fn n_tiles(&self) -> usize {
        self.image.n_tiles()
    }

    /// Sums the pixels of each colour that the map shows at `location` in each light, and gives the log-likelihood under each light. [Schulz & Fox 2004, Eq. 16]
    pub(crate) fn view<T: LightingTracker>(
        &self,
        scratch: &mut Scratch<L::Scratch>,
        location: &CameraLocation,
        light: &T,
        shown: &mut [PixelSums],
        log_likelihoods: &mut [f64],
    ) {
        let camera_pose = &location.camera_pose(self.mount);
        let margin = self.scene.pixels.edge_margin_pixels;
        let Scratch { renderer, tiles, likelihood } = scratch;
        shown.fill(PixelSums::default());
        if gather_tiles(renderer, &self.image, camera_pose, margin, tiles).is_err() {
            return log_likelihoods.fill(f64::NEG_INFINITY);
        }
        let view = PredictedMapView { camera_pose, image: &self.image, tiles };
        self.scene.likelihood.log_likelihoods(&self.frame, likelihood, &view, light, log_likelihoods, shown);
        for value in log_likelihoods.iter_mut().filter(|value| value.is_nan()) {
            *value = f64::NEG_INFINITY;
        }
    }
}
