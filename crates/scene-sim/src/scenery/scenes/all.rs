use crate::random::deviate::{below, uniform};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, mix, scaled};
use crate::scenery::noise::Noise;

const BRICKS: [Color; 4] = [[0.66, 0.34, 0.26], [0.76, 0.68, 0.52], [0.46, 0.50, 0.58], [0.84, 0.80, 0.74]];

/// A bit of everything: sky and clouds, hills, a row of houses, trees, a meadow with flowers, a pond.
pub(super) fn paint((width, height): (usize, usize), streams: &mut RandomStreams) -> Canvas {
    let (w, h) = (width as f64, height as f64);
    let noise = Noise::new(streams.of(RandomStreamPurpose::Texture));
    let mut canvas = Canvas::new(width, height, |x, y| {
        let sky = mix([0.28, 0.48, 0.82], [0.78, 0.86, 0.94], (2.2 * y / h).min(1.0));
        let cloud = (3.0 * noise.fractal(x / 130.0, y / 60.0, 5) - 1.4).clamp(0.0, 1.0);
        mix(sky, [0.97, 0.96, 0.94], cloud)
    });
    for (number, (level, tint)) in
        [(0.30, [0.44, 0.52, 0.62]), (0.38, [0.34, 0.46, 0.38]), (0.46, [0.26, 0.40, 0.22])]
            .into_iter()
            .enumerate()
    {
        let line = |x: f64| level * h - 150.0 * (noise.fractal(x / 110.0, 9.0 * number as f64, 5) - 0.45);
        canvas.paint(
            |x, y| y - line(x),
            |x, y| scaled(tint, 0.75 + 0.5 * noise.fractal(x / 25.0, y / 14.0, 3)),
        );
    }
    canvas.paint(
        |_, y| y - 0.60 * h,
        |x, y| {
            let grass = noise.fractal(x / 16.0, y / 9.0, 3);
            let patch = noise.fractal(x / 140.0, y / 90.0, 2);
            scaled(mix([0.28, 0.50, 0.16], [0.66, 0.62, 0.28], patch), 0.6 + 0.7 * grass)
        },
    );
    houses(&mut canvas, w, 0.62 * h, streams, &noise);
    canvas.ellipse((0.70 * w, 0.86 * h), (0.20 * w, 0.07 * h), |x, y| {
        mix([0.20, 0.34, 0.46], [0.62, 0.76, 0.86], noise.fractal(x / 60.0, y / 5.0, 3))
    });
    trees(&mut canvas, (w, h), streams, &noise);
    let rng = streams.of(RandomStreamPurpose::Objects);
    for _ in 0..150 {
        let (at, size) = ((uniform(0.0, 0.5 * w, rng), uniform(0.70 * h, h, rng)), uniform(1.5, 4.5, rng));
        let tint = [[0.92, 0.20, 0.24], [0.97, 0.86, 0.25], [0.80, 0.45, 0.85]][below(3, rng)];
        canvas.ellipse(at, (size, size), |_, _| tint);
    }
    canvas
}

fn houses(canvas: &mut Canvas, w: f64, ground: f64, streams: &mut RandomStreams, noise: &Noise) {
    let rng = streams.of(RandomStreamPurpose::Objects);
    let mut left = -10.0;
    while left < w {
        let (right, top) = (left + uniform(60.0, 110.0, rng), ground - uniform(60.0, 190.0, rng));
        let wall = scaled(BRICKS[below(BRICKS.len(), rng)], uniform(0.8, 1.1, rng));
        canvas.rectangle((left, top), (right, ground), |x, y| {
            scaled(wall, 0.8 + 0.35 * noise.fractal(x / 12.0, y / 6.0, 2))
        });
        canvas.rectangle((left - 3.0, top - 9.0), (right + 3.0, top), |_, _| {
            scaled([0.38, 0.18, 0.14], wall[1] + 0.4)
        });
        let mut y = top + 10.0;
        while y + 20.0 < ground {
            let mut x = left + 9.0;
            while x + 16.0 < right {
                let lit = uniform(0.0, 1.0, rng);
                let pane = if lit > 0.75 { [0.96, 0.88, 0.55] } else { [0.16, 0.20, 0.28] };
                canvas.rectangle((x, y), (x + 12.0, y + 17.0), |_, _| pane);
                x += 21.0;
            }
            y += 28.0;
        }
        left = right + uniform(0.0, 26.0, rng);
    }
}

fn trees(canvas: &mut Canvas, (w, h): (f64, f64), streams: &mut RandomStreams, noise: &Noise) {
    let rng = streams.of(RandomStreamPurpose::Objects);
    for _ in 0..9 {
        let (x, foot, size) = (uniform(0.0, w, rng), uniform(0.62, 0.78, rng) * h, uniform(26.0, 58.0, rng));
        let leaf = mix([0.10, 0.28, 0.10], [0.55, 0.45, 0.12], uniform(0.0, 1.0, rng));
        canvas.rectangle((x - 4.0, foot - size), (x + 4.0, foot), |_, _| [0.28, 0.19, 0.12]);
        canvas.paint(
            |u, v| {
                let (du, dv) = (u - x, (v - foot + 1.6 * size) / 1.2);
                0.8 * size
                    - (du * du + dv * dv).sqrt()
                    - 0.6 * size * (noise.fractal(u / 14.0, v / 14.0, 3) - 0.4)
            },
            |u, v| scaled(leaf, 0.5 + 1.1 * noise.fractal(u / 8.0, v / 8.0, 2)),
        );
    }
}
