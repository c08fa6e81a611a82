use crate::random::deviate::uniform;
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, mix, scaled};
use crate::scenery::noise::Noise;

const PLASTER: Color = [0.80, 0.74, 0.62];
const STEEL: Color = [0.55, 0.58, 0.62];
const TILES: Color = [0.44, 0.30, 0.24];
const LEAF: Color = [0.16, 0.42, 0.18];

/// A lift lobby: two steel doors in a plastered wall, buttons, a notice, a plant, a lamp, tiles.
pub(super) fn paint((width, height): (usize, usize), streams: &mut RandomStreams) -> Canvas {
    let (w, h) = (width as f64, height as f64);
    let noise = Noise::new(streams.of(RandomStreamPurpose::Texture));
    let floor = 0.80 * h;
    let mut canvas = Canvas::new(width, height, |x, y| {
        let lamp = ((x - 0.3 * w) / w).powi(2) + (y / h).powi(2);
        scaled(
            PLASTER,
            0.62 + 0.45 / (1.0 + 3.0 * lamp) + 0.12 * (noise.fractal(x / 60.0, y / 60.0, 3) - 0.5),
        )
    });
    canvas.rectangle((0.0, floor), (w, h), |x, y| {
        let depth = (y - floor) / (h - floor) + 0.35;
        let (column, row) = (((x - 0.5 * w) / (90.0 * depth)).floor(), (6.0 * depth * depth).floor());
        let odd = (column + row).rem_euclid(2.0);
        scaled(TILES, 0.7 + 0.5 * odd + 0.3 * noise.fractal(x / 30.0, y / 30.0, 2))
    });
    for (left, right, dim) in [(0.10, 0.40, 1.0), (0.52, 0.82, 0.72)] {
        door(&mut canvas, (left * w, right * w), (0.16 * h, floor), dim, &noise);
    }
    buttons(&mut canvas, (0.46 * w, 0.44 * h));
    canvas.rectangle((0.86 * w, 0.20 * h), (0.97 * w, 0.42 * h), |x, y| {
        let lines = noise.at(x / 7.0, (y / 6.0).floor() * 3.7);
        if (y / 3.0).floor().rem_euclid(2.0) > 0.5 && lines > 0.4 {
            [0.2, 0.2, 0.45]
        } else {
            [0.93, 0.93, 0.85]
        }
    });
    canvas.ellipse((0.30 * w, 0.02 * h), (0.10 * w, 0.05 * h), |_, _| [1.0, 0.98, 0.86]);
    plant(&mut canvas, (0.91 * w, floor + 0.05 * h), 0.16 * h, streams);
    canvas
}

fn door(canvas: &mut Canvas, (left, right): (f64, f64), (top, bottom): (f64, f64), dim: f64, noise: &Noise) {
    let frame = 9.0;
    canvas.rectangle((left - frame, top - frame), (right + frame, bottom), |_, y| {
        scaled([0.30, 0.28, 0.26], 1.1 - 0.4 * y / bottom)
    });
    canvas.rectangle((left, top), (right, bottom), |x, y| {
        let brushed = noise.at(x / 2.5, y / 90.0);
        let sheen = noise.fractal((x + 0.4 * y) / 70.0, 3.0, 2);
        scaled(STEEL, dim * (0.55 + 0.25 * brushed + 0.7 * sheen))
    });
    let middle = 0.5 * (left + right);
    canvas.rectangle((middle - 1.5, top), (middle + 1.5, bottom), |_, _| [0.10, 0.10, 0.11]);
    canvas.rectangle((middle - 26.0, top - 40.0), (middle + 26.0, top - 18.0), |x, _| {
        if (x - middle).abs() < 8.0 { [0.95, 0.25 * dim, 0.10] } else { [0.08, 0.05, 0.05] }
    });
}

fn buttons(canvas: &mut Canvas, (x, y): (f64, f64)) {
    canvas.rectangle((x - 11.0, y - 30.0), (x + 11.0, y + 30.0), |_, v| {
        scaled([0.72, 0.66, 0.42], 0.8 + 0.005 * (v - y))
    });
    canvas.ellipse((x, y - 12.0), (6.0, 6.0), |_, _| [0.98, 0.85, 0.40]);
    canvas.ellipse((x, y + 12.0), (6.0, 6.0), |_, _| [0.30, 0.28, 0.25]);
}

fn plant(canvas: &mut Canvas, (x, y): (f64, f64), size: f64, streams: &mut RandomStreams) {
    let rng = streams.of(RandomStreamPurpose::Objects);
    for _ in 0..26 {
        let (dx, dy) = (uniform(-0.45, 0.45, rng) * size, uniform(0.25, 1.3, rng) * size);
        let radii = (uniform(0.05, 0.12, rng) * size, uniform(0.10, 0.22, rng) * size);
        let shade = mix(LEAF, [0.45, 0.62, 0.20], uniform(0.0, 0.8, rng));
        canvas.ellipse((x + dx, y - dy), radii, |_, v| scaled(shade, 1.1 - 0.3 * (v - y + dy) / radii.1));
    }
    canvas.rectangle((x - 0.2 * size, y - 0.35 * size), (x + 0.2 * size, y), |u, _| {
        scaled([0.62, 0.28, 0.16], 0.8 + 1.2 * (u - x) / size)
    });
}
