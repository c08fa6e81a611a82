use std::f64::consts::TAU;

use super::{LeagueScene, SceneModel};
use crate::film::daylight::Daylight;
use crate::film::ground::{Ground, scatter, strew};
use crate::film::pose::{Pose, in_ellipse};
use crate::film::sine_sum::SineSum;
use crate::film::{Silhouette, SyntheticFilm};
use crate::random::deviate::{chance, uniform, unit};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, distance, mix, scaled, times};
use crate::scenery::noise::Noise;

const WING: Color = [0.045, 0.115, 0.055];
const BRONZE: Color = [0.15, 0.085, 0.03];
const SPOT: Color = [0.55, 0.24, 0.04];
const THORAX: Color = [0.030, 0.028, 0.050];
const LEG: Color = [0.035, 0.028, 0.022];
/// Strides a second.
const GAIT_HZ: f64 = 2.5;

/// A beetle that walks over the ground, seen from above: wing cases with spots, thorax and head; its legs and feelers are not part of the
/// target. [Andrade-Cetto 2005, Sec. 3.4, third sequence]
pub(super) struct Beetle {
    ground: Ground,
    daylight: Daylight,
    start: f64,
    rate: f64,
    path: [SineSum; 2],
    turn: SineSum,
    size: SineSum,
    slant: SineSum,
}

impl Beetle {
    pub(super) fn new(streams: &mut RandomStreams) -> Self {
        let ground = Ground::new(streams, sandy_ground);
        let daylight = Daylight::new(streams);
        let rng = streams.of(RandomStreamPurpose::Motion);
        let sense = if chance(0.5, rng) { 1.0 } else { -1.0 };
        let (start, rate) = (TAU * unit(rng), sense * TAU / uniform(8.0, 10.0, rng));
        let path = [SineSum::new(7.0, rng), SineSum::new(6.0, rng)];
        let (turn, size, slant) = (SineSum::new(3.0, rng), SineSum::new(6.0, rng), SineSum::new(5.0, rng));
        Self { ground, daylight, start, rate, path, turn, size, slant }
    }

    /// Once round in some nine seconds, nearer to the middle and farther from it.
    fn place(&self, seconds: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(self.start + self.rate * seconds);
        let [wide, high] = self.path.map(|swing| swing.between(0.7, 1.1, seconds));
        (160.0 + 90.0 * wide * cos, 120.0 + 58.0 * high * sin)
    }

    /// Its heading roughly follows its path.
    fn pose(&self, seconds: f64, aside: f64) -> Pose {
        let (before, after) = (self.place(seconds - 0.4), self.place(seconds + 0.4));
        let angle = libm::atan2(after.1 - before.1, after.0 - before.0) + 0.15 * self.turn.at(seconds);
        let size = self.size.between(33.0, 43.0, seconds);
        let (x, y) = self.place(seconds);
        Pose::new((x + aside, y), angle, (size, size * self.slant.between(0.85, 1.05, seconds)))
    }
}

impl SceneModel for Beetle {
    fn render(&self, seconds: f64, aside: f64) -> LeagueScene {
        let size = SyntheticFilm::SIZE_PX;
        let pose = self.pose(seconds, aside);
        let (ground, light) = (self.ground.at(seconds), self.daylight.at(seconds));
        // The soft shadow is to the lower right of the body.
        let shadow = |x: f64, y: f64| {
            let depth = body(pose.to_body(x - 4.0, y - 4.0)) * pose.px();
            1.0 - 0.55 * (0.5 + depth / 5.0).clamp(0.0, 1.0)
        };
        let mut canvas =
            Canvas::new(size.0, size.1, |x, y| scaled(times(ground(x, y), light(x, y)), shadow(x, y)));
        let window = pose.window(1.7, size);
        canvas.paint_in(
            &window,
            |x, y| limbs(pose.to_body(x, y), seconds) * pose.px(),
            |x, y| times(LEG, light(x, y)),
        );
        let inside = |x: f64, y: f64| body(pose.to_body(x, y)) * pose.px();
        canvas.paint_in(&window, inside, |x, y| shade(pose.to_body(x, y), light(x, y)));
        let target = Silhouette::of(size, &window, inside);
        LeagueScene { canvas, target, distractor: Silhouette::empty(size) }
    }

