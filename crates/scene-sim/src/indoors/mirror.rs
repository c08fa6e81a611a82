use std::f64::consts::TAU;

use crate::scenery::RgbPicture;
use crate::{SimulationError, check};

/// A camera below a curved mirror: the elevation falls evenly from the outer to the inner radius of a ring in the middle of the picture.
///
/// The columns of the view follow each other clockwise from the right, so that the front is on the left of the centre. Unrolled the same way,
/// with the outer radius as the top row, the ring is the view again.
///
/// ```
/// use wayfix_scene_sim::{indoors::MirrorCamera, scenery::RgbPicture};
/// let view = RgbPicture { width: 4, height: 1, rgb: vec![200; 12] };
/// let image = MirrorCamera { side_px: 64, inner_px: 10.0, outer_px: 30.0 }.image(&view)?;
/// assert_eq!((image.width, image.rgb[0], image.rgb[3 * (32 * 64 + 52)]), (64, 0, 200));
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorCamera {
    /// Side of the square picture, pixels.
    pub side_px: usize,
    /// Radius that shows the lowest elevation, pixels.
    pub inner_px: f64,
    /// Radius that shows the highest elevation, pixels.
    pub outer_px: f64,
}

impl MirrorCamera {
    /// The raw picture for a view, which should be at least as fine; black beside the ring.
    ///
    /// # Errors
    /// Returns an error if the ring does not fit into the picture, or the view is empty or has an inconsistent size.
    pub fn image(&self, view: &RgbPicture) -> Result<RgbPicture, SimulationError> {
        check::count("side of the picture (pixels)", self.side_px, 1 << 14)?;
        check::not_negative("inner radius (pixels)", self.inner_px)?;
        check::above("outer radius (pixels)", self.outer_px, self.inner_px, "above the inner")?;
        check::at_most("outer radius (pixels)", self.outer_px, 0.5 * self.side_px as f64, "half the side")?;
        check::positive("pixels of the view", (view.width * view.height) as f64)?;
        check::at_most(
            "bytes of the view",
            (3 * view.width * view.height) as f64,
            view.rgb.len() as f64,
            "all there",
        )?;
        let centre = 0.5 * (self.side_px as f64 - 1.0);
        let pixel = |i: usize| {
            let (x, y) = ((i % self.side_px) as f64 - centre, (i / self.side_px) as f64 - centre);
            let depth = (self.outer_px - libm::hypot(x, y)) / (self.outer_px - self.inner_px);
            let turn = libm::atan2(y, x).rem_euclid(TAU) / TAU;
            if (0.0..1.0).contains(&depth) { interpolated(view, turn, depth) } else { [0; 3] }
        };
        let rgb = (0..self.side_px * self.side_px).flat_map(pixel).collect();
        Ok(RgbPicture { width: self.side_px, height: self.side_px, rgb })
    }
}

/// Interpolates at a share of a turn from the first column and a share of the height from the top.
fn interpolated(view: &RgbPicture, turn: f64, depth: f64) -> [u8; 3] {
    let (x, y) = (turn * view.width as f64 - 0.5, (depth * view.height as f64 - 0.5).max(0.0));
    let (left, above) = (x.floor(), y as usize);
    let (u, v) = (x - left, y - above as f64);
    let column = |step: i64| (left as i64 + step).rem_euclid(view.width as i64) as usize;
    let row = |step: usize| (above + step).min(view.height - 1);
    std::array::from_fn(|k| {
        let at =
            |step: i64, down: usize| f64::from(view.rgb[3 * (row(down) * view.width + column(step)) + k]);
        let (upper, lower) = (at(0, 0) * (1.0 - u) + at(1, 0) * u, at(0, 1) * (1.0 - u) + at(1, 1) * u);
        (upper * (1.0 - v) + lower * v).round() as u8
    })
}
