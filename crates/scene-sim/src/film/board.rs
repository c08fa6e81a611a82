use crate::scenery::canvas::{Canvas, Color, times};

/// Paints the occluder that passes the target: a slate-coloured board with a grain.
pub(super) fn paint(canvas: &mut Canvas, (left, right): (f64, f64), light: Color) {
    let (top, bottom) = (-1.0, canvas.height as f64 + 1.0);
    canvas.rectangle((left, top), (right, bottom), |x, y| {
        let grain = libm::sin(0.9 * (x - left)) + 0.5 * libm::sin(2.3 * (x - left) + 0.02 * y);
        times([0.13, 0.16, 0.20].map(|albedo| albedo * (1.0 + 0.12 * grain)), light)
    });
}