    fn light(&self, seconds: f64) -> Color {
        self.daylight.at(seconds)(160.0, 120.0)
    }
}

/// Wing cases, thorax and head; the head points along the first axis.
fn body(spot: (f64, f64)) -> f64 {
    let wings = in_ellipse(spot, (-0.28, 0.0), (0.72, 0.50));
    let thorax = in_ellipse(spot, (0.42, 0.0), (0.30, 0.40));
    let head = in_ellipse(spot, (0.74, 0.0), (0.20, 0.24));
    wings.max(thorax).max(head)
}

/// Six legs that swing in two groups of three, and two feelers.
fn limbs(spot: (f64, f64), seconds: f64) -> f64 {
    let mut nearest = f64::INFINITY;
    for side in [-1.0, 1.0] {
        for (i, root) in [0.45, 0.12, -0.2].into_iter().enumerate() {
            let group = if (i == 1) == (side > 0.0) { 0.0 } else { 0.5 };
            let swing = 0.16 * libm::sin(TAU * (GAIT_HZ * seconds + group));
            let reach = [0.35, 0.0, -0.45][i] + swing;
            let knee = (root + 0.5 * reach, side * 0.72);
            let foot = (root + reach, side * 1.0);
            nearest = nearest.min(distance(spot, (root, side * 0.3), knee)).min(distance(spot, knee, foot));
        }
        nearest = nearest.min(distance(spot, (0.85, side * 0.1), (1.25, side * 0.42)));
    }
    0.035 - nearest
}

fn shade(spot: (f64, f64), light: Color) -> Color {
    let (u, v) = spot;
    if in_ellipse(spot, (0.42, 0.0), (0.30, 0.40)) > 0.0 || u > 0.5 {
        let shine = gloss(spot, (0.48, -0.16), 0.12);
        return sheen(times(THORAX, light), light, 0.5 * shine);
    }
    let spotted = [(0.02, 0.26), (-0.55, 0.24)]
        .into_iter()
        .any(|centre| in_ellipse((u, v.abs()), centre, (0.15, 0.11)) > 0.0);
    let seam = if v.abs() < 0.025 { 0.35 } else { 1.0 };
    let rim = 1.0 - 0.5 * (v.abs() / 0.5).powi(3);
    let case = if spotted { SPOT } else { mix(WING, BRONZE, (0.5 - 0.9 * u).clamp(0.0, 1.0)) };
    let shine = gloss(spot, (-0.22, -0.2), 0.22).max(0.5 * gloss(spot, (-0.5, 0.1), 0.12));
    sheen(scaled(times(case, light), seam * rim), light, 0.6 * shine)
}

/// Reflection of the sky on a smooth round back near one point.
fn gloss(spot: (f64, f64), centre: (f64, f64), width: f64) -> f64 {
    let (du, dv) = ((spot.0 - centre.0) / width, (spot.1 - centre.1) / (0.5 * width));
    libm::exp(-0.5 * (du * du + dv * dv))
}

fn sheen(color: Color, light: Color, share: f64) -> Color {
    mix(color, scaled(light, 0.6), share)
}

fn sandy_ground((width, height): (usize, usize), streams: &mut RandomStreams) -> Canvas {
    let noise = Noise::new(streams.of(RandomStreamPurpose::Texture));
    let mut canvas = Canvas::new(width, height, |x, y| {
        let (patch, grain) = (noise.fractal(x / 70.0, y / 70.0, 4), noise.at(x / 1.7, y / 1.7));
        scaled(mix([0.46, 0.37, 0.25], [0.30, 0.24, 0.17], patch), 0.82 + 0.36 * grain)
    });
    scatter(
        &mut canvas,
        60,
        (2.0, 7.0),
        0.85,
        &[[0.42, 0.40, 0.37], [0.30, 0.28, 0.26], [0.55, 0.50, 0.42]],
        streams,
    );
    scatter(&mut canvas, 5, (12.0, 22.0), 0.45, &[[0.40, 0.27, 0.10], [0.34, 0.33, 0.10]], streams);
    strew(
        &mut canvas,
        40,
        (14.0, 40.0),
        1.8,
        &[[0.20, 0.34, 0.09], [0.40, 0.40, 0.16], [0.26, 0.19, 0.11]],
        streams,
    );
    canvas
}
