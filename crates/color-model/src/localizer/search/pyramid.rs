use wayfix_color_map::PinholeCamera;

use crate::{
    BackgroundColorModel, ColorModelError, TiledImage, YuvImage,
    localizer::{background::ImageHistogram, buffer::BufferedFrame, frame::Scene},
};

/// The frames of a search at one resolution.
pub(super) struct Level {
    pub(super) camera: PinholeCamera,
    /// Pixels left out at the ends of spans.
    pub(super) edge_margin: u16,
    pub(super) images: Vec<YuvImage>,
    pub(super) tiles: Vec<TiledImage>,
    histogram: ImageHistogram,
}

impl Level {
    /// Frames shrunk by `shrink`, in tiles of `tile_pixels` of the shrunk image.
    pub(super) fn new<L>(
        scene: &Scene<'_, L>,
        frames: &[BufferedFrame],
        shrink: u16,
        tile_pixels: u16,
    ) -> Result<Self, ColorModelError> {
        let camera = scene.camera.shrunk(shrink.into()).map_err(|_| ColorModelError::EmptyMap)?;
        let images =
            frames.iter().map(|frame| frame.image.shrunk(shrink.into())).collect::<Result<Vec<_>, _>>()?;
        let histogram = ImageHistogram::new(images.iter(), &scene.noise.pixel_color_variance, scene.pixels);
        let tiles = images
            .iter()
            .map(|image| {
                let tiles =
                    TiledImage::new(image, tile_pixels, |pixel| nats(scene.background, &histogram, pixel))?;
                let is_known = scene.background.is_some();
                Ok(if is_known { tiles } else { tiles.with_unmapped_colors(histogram.widths()) })
            })
            .collect::<Result<_, ColorModelError>>()?;
        let edge_margin = scene.pixels.edge_margin_pixels / shrink;
        Ok(Self { camera, edge_margin, images, tiles, histogram })
    }

    /// $`-\ln p_{bg}(c)`$, in nats.
    pub(super) fn nats(&self, learned: Option<&BackgroundColorModel>, pixel: [u8; 3]) -> f64 {
        nats(learned, &self.histogram, pixel)
    }
}

fn nats(learned: Option<&BackgroundColorModel>, histogram: &ImageHistogram, pixel: [u8; 3]) -> f64 {
    learned.map_or_else(|| histogram.nats(pixel), |learned| -learned.log_density(pixel))
}
