//! Lines drawn into pictures.

use wayfix_condensation::BoundingBox;

pub(super) const TRUTH: [u8; 3] = [60, 220, 90];
pub(super) const ESTIMATE: [u8; 3] = [255, 225, 40];
pub(super) const LOST: [u8; 3] = [235, 60, 60];

/// The corners of a box, in order.
pub(super) fn corners(target: &BoundingBox) -> [[f64; 2]; 4] {
    let ([left, top], right, bottom) =
        (target.corner(), target.corner()[0] + target.width(), target.corner()[1] + target.height());
    [[left, top], [right, top], [right, bottom], [left, bottom]]
}

/// Draws a closed line, a pixel wide, as far as it lies in the picture.
pub(super) fn draw(pixels: &mut [[u8; 3]], width: usize, points: &[[f64; 2]], color: [u8; 3]) {
    let height = pixels.len() / width.max(1);
    let reach = 2.0 * (width + height) as f64;
    for (k, from) in points.iter().enumerate() {
        let to = points[(k + 1) % points.len()];
        let (du, dv) = (to[0] - from[0], to[1] - from[1]);
        // A line that is far longer than the picture is not worth its steps.
        let n_steps = du.abs().max(dv.abs()).ceil().clamp(1.0, reach);
        for step in 0..n_steps as usize {
            let share = step as f64 / n_steps;
            let (u, v) = (from[0] + share * du, from[1] + share * dv);
            if (0.0..width as f64).contains(&u) && (0.0..height as f64).contains(&v) {
                pixels[v as usize * width + u as usize] = color;
            }
        }
    }
}
