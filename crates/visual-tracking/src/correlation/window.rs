use std::f64::consts::{SQRT_2, TAU};

use super::channels::features::CELL;
use super::channels::patch::Patch;
use crate::RgbImage;

/// Cells along the window.
pub(super) const SIDE: usize = 48;
/// Pixels along the window once it is resampled.
pub(super) const PIXELS: usize = SIDE * CELL;

/// Position of the target, in image pixels, and its size relative to the first one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WindowPlace {
    pub(super) center: [f64; 2],
    pub(super) scale: f64,
}

/// The search square around the target: a grid of cells, the same for every size of the target.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// Size of the target at scale 1, in pixels of the picture.
    size: [f64; 2],
    /// Side of the window at scale 1, in pixels of the picture.
    side: f64,
    taper: Vec<f32>,
}

impl Window {
    /// `padding` times as wide as a square of the target's area, and always wider than the target.
    pub(super) fn around(size: [f64; 2], padding: f64) -> Self {
        let side = (padding * (size[0] * size[1]).sqrt()).max(1.6 * size[0].max(size[1]));
        let hann = |i: usize| 0.5 - 0.5 * libm::cos(TAU * (i as f64 + 0.5) / SIDE as f64);
        let taper = (0..SIDE * SIDE).map(|i| (hann(i % SIDE) * hann(i / SIDE)) as f32).collect();
        Self { size, side, taper }
    }

    /// Weights of the cells: 1 in the middle, 0 at the border.
    pub(super) fn taper(&self) -> &[f32] {
        &self.taper
    }

    /// Size of the target at a scale, in pixels of the picture.
    pub(super) fn size(&self, scale: f64) -> [f64; 2] {
        self.size.map(|side| side * scale)
    }

    /// Size of the target in pixels of the resampled window.
    pub(super) fn target_pixels(&self) -> [f64; 2] {
        self.size.map(|side| side * PIXELS as f64 / self.side)
    }

    /// Side of a square of the target's area, in cells.
    pub(super) fn target_cells(&self) -> f64 {
        (self.size[0] * self.size[1]).sqrt() * SIDE as f64 / self.side
    }

    /// The patch of the image in the window.
    pub(super) fn patch(&self, picture: &RgbImage, pose: WindowPlace) -> Patch {
        Patch::sampled(picture, pose.center, [self.side * pose.scale; 2], (PIXELS, PIXELS))
    }

    /// The patch of the image in an enlarged window, which can be [rotated](Self::turned).
    pub(super) fn surroundings(&self, picture: &RgbImage, pose: WindowPlace) -> Patch {
        let pixels = (PIXELS as f64 * SQRT_2).ceil() as usize;
        let extent = self.side * pose.scale * pixels as f64 / PIXELS as f64;
        Patch::sampled(picture, pose.center, [extent; 2], (pixels, pixels))
    }

    /// The window, turned by `angle` about its middle.
    pub(super) fn turned(surroundings: &Patch, angle: f64) -> Patch {
        surroundings.turned(angle, PIXELS)
    }

    /// `pose` moved by `shift` cells.
    pub(super) fn moved(&self, pose: WindowPlace, shift: [f64; 2]) -> WindowPlace {
        let per_cell = self.side * pose.scale / SIDE as f64;
        let center = [0, 1].map(|axis| pose.center[axis] + shift[axis] * per_cell);
        WindowPlace { center, ..pose }
    }

    /// 1 in cells of the target, 0 outside, a share in cells that it partly covers.
    pub(super) fn support(&self) -> Vec<f32> {
        let covered = |i: usize, axis: usize| {
            let cells = self.size[axis] * SIDE as f64 / self.side;
            let off = (i as f64 + 0.5 - SIDE as f64 / 2.0).abs();
            (0.5 * cells + 0.5 - off).clamp(0.0, 1.0)
        };
        (0..SIDE * SIDE).map(|i| (covered(i % SIDE, 0) * covered(i / SIDE, 1)) as f32).collect()
    }

