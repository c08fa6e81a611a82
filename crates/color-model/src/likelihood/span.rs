use wayfix_color_map::{ColorId, MapRenderer, PixelSpan, RenderError};
use wayfix_estimation_traits::{LogWeight, Pose3};

use super::{
    CameraPoseLikelihood, PixelLikelihoodParams, PixelSumDensity, params::Region, pixel::check_size,
};
use crate::{ColorDensity, ColorModelError, PixelSums, PrefixSumImage, TileSums, TiledImage};

/// Sums the pixels of each colour where the projected map at `camera_pose` shows it, without the pixels within `edge_margin_pixels` of an edge.
///
/// The sums do not depend on the light: they serve every lighting hypothesis and the colour means that update it.
/// # Errors
/// Returns an error if the pose is not finite or its quaternion not of unit length.
pub fn gather<'a>(
    renderer: &mut MapRenderer,
    frame_of: impl Fn(ColorId) -> Option<&'a PrefixSumImage>,
    camera_pose: &Pose3<f64>,
    edge_margin: u16,
    sums: &mut [PixelSums],
) -> Result<(), RenderError> {
    sums.fill(PixelSums::default());
    let mut add = |span: PixelSpan| {
        if let (Some(sums), Some(frame)) = (sums.get_mut(span.color.index()), frame_of(span.color)) {
            frame.add_run(usize::from(span.row), usize::from(span.start), usize::from(span.end), sums);
        }
    };
    match edge_margin {
        0 => renderer.spans(camera_pose, &mut add),
        margin => renderer.inner_spans(camera_pose, margin, &mut add),
    }
}

/// [`gather`] for each tile of the image.
pub(crate) fn gather_tiles(
    renderer: &mut MapRenderer,
    frame: &TiledImage,
    camera_pose: &Pose3<f64>,
    edge_margin: u16,
    tiles: &mut TileSums,
) -> Result<(), RenderError> {
    tiles.clear();
    let mut add = |span: PixelSpan| {
        let run = (usize::from(span.row), usize::from(span.start), usize::from(span.end));
        tiles.add_run(frame, run, span.color.index());
    };
    match edge_margin {
        0 => renderer.spans(camera_pose, &mut add)?,
        margin => renderer.inner_spans(camera_pose, margin, &mut add)?,
    }
    tiles.add_covered_rows(frame);
    Ok(())
}

/// The pixel likelihood computed from spans, equal to [`PixelLikelihood`](crate::PixelLikelihood).
///
/// $`\sum_m \sum_{c ∈ m} [\ln N(c; μ_m, Σ_{mm} + ν) - \ln p_{bg}(c)]`$ [Schulz & Fox 2004, Eqs. 9, 16] depends on a colour's pixels only through
/// their number, $`\sum c`$ and $`\sum c c^T`$, and a subtraction gives these for a run of pixels in a row.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{Matrix3, Vector3};
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera};
/// # use wayfix_color_model::{CameraPoseLikelihood, ColorDensity, PixelLikelihood, PixelLikelihoodParams};
/// # use wayfix_color_model::{PixelSpanLikelihood, PrefixSumImage, YuvImage};
/// # use wayfix_estimation_traits::{LieGroup, Pose3};
/// # let vertices = [[-9.0, -9.0], [0.0, -9.0], [0.0, 9.0], [-9.0, 9.0]].map(|[y, z]| Vector3::new(2.0, y, z)).to_vec();
/// # let wall = ColoredShape::Polygon { color: ColorId(0), vertices };
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![wall])?);
/// # let renderer = MapRenderer::new(map, PinholeCamera::from_field_of_view(4, 2, 1.0, 0.5)?);
/// # let light = [ColorDensity { mean: Vector3::new(90.0, 110.0, 100.0), covariance: Matrix3::identity() * 25.0 }];
/// let image = YuvImage::new(4, 2, (80..88).map(|y| [y, 110, 100]).collect())?;
/// let (nats, params) = (|_: [u8; 3]| Some(10.0), PixelLikelihoodParams::as_published());
/// let frame = PrefixSumImage::with_background(&image, nats)?;
/// let by_pixels = PixelLikelihood::new(&image, nats, renderer.clone(), params)?.log_likelihood(&Pose3::identity(), &light);
/// let by_spans = PixelSpanLikelihood::new(&frame, renderer, params)?.log_likelihood(&Pose3::identity(), &light);
/// assert!(by_spans != 0.0 && (by_spans - by_pixels).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PixelSpanLikelihood<'a> {
    frame: &'a PrefixSumImage,
    renderer: MapRenderer,
    sums: Vec<PixelSums>,
    params: PixelLikelihoodParams,
}

impl<'a> PixelSpanLikelihood<'a> {
    /// The likelihood of one frame, made by [`PrefixSumImage::with_background`], in the map of `renderer`.
    ///
    /// # Errors
    /// Returns an error if frame and camera differ in size, or a parameter is out of range.
    pub fn new(
        frame: &'a PrefixSumImage,
        renderer: MapRenderer,
        params: PixelLikelihoodParams,
    ) -> Result<Self, ColorModelError> {
        params.check()?;
        check_size(&renderer, frame.width(), frame.height())?;
        let sums = vec![PixelSums::default(); renderer.map().colors().len()];
        Ok(Self { frame, renderer, sums, params })
    }
}

impl CameraPoseLikelihood for PixelSpanLikelihood<'_> {
    fn log_likelihood(&mut self, camera_pose: &Pose3<f64>, light: &[ColorDensity]) -> LogWeight {
        let Ok(light) = light.iter().map(PixelSumDensity::new).collect::<Result<Vec<_>, _>>() else {
            return f64::NEG_INFINITY;
        };
        let margin = self.params.edge_margin_pixels;
        match gather(&mut self.renderer, |_| Some(self.frame), camera_pose, margin, &mut self.sums) {
            Ok(()) => log_likelihood(&self.sums, &light, &self.params),
            Err(_) => f64::NEG_INFINITY,
        }
    }
}

/// The likelihood from the sums of [`gather`].
pub(crate) fn log_likelihood(
    sums: &[PixelSums],
    light: &[PixelSumDensity],
    params: &PixelLikelihoodParams,
) -> LogWeight {
    let region = |(sums, density): (&PixelSums, &PixelSumDensity)| Region::new(sums, density.sum_log(sums));
    params.log_likelihood(sums.iter().zip(light).map(region))
}
