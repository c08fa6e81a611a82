use rand::Rng;

use super::super::canvas::Canvas;
use super::super::color::{about, from_hsv, grey, shaded};
use super::super::texture::Texture;
use crate::random::deviate::{chance, uniform};

/// A painted wall with posters, signs and doors.
pub(in crate::indoors) fn wall<R: Rng + ?Sized>(
    length_m: f64,
    height_m: f64,
    hue: f64,
    rng: &mut R,
) -> Texture {
    let paint = from_hsv(hue + uniform(-0.05, 0.05, rng), 0.12, uniform(0.6, 0.75, rng));
    let mut canvas = Canvas::new(length_m, height_m, paint);
    canvas.rectangle((0.0, 0.0), (length_m, 0.15), shaded(paint, 0.5));
    let mut x = uniform(0.3, 1.5, rng);
    while x < length_m {
        let width_m = uniform(0.5, 2.0, rng);
        let (any, right) = (uniform(0.0, 1.0, rng), x + width_m);
        if chance(0.2, rng) {
            canvas.rectangle((x, 0.0), (x + 1.0, 2.0), shaded(about(any, 0.0, rng), 0.6));
        } else {
            let bottom = uniform(0.4, 1.6, rng);
            let top = bottom + uniform(0.5, 1.2, rng);
            canvas.rectangle((x, bottom), (right, top), about(any, 0.0, rng));
            canvas.rectangle((x + 0.2, bottom + 0.15), (right - 0.2, bottom + 0.35), about(any, 0.3, rng));
        }
        if height_m > 4.0 && chance(0.4, rng) {
            canvas.rectangle((x, 3.0), (x + 2.0 * width_m, 4.2), about(any, 0.5, rng));
        }
        x = right + uniform(0.2, 2.5, rng);
    }
    canvas.finish()
}

/// The scene outside a window: ground, trees and houses, sky.
pub(in crate::indoors) fn outside<R: Rng + ?Sized>(length_m: f64, height_m: f64, rng: &mut R) -> Texture {
    let mut canvas = Canvas::new(length_m, height_m, [225, 235, 250]);
    let mut x = 0.0;
    while x < length_m {
        let width_m = uniform(0.8, 4.0, rng);
        let top = uniform(0.9, 2.2, rng);
        let color = if chance(0.5, rng) { about(0.3, 0.06, rng) } else { about(0.08, 0.1, rng) };
        canvas.rectangle((x, 0.0), (x + width_m, top), color);
        x += width_m;
    }
    canvas.rectangle((0.0, 0.0), (length_m, 0.7), grey(120));
    let mut frame = 0.0;
    while frame < length_m {
        canvas.rectangle((frame, 0.0), (frame + 0.1, height_m), grey(50));
        frame += 1.5;
    }
    canvas.finish()
}

/// One colour in folds.
pub(in crate::indoors) fn curtain<R: Rng + ?Sized>(length_m: f64, height_m: f64, rng: &mut R) -> Texture {
    let cloth = about(uniform(0.0, 1.0, rng), 0.0, rng);
    let mut canvas = Canvas::new(length_m, height_m, cloth);
    canvas.paint((0.0, 0.0), (length_m, height_m), |column, _| {
        shaded(cloth, [1.0, 0.85, 0.65, 0.85][column % 4])
    });
    canvas.finish()
}

/// A block in two or three colours: a stand with special offers, a desk, a cupboard.
pub(in crate::indoors) fn stand<R: Rng + ?Sized>(length_m: f64, height_m: f64, rng: &mut R) -> Texture {
    let hue = uniform(0.0, 1.0, rng);
    let mut canvas = Canvas::new(length_m, height_m, about(hue, 0.0, rng));
    canvas.rectangle((0.1, 0.3 * height_m), (length_m - 0.1, 0.6 * height_m), about(hue, 0.5, rng));
    canvas.rectangle((0.0, 0.8 * height_m), (length_m, height_m), about(hue, 0.5, rng));
    canvas.finish()
}