    /// Prior probability of shifts, in the order of a response: a Gaussian of `width` sides of the target.
    pub(super) fn shift_prior(&self, width: f64) -> Vec<f32> {
        let sigma = width * self.target_cells();
        let along: Vec<f64> = (0..SIDE).map(|i| libm::exp(-0.5 * (signed(i) / sigma).powi(2))).collect();
        (0..SIDE * SIDE).map(|i| (along[i % SIDE] * along[i / SIDE]) as f32).collect()
    }

    /// Mean of `values` of the pixels over the target's box shifted by whole cells, in the order of a response.
    pub(super) fn box_means(&self, values: &[f32]) -> Vec<f32> {
        let stride = PIXELS + 1;
        let mut sums = vec![0.0_f64; stride * stride];
        for y in 0..PIXELS {
            let mut row = 0.0;
            for x in 0..PIXELS {
                row += f64::from(values[y * PIXELS + x]);
                sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
            }
        }
        let size = self.target_pixels();
        let range = |shift: usize, len: f64| {
            let middle = PIXELS as f64 / 2.0 + signed(shift) * CELL as f64;
            let clamp = |v: f64| v.round().clamp(0.0, PIXELS as f64) as usize;
            (clamp(middle - len / 2.0), clamp(middle + len / 2.0))
        };
        let mut means = Vec::with_capacity(SIDE * SIDE);
        for y in 0..SIDE {
            let (top, bottom) = range(y, size[1]);
            for x in 0..SIDE {
                let (left, right) = range(x, size[0]);
                let at = |x: usize, y: usize| sums[y * stride + x];
                let sum = at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top);
                means.push((sum / (size[0] * size[1])) as f32);
            }
        }
        means
    }

    /// Centres of windows that cover a picture, less than half a window apart.
    pub(super) fn tiles(&self, picture_size: (usize, usize), scale: f64) -> Vec<[f64; 2]> {
        let step = 0.4 * self.side * scale;
        let along = |len: usize| {
            let n = ((len as f64 / step).ceil() as usize).clamp(1, 64);
            (0..n).map(move |i| (i as f64 + 0.5) * len as f64 / n as f64)
        };
        let (width, height) = picture_size;
        along(height).flat_map(|v| along(width).map(move |u| [u, v])).collect()
    }
}

/// A shift in cells, from its place in a response.
fn signed(i: usize) -> f64 {
    if i > SIDE / 2 { i as f64 - SIDE as f64 } else { i as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn means_over_the_box_are_those_of_its_pixels() {
        let window = Window::around([24.0, 36.0], 4.0);
        let values: Vec<f32> = (0..PIXELS * PIXELS).map(|i| ((i * 7919) % 101) as f32).collect();
        let means = window.box_means(&values);
        let [width, height] = window.target_pixels();
        let (shift_x, shift_y) = (3_usize, SIDE - 2);
        let range = |middle: f64, len: f64| {
            (middle - len / 2.0).round() as usize..(middle + len / 2.0).round() as usize
        };
        let (columns, rows) = (range(96.0 + 12.0, width), range(96.0 - 8.0, height));
        let sum: f32 = rows.map(|y| values[y * PIXELS..][columns.clone()].iter().sum::<f32>()).sum();
        let expected = sum / (width * height) as f32;
        assert_abs_diff_eq!(means[shift_y * SIDE + shift_x], expected, epsilon = 1e-2);
    }

    #[test]
    fn every_pixel_of_a_picture_is_near_the_middle_of_a_tile() {
        let window = Window::around([20.0, 20.0], 4.0);
        let tiles = window.tiles((320, 240), 1.0);
        for (u, v) in (0..240).flat_map(|v| (0..320).map(move |u| (u as f64, v as f64))) {
            let near = |tile: &[f64; 2]| (tile[0] - u).abs() <= 16.0 && (tile[1] - v).abs() <= 16.0;
            assert!(tiles.iter().any(near), "a quarter of a window of 80 pixels at most: {u} {v}");
        }
    }
}
