use std::f64::consts::TAU;

use crate::film::SyntheticFilm;
use crate::film::pose::{Pose, in_ellipse};
use crate::film::sine_sum::SineSum;
use crate::random::deviate::{below, uniform, unit};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, mix, scaled};

/// Amplitude of a hand-held camera's sway, px.
const SWAY_PX: f64 = 6.0;
const MARGIN_PX: usize = 8;

/// Background of the target, larger than the image, seen by a hand-held camera.
pub(super) struct Ground {
    albedo: Canvas,
    sway: [SineSum; 2],
}

impl Ground {
    /// Painted by `paint` on a canvas with a margin all around.
    pub(super) fn new(
        streams: &mut RandomStreams,
        paint: impl FnOnce((usize, usize), &mut RandomStreams) -> Canvas,
    ) -> Self {
        let (width, height) = SyntheticFilm::SIZE_PX;
        let albedo = paint((width + 2 * MARGIN_PX, height + 2 * MARGIN_PX), streams);
        let rng = streams.of(RandomStreamPurpose::Motion);
        Self { albedo, sway: [SineSum::new(5.0, rng), SineSum::new(4.0, rng)] }
    }

    /// The visible part at one moment.
    pub(super) fn at(&self, seconds: f64) -> impl Fn(f64, f64) -> Color + '_ {
        let margin = MARGIN_PX as f64 - 0.5; // the colour of a pixel is that of its centre
        let shift = self.sway.map(|swing| margin + SWAY_PX * swing.at(seconds));
        move |x, y| self.interpolated(x + shift[0], y + shift[1])
    }

    fn interpolated(&self, x: f64, y: f64) -> Color {
        let (left, top) = (x.floor(), y.floor());
        let pixel = |dx: usize, dy: usize| {
            let (column, row) = (left as usize + dx, top as usize + dy);
            self.albedo.pixels
                [row.min(self.albedo.height - 1) * self.albedo.width + column.min(self.albedo.width - 1)]
        };
        let upper = mix(pixel(0, 0), pixel(1, 0), x - left);
        mix(upper, mix(pixel(0, 1), pixel(1, 1), x - left), y - top)
    }
}

/// Scatters `n` leaves, or nearly round pebbles, each in a colour between two of the list.
pub(super) fn scatter(
    canvas: &mut Canvas,
    n: usize,
    radii: (f64, f64),
    slim: f64,
    colors: &[Color],
    streams: &mut RandomStreams,
) {
    let rng = streams.of(RandomStreamPurpose::Objects);
    let size = (canvas.width, canvas.height);
    for _ in 0..n {
        let centre = (unit(rng) * size.0 as f64, unit(rng) * size.1 as f64);
        let length = uniform(radii.0, radii.1, rng);
        let pose = Pose::new(centre, TAU * unit(rng), (length, length * slim * uniform(0.8, 1.2, rng)));
        let (one, other) = (colors[below(colors.len(), rng)], colors[below(colors.len(), rng)]);
        let color = mix(one, other, 0.5 * unit(rng));
        canvas.paint_in(
            &pose.window(1.2, size),
            |x, y| in_ellipse(pose.to_body(x, y), (0.0, 0.0), (1.0, 1.0)) * pose.px(),
            |x, y| {
                let (u, v) = pose.to_body(x, y);
                let vein = if v.abs() < 0.08 && slim < 0.7 { 0.75 } else { 1.0 };
                scaled(color, vein * (0.9 - 0.25 * v + 0.1 * u))
            },
        );
    }
}

/// Scatters `n` blades or twigs.
pub(super) fn strew(
    canvas: &mut Canvas,
    n: usize,
    lengths: (f64, f64),
    width: f64,
    colors: &[Color],
    streams: &mut RandomStreams,
) {
    let rng = streams.of(RandomStreamPurpose::Objects);
    for _ in 0..n {
        let from = (unit(rng) * canvas.width as f64, unit(rng) * canvas.height as f64);
        let (sin, cos) = libm::sincos(TAU * unit(rng));
        let (length, bend) = (uniform(lengths.0, lengths.1, rng), uniform(-0.25, 0.25, rng));
        let middle = (from.0 + length * (0.5 * cos - bend * sin), from.1 + length * (0.5 * sin + bend * cos));
        let color = scaled(colors[below(colors.len(), rng)], uniform(0.75, 1.2, rng));
        canvas.line(&[from, middle, (from.0 + length * cos, from.1 + length * sin)], width, |_, _| color);
    }
}
