use rand_chacha::ChaCha8Rng;

use crate::random::deviate::{below, uniform};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, mix, scaled};
use crate::scenery::noise::Noise;

const SEA: Color = [0.56, 0.74, 0.90];
const COUNTRIES: [Color; 6] = [
    [0.96, 0.80, 0.56],
    [0.74, 0.87, 0.58],
    [0.95, 0.66, 0.66],
    [0.80, 0.71, 0.88],
    [0.97, 0.93, 0.60],
    [0.68, 0.84, 0.80],
];

/// A political map: countries in flat colours, a sea, rivers, roads, towns.
pub(super) fn paint((width, height): (usize, usize), streams: &mut RandomStreams) -> Canvas {
    let (w, h) = (width as f64, height as f64);
    let noise = Noise::new(streams.of(RandomStreamPurpose::Texture));
    let rng = streams.of(RandomStreamPurpose::Objects);
    let capitals: Vec<((f64, f64), Color)> = (0..26)
        .map(|_| {
            let tint = scaled(COUNTRIES[below(COUNTRIES.len(), rng)], uniform(0.80, 1.02, rng));
            ((uniform(0.0, w, rng), uniform(0.0, h, rng)), tint)
        })
        .collect();
    let mut canvas = Canvas::new(width, height, |x, y| {
        let bent = |x: f64, y: f64| 70.0 * (noise.fractal(x / 75.0, y / 75.0, 4) - 0.5);
        country(&capitals, (x + bent(x, y), y + bent(y + 900.0, x)))
    });
    let coast = |x: f64, y: f64| {
        let land = 0.30 * h + 0.22 * x - 190.0 * (noise.fractal(x / 130.0, y / 130.0, 4) - 0.5);
        land - (h - y)
    };
    canvas
        .paint(|x, y| 0.5 * coast(x, y), |x, y| mix(SEA, [0.30, 0.52, 0.80], (coast(x, y) / 220.0).min(1.0)));
    for _ in 0..7 {
        let start = (uniform(0.0, w, rng), uniform(0.0, 0.8 * h, rng));
        let points = wander(start, 14.0, 26, rng);
        canvas.line(&points, uniform(1.5, 4.5, rng), |_, _| [0.28, 0.50, 0.82]);
    }
    for _ in 0..9 {
        let start = (uniform(0.0, w, rng), uniform(0.0, 0.9 * h, rng));
        let points = wander(start, 22.0, 14, rng);
        canvas.line(&points, uniform(1.5, 3.0, rng), |_, _| [0.80, 0.20, 0.15]);
    }
    for _ in 0..60 {
        let (at, size) = ((uniform(0.0, w, rng), uniform(0.0, h, rng)), uniform(2.0, 6.0, rng));
        canvas.ellipse(at, (size, size), |_, _| [0.15, 0.12, 0.12]);
        let (from, to) = ((at.0 + 8.0, at.1 - 4.0), (at.0 + 8.0 + 9.0 * size, at.1 + 3.0));
        canvas.rectangle(from, to, |x, _| {
            if (x / 3.0).floor().rem_euclid(3.0) < 2.0 { [0.2; 3] } else { [0.85; 3] }
        });
    }
    canvas
}

/// The colour of the nearest capital, with a border between countries.
fn country(capitals: &[((f64, f64), Color)], (x, y): (f64, f64)) -> Color {
    let (mut nearest, mut second, mut color) = (f64::INFINITY, f64::INFINITY, COUNTRIES[0]);
    for (at, tint) in capitals {
        let distance = ((x - at.0).powi(2) + (y - at.1).powi(2)).sqrt();
        if distance < nearest {
            (nearest, second, color) = (distance, nearest, *tint);
        } else {
            second = second.min(distance);
        }
    }
    mix([0.45, 0.30, 0.40], color, ((second - nearest) / 5.0).clamp(0.0, 1.0))
}

/// A path that bends a little at every step.
fn wander(start: (f64, f64), step: f64, n: usize, rng: &mut ChaCha8Rng) -> Vec<(f64, f64)> {
    let mut heading = uniform(0.0, std::f64::consts::TAU, rng);
    let mut points = vec![start];
    for _ in 0..n {
        heading += uniform(-0.6, 0.6, rng);
        let last = points[points.len() - 1];
        points.push((last.0 + step * libm::cos(heading), last.1 + step * libm::sin(heading)));
    }
    points
}
