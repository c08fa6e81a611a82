//! Draws lines into images.

use image::{Rgb, RgbImage};
use wayfix_visual_tracking::BoundingBox;

pub(in crate::track) const TRUTH: [u8; 3] = [60, 220, 90];
pub(in crate::track) const ESTIMATE: [u8; 3] = [255, 225, 40];
pub(in crate::track) const LOST: [u8; 3] = [235, 60, 60];

/// The corners of a box, in order.
pub(in crate::track) fn corners(target: &BoundingBox) -> [[f64; 2]; 4] {
    let ([left, top], right, bottom) =
        (target.corner(), target.corner()[0] + target.width(), target.corner()[1] + target.height());
    [[left, top], [right, top], [right, bottom], [left, bottom]]
}

/// Draws a closed line one pixel wide, clipped to the image.
pub(in crate::track) fn draw(picture: &mut RgbImage, points: &[[f64; 2]], color: [u8; 3]) {
    let [width, height] = [picture.width(), picture.height()].map(f64::from);
    let reach = 2.0 * (width + height);
    for (k, from) in points.iter().enumerate() {
        let to = points[(k + 1) % points.len()];
        let (du, dv) = (to[0] - from[0], to[1] - from[1]);
        // Bound the number of steps of a line much longer than the image.
        let n_steps = du.abs().max(dv.abs()).ceil().clamp(1.0, reach);
        for step in 0..n_steps as usize {
            let share = step as f64 / n_steps;
            let (u, v) = (from[0] + share * du, from[1] + share * dv);
            if (0.0..width).contains(&u) && (0.0..height).contains(&v) {
                picture.put_pixel(u as u32, v as u32, Rgb(color));
            }
        }
    }
}
