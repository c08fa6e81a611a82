use std::sync::Arc;

use anyhow::Result;
use wayfix_color_map::{ColorMap, PinholeCamera};
use wayfix_color_model::{
    BackgroundColorModel, ColorDensity, ColorMeans, LightingFilterBank, LightingTracker,
    LikelihoodFrameInput, LikelihoodModel, PixelSums, PredictedMapView, SunAndShade, TileSums, TiledImage,
};
use wayfix_estimation_traits::{LieGroup, Pose3};
use wayfix_systems::color::ColorSystemParams;

use super::place::Place;

/// Time between two frames, s.
const PERIOD: f64 = 0.1;

/// An image seen from a known pose: the labels take the place of the projected map.
pub(super) struct KnownPose<'a> {
    place: &'a Place,
    map: &'a Arc<ColorMap>,
    params: &'a ColorSystemParams,
    image: TiledImage,
    tiles: TileSums,
}

/// The densities of all colours in a light, and in its shade if the image has one.
pub(super) struct AdaptedLight {
    pub(super) sun: Vec<ColorDensity>,
    pub(super) shade: Option<Vec<ColorDensity>>,
}

impl<'a> KnownPose<'a> {
    pub(super) fn new(
        place: &'a Place,
        map: &'a Arc<ColorMap>,
        params: &'a ColorSystemParams,
    ) -> Result<Self> {
        let background = BackgroundColorModel::from_pixels(place.image.pixels().iter().copied());
        let side = params.localizer.pixels.tile_pixels;
        let image = TiledImage::new(&place.image, side, |pixel| -background.log_density(pixel))?;
        let mut tiles = TileSums::new(&image, map.colors().len());
        for (row, labels) in place.labels.chunks(place.image.width() as usize).enumerate() {
            let mut start = 0;
            for run in labels.chunk_by(|a, b| a == b) {
                if let Some(color) = usize::from(run[0]).checked_sub(1) {
                    tiles.add_run(&image, (row, start, start + run.len()), color);
                }
                start += run.len();
            }
        }
        tiles.add_covered_rows(&image);
        Ok(Self { place, map, params, image, tiles })
    }

    /// Learns the light from as many frames of this image as a search keeps. The localizer at this pose does the same. [Schulz & Fox 2004, Eqs. 3–5, 16]
    pub(super) fn adapt(&self, prior: LightingFilterBank, withheld: Option<usize>) -> Result<AdaptedLight> {
        let pixels = &self.params.localizer.pixels;
        let mut light = SunAndShade::new(prior, pixels.mixes_lights());
        let noise = light.noise();
        let frame = pixels.frame(&LikelihoodFrameInput {
            image: &self.place.image,
            map: self.map,
            camera: PinholeCamera::from_field_of_view(
                self.place.image.width(),
                self.place.image.height(),
                1.0,
                1.0,
            )?,
            colors: &light.colors()?,
            pixel_color_variance: noise.pixel_color_variance,
            mean_color_variance: noise.mean_color_variance,
        })?;
        let camera_pose = &Pose3::identity();
        let view = PredictedMapView { camera_pose, image: &self.image, tiles: &self.tiles };
        let (mut scratch, n_lights) = (pixels.scratch(&frame), light.n_lights());
        let n_colors = self.map.colors().len();
        let (mut sun, mut is_shaded) = (0, false);
        for _ in 0..self.params.localizer.search.n_buffered_frames {
            light.predict(PERIOD)?;
            let mut logs = vec![0.0; n_lights];
            let mut shown = vec![PixelSums::default(); n_lights * n_colors];
            pixels.log_likelihoods(&frame, &mut scratch, &view, &light, &mut logs, &mut shown);
            let joint = |at: &usize| light.light_probability(*at).ln() + logs[*at];
            sun = (0..n_lights).max_by(|a, b| joint(a).total_cmp(&joint(b))).unwrap_or(0);
            let means = |at: usize| self.means(&shown[at * n_colors..(at + 1) * n_colors], withheld);
            let of_shade = light.shade_of(sun).map(|at| (at, means(at)));
            is_shaded = false;
            if let Some((at, means)) = of_shade.filter(|(_, means)| means.seen().next().is_some()) {
                light.update_in(at, &means)?;
                is_shaded = true;
            }
            light.update_in(sun, &means(sun))?;
        }
        let shade = light.shade_of(sun).filter(|_| is_shaded);
        let densities = |at: usize| -> Result<_> { Ok(pixels.shaded(light.colors_in(at)?)) };
        Ok(AdaptedLight { sun: densities(sun)?, shade: shade.map(densities).transpose()? })
    }

    fn means(&self, sums: &[PixelSums], withheld: Option<usize>) -> ColorMeans {
        let least = self.params.localizer.min_pixels;
        let mean = |(color, sums): (usize, &PixelSums)| {
            let is_used = sums.count() >= least && withheld != Some(color);
            (if is_used { sums.mean() } else { None }, sums.count())
        };
        ColorMeans::new(sums.iter().enumerate().map(mean))
    }
}
