use std::f64::consts::TAU;

use super::{LeagueScene, SceneModel};
use crate::film::daylight::Daylight;
use crate::film::ground::{Ground, scatter, strew};
use crate::film::pose::{Pose, in_ellipse};
use crate::film::sine_sum::SineSum;
use crate::film::{Silhouette, SyntheticFilm};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, distance, mix, scaled, times};
use crate::scenery::noise::Noise;

const CREAM: Color = [0.50, 0.36, 0.19];
const BROWN: Color = [0.24, 0.135, 0.06];
/// Between the two colours of the shell.
const NECK: Color = [0.35, 0.235, 0.115];
const FOOT: Color = [0.16, 0.145, 0.11];
/// Half the thickness of the neck, its base, and its maximum reach; the shell has radius 1.
const NECK_HALF: f64 = 0.22;
const NECK_ROOT: (f64, f64) = (0.72, 0.50);
const NECK_REACH: f64 = 0.95;
/// The whorls grow by this factor a turn.
const GROWTH: f64 = 2.2;
const UMBILICUS: (f64, f64) = (-0.08, -0.05);

/// A snail in clutter: the target is its shell; a neck of nearly the same colour extends and retracts. [Andrade-Cetto 2005, Fig. 12; Sec. 3.4,
/// fourth sequence]
pub(super) struct Snail {
    ground: Ground,
    daylight: Daylight,
    path: [SineSum; 2],
    tilt: SineSum,
    size: SineSum,
    slim: SineSum,
    neck: SineSum,
    nod: SineSum,
    skin: Noise,
}

impl Snail {
    pub(super) fn new(streams: &mut RandomStreams) -> Self {
        let ground = Ground::new(streams, cluttered_ground);
        let daylight = Daylight::new(streams);
        let skin = Noise::new(streams.of(RandomStreamPurpose::Texture));
        let rng = streams.of(RandomStreamPurpose::Motion);
        let path = [SineSum::new(8.0, rng), SineSum::new(9.0, rng)];
        let (tilt, size, slim) = (SineSum::new(6.0, rng), SineSum::new(8.0, rng), SineSum::new(7.0, rng));
        let (neck, nod) = (SineSum::new(3.5, rng), SineSum::new(3.0, rng));
        Self { ground, daylight, path, tilt, size, slim, neck, nod, skin }
    }

    fn pose(&self, seconds: f64, aside: f64) -> Pose {
        let centre =
            (145.0 + 70.0 * self.path[0].at(seconds) + aside, 125.0 + 45.0 * self.path[1].at(seconds));
        let size = self.size.between(33.0, 42.0, seconds);
        let slim = self.slim.between(0.80, 0.95, seconds);
        Pose::new(centre, 0.3 * self.tilt.at(seconds), (size, size * slim))
    }

    /// Position of the head; the neck may be fully retracted.
    fn tip(&self, seconds: f64) -> (f64, f64) {
        let out = (0.5 + 0.75 * self.neck.at(seconds)).clamp(0.0, 1.0);
        let nod = 0.25 * self.nod.at(seconds);
        (NECK_ROOT.0 - 0.3 + (NECK_REACH + 0.3) * out, NECK_ROOT.1 + (nod - 0.25) * out)
    }

    fn shell_color(&self, (u, v): (f64, f64)) -> Color {
        let (a, b) = (u - UMBILICUS.0, v - UMBILICUS.1);
        let turns = libm::log(libm::hypot(a, b).max(0.02)) / libm::log(GROWTH) - libm::atan2(b, a) / TAU;
        let along = turns - turns.floor();
        let band = if (0.30..0.55).contains(&along) || (0.70..0.80).contains(&along) { 1.0 } else { 0.15 };
        let ribs = 0.88 + 0.24 * self.skin.at(30.0 * libm::atan2(b, a), 6.0 * turns);
        let suture = if along < 0.06 { 0.55 } else { 1.0 };
        let round = 1.12 - 0.35 * (u * u + v * v) - 0.18 * v - 0.10 * u;
        scaled(mix(CREAM, BROWN, band), ribs * suture * round)
    }
}

impl SceneModel for Snail {
    fn render(&self, seconds: f64, aside: f64) -> LeagueScene {
        let size = SyntheticFilm::SIZE_PX;
        let (pose, tip) = (self.pose(seconds, aside), self.tip(seconds));
        let (ground, light) = (self.ground.at(seconds), self.daylight.at(seconds));
        let mut canvas = Canvas::new(size.0, size.1, |x, y| times(ground(x, y), light(x, y)));
        let window = pose.window(2.4, size);
        let foot = |x: f64, y: f64| in_ellipse(pose.to_body(x, y), (0.05, 0.88), (1.15, 0.20)) * pose.px();
        canvas.paint_in(&window, foot, |x, y| times(FOOT, light(x, y)));
        let feelers = |x: f64, y: f64| {
            let spot = pose.to_body(x, y);
            let end = |du: f64, dv: f64| distance(spot, tip, (tip.0 + du, tip.1 + dv));
            (0.035 - end(0.30, -0.38).min(end(0.42, -0.20))) * pose.px()
        };
        canvas.paint_in(&window, feelers, |x, y| times(NECK, light(x, y)));
        let neck = |x: f64, y: f64| (NECK_HALF - distance(pose.to_body(x, y), NECK_ROOT, tip)) * pose.px();
        canvas.paint_in(&window, neck, |x, y| {
            let (u, v) = pose.to_body(x, y);
            let warts = 0.85 + 0.3 * self.skin.at(14.0 * u + 9.0, 14.0 * v + 9.0);
            times(scaled(NECK, warts * (1.05 - 0.5 * (v - NECK_ROOT.1))), light(x, y))
        });
        let shell = |x: f64, y: f64| in_ellipse(pose.to_body(x, y), (0.0, 0.0), (1.0, 1.0)) * pose.px();
        canvas.paint_in(&window, shell, |x, y| times(self.shell_color(pose.to_body(x, y)), light(x, y)));
        let target = Silhouette::of(size, &window, shell);
        let distractor = Silhouette::of(size, &window, neck).without(&target);
        LeagueScene { canvas, target, distractor }
    }

    fn light(&self, seconds: f64) -> Color {
        self.daylight.at(seconds)(160.0, 120.0)
    }
}

fn cluttered_ground((width, height): (usize, usize), streams: &mut RandomStreams) -> Canvas {
    let noise = Noise::new(streams.of(RandomStreamPurpose::Texture));
    let mut canvas = Canvas::new(width, height, |x, y| {
        let (patch, grain) = (noise.fractal(x / 45.0, y / 45.0, 4), noise.at(x / 2.2, y / 2.2));
        scaled(mix([0.10, 0.15, 0.05], [0.19, 0.16, 0.10], patch), 0.75 + 0.5 * grain)
    });
    scatter(
        &mut canvas,
        45,
        (9.0, 26.0),
        0.42,
        &[[0.10, 0.24, 0.05], [0.17, 0.30, 0.07], [0.30, 0.31, 0.08], [0.06, 0.15, 0.05]],
        streams,
    );
    scatter(&mut canvas, 14, (3.0, 10.0), 0.8, &[[0.34, 0.33, 0.31], [0.22, 0.21, 0.20]], streams);
    scatter(&mut canvas, 6, (9.0, 18.0), 0.5, &[[0.33, 0.20, 0.08], [0.24, 0.14, 0.06]], streams);
    strew(
        &mut canvas,
        45,
        (25.0, 80.0),
        2.2,
        &[[0.16, 0.30, 0.06], [0.24, 0.36, 0.10], [0.20, 0.14, 0.08]],
        streams,
    );
    canvas
}
