use crate::random::deviate::{below, uniform};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, mix, scaled};
use crate::scenery::noise::Noise;

const BACKS: [Color; 6] = [
    [0.70, 0.16, 0.14],
    [0.14, 0.30, 0.58],
    [0.20, 0.48, 0.26],
    [0.86, 0.74, 0.22],
    [0.85, 0.84, 0.80],
    [0.18, 0.16, 0.20],
];

/// A laboratory: shelves of books, a window, a desk with screens, a robot under it.
pub(super) fn paint((width, height): (usize, usize), streams: &mut RandomStreams) -> Canvas {
    let (w, h) = (width as f64, height as f64);
    let noise = Noise::new(streams.of(RandomStreamPurpose::Texture));
    let mut canvas = Canvas::new(width, height, |x, y| {
        scaled(
            [0.76, 0.78, 0.72],
            0.70 + 0.40 * x / w - 0.14 * y / h + 0.10 * (noise.fractal(x / 90.0, y / 90.0, 3) - 0.5),
        )
    });
    for shelf in 0..4 {
        books(&mut canvas, (0.03 * w, 0.46 * w), (0.14 + 0.13 * f64::from(shelf)) * h, streams);
    }
    window(&mut canvas, (0.64 * w, 0.06 * h), (0.95 * w, 0.44 * h), &noise);
    canvas.rectangle((0.0, 0.84 * h), (w, h), |x, y| {
        scaled([0.34, 0.35, 0.38], 0.7 + 0.6 * noise.fractal(x / 40.0, y / 12.0, 4))
    });
    canvas.rectangle((0.16 * w, 0.67 * h), (w, 0.72 * h), |x, y| {
        scaled([0.66, 0.46, 0.27], 0.7 + 0.5 * noise.fractal(x / 90.0, y / 4.0, 3))
    });
    for leg in [0.18, 0.60, 0.97] {
        canvas.rectangle((leg * w, 0.72 * h), (leg * w + 10.0, 0.93 * h), |_, _| [0.22, 0.20, 0.20]);
    }
    let screens = [
        (0.50, 0.16, [0.10, 0.16, 0.34]),
        (0.70, 0.17, [0.08, 0.25, 0.18]),
        (0.88, 0.13, [0.80, 0.82, 0.86]),
    ];
    for (at, size, tint) in screens {
        screen(&mut canvas, (at * w, 0.67 * h), size * w, tint, &noise);
    }
    robot(&mut canvas, (0.38 * w, 0.92 * h));
    canvas
}

fn books(canvas: &mut Canvas, (left, right): (f64, f64), board: f64, streams: &mut RandomStreams) {
    let rng = streams.of(RandomStreamPurpose::Objects);
    let mut x = left;
    while x < right - 18.0 {
        let (next, tall) = (x + uniform(6.0, 18.0, rng), uniform(34.0, 58.0, rng));
        let back = scaled(BACKS[below(BACKS.len(), rng)], uniform(0.7, 1.1, rng));
        canvas.rectangle((x, board - tall), (next, board), |u, v| {
            let label = (v - board + 0.6 * tall).abs() < 5.0;
            let round = 1.0 - 0.5 * ((2.0 * u - x - next) / (next - x)).powi(2);
            scaled(if label { [0.9, 0.85, 0.6] } else { back }, round)
        });
        x = next + if uniform(0.0, 1.0, rng) > 0.9 { 22.0 } else { 0.5 };
    }
    canvas.rectangle((left - 6.0, board), (right + 6.0, board + 8.0), |_, _| [0.50, 0.33, 0.18]);
}

fn window(canvas: &mut Canvas, from: (f64, f64), to: (f64, f64), noise: &Noise) {
    canvas.rectangle((from.0 - 8.0, from.1 - 8.0), (to.0 + 8.0, to.1 + 8.0), |_, _| [0.93, 0.92, 0.90]);
    canvas.rectangle(from, to, |x, y| {
        let sky = mix([0.58, 0.76, 0.96], [0.93, 0.96, 1.0], noise.fractal(x / 50.0, y / 26.0, 4));
        let roof = to.1 - 55.0 + 40.0 * (noise.at(x / 34.0, 5.0) - 0.5);
        if y > roof {
            scaled([0.50, 0.40, 0.36], 0.6 + 0.6 * noise.fractal(x / 9.0, y / 9.0, 2))
        } else {
            sky
        }
    });
    let middle = 0.5 * (from.0 + to.0);
    canvas.rectangle((middle - 4.0, from.1), (middle + 4.0, to.1), |_, _| [0.93, 0.92, 0.90]);
}

fn screen(canvas: &mut Canvas, (x, foot): (f64, f64), size: f64, tint: Color, noise: &Noise) {
    let (half, tall) = (0.5 * size, 0.72 * size);
    canvas.rectangle((x - 8.0, foot - 18.0), (x + 8.0, foot), |_, _| [0.25, 0.25, 0.27]);
    canvas.rectangle((x - half, foot - 16.0 - tall), (x + half, foot - 14.0), |_, _| [0.14, 0.14, 0.15]);
    canvas.rectangle((x - half + 6.0, foot - 10.0 - tall), (x + half - 6.0, foot - 21.0), |u, v| {
        let row = (v / 5.0).floor();
        let written = v - 5.0 * row < 2.0 && noise.at(u / 9.0, 2.3 * row) > 0.5;
        if written {
            mix(tint, [0.75, 0.95, 0.75], 0.8)
        } else {
            scaled(tint, 0.85 + 0.3 * (foot - v) / tall)
        }
    });
}

fn robot(canvas: &mut Canvas, (x, y): (f64, f64)) {
    canvas.rectangle((x - 46.0, y - 62.0), (x + 46.0, y - 12.0), |_, v| {
        scaled([0.85, 0.42, 0.10], 1.5 - v / y * 0.6)
    });
    for wheel in [-28.0, 28.0] {
        canvas.ellipse((x + wheel, y - 10.0), (16.0, 16.0), |_, _| [0.10, 0.10, 0.11]);
        canvas.ellipse((x + wheel, y - 10.0), (6.0, 6.0), |_, _| [0.70, 0.70, 0.72]);
    }
    canvas.ellipse((x, y - 74.0), (20.0, 14.0), |u, _| scaled([0.25, 0.55, 0.85], 1.0 + (u - x) / 60.0));
}
