use wayfix_color_map::{LabelImage, MapRenderer};
use wayfix_estimation_traits::{LogWeight, Pose3};

use super::{CameraPoseLikelihood, PixelLikelihoodParams, PixelSumDensity, params::Region};
use crate::{ColorDensity, ColorModelError, YuvImage, frame};

/// The pixel product [Schulz & Fox 2004, Eq. 16], computed pixel by pixel: the reference implementation.
///
/// Each pixel that the projected map labels with colour `m` counts $`\ln p(c|m) - \ln p_{bg}(c)`$. The paper omits background pixels; without
/// the ratio, poses that label different numbers of pixels would not be comparable.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{Matrix3, Vector3};
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera};
/// # use wayfix_color_model::{CameraPoseLikelihood, ColorDensity, PixelLikelihood, PixelLikelihoodParams, YuvImage};
/// # use wayfix_estimation_traits::{LieGroup, Pose3};
/// # let vertices = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]].map(|[y, z]| Vector3::new(2.0, y, z)).to_vec();
/// # let wall = ColoredShape::Polygon { color: ColorId(0), vertices };
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![wall])?);
/// # let renderer = MapRenderer::new(map, PinholeCamera::from_field_of_view(4, 2, 1.0, 0.5)?);
/// let image = YuvImage::new(4, 2, vec![[90, 110, 100]; 8])?; // a green wall fills the view
/// let mut likelihood = PixelLikelihood::new(&image, |_| Some(10.0), renderer, PixelLikelihoodParams::default())?;
/// let mut log = |y| {
///     let density = ColorDensity { mean: Vector3::new(y, 110.0, 100.0), covariance: Matrix3::identity() * 25.0 };
///     likelihood.log_likelihood(&Pose3::identity(), &[density])
/// };
/// assert!((log(90.0) - 8.0 * (10.0 - 1.5 * (25.0 * std::f64::consts::TAU).ln())).abs() < 1e-9);
/// assert!((log(10.0) - 8.0 * 0.1_f64.ln()).abs() < 1e-9); // an outlier of probability 0.1 in each pixel
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct PixelLikelihood<'a> {
    image: &'a YuvImage,
    background: Vec<Option<f64>>,
    renderer: MapRenderer,
    params: PixelLikelihoodParams,
}

impl<'a> PixelLikelihood<'a> {
    /// The likelihood of one image; `nats` gives a pixel's $`-\ln p_{bg}(c)`$, or `None` for an outlier, as for
    /// [`PrefixSumImage::with_background`](crate::PrefixSumImage::with_background).
    ///
    /// # Errors
    /// Returns an error if image and camera differ in size, or a parameter is out of range.
    pub fn new(
        image: &'a YuvImage,
        nats: impl FnMut([u8; 3]) -> Option<f64>,
        renderer: MapRenderer,
        params: PixelLikelihoodParams,
    ) -> Result<Self, ColorModelError> {
        params.check()?;
        check_size(&renderer, image.width() as usize, image.height() as usize)?;
        let background =
            image.pixels().iter().copied().map(nats).map(|nats| nats.map(frame::rounded)).collect();
        Ok(Self { image, background, renderer, params })
    }
}

impl CameraPoseLikelihood for PixelLikelihood<'_> {
    fn log_likelihood(&mut self, camera_pose: &Pose3<f64>, light: &[ColorDensity]) -> LogWeight {
        let Ok(light) = light.iter().map(PixelSumDensity::new).collect::<Result<Vec<_>, _>>() else {
            return f64::NEG_INFINITY;
        };
        let Ok(labels) = self.renderer.labels(camera_pose) else {
            return f64::NEG_INFINITY;
        };
        let mut regions = vec![Region::default(); light.len()];
        for (at, (pixel, nats)) in self.image.pixels().iter().zip(&self.background).enumerate() {
            let (row, column) = (at as u32 / labels.width(), at as u32 % labels.width());
            let Some(color) = labels.get(column, row) else { continue };
            let (Some(region), Some(density)) = (regions.get_mut(color.index()), light.get(color.index()))
            else {
                continue;
            };
            if !is_inside(&labels, column, row, u32::from(self.params.edge_margin_pixels)) {
                continue;
            }
            match nats {
                Some(nats) => {
                    region.count += 1.0;
                    region.background += nats;
                    region.log_density += density.log(*pixel);
                }
                None => region.n_outliers += 1.0,
            }
        }
        self.params.log_likelihood(regions.into_iter())
    }
}

/// Whether all pixels of the image up to `margin` away have the same label.
fn is_inside(labels: &LabelImage, column: u32, row: u32, margin: u32) -> bool {
    let columns = column.saturating_sub(margin)..(column + margin + 1).min(labels.width());
    let mut rows = row.saturating_sub(margin)..(row + margin + 1).min(labels.height());
    rows.all(|r| columns.clone().all(|c| labels.get(c, r) == labels.get(column, row)))
}

pub(crate) fn check_size(renderer: &MapRenderer, width: usize, height: usize) -> Result<(), ColorModelError> {
    let camera = renderer.camera();
    let expected = (camera.width() as usize, camera.height() as usize);
    if expected == (width, height) {
        Ok(())
    } else {
        Err(ColorModelError::FrameSize { expected, got: (width, height) })
    }
}
