use std::f64::consts::TAU;

use super::{LeagueScene, SceneModel};
use crate::film::pose::{Pose, in_ellipse};
use crate::film::sine_sum::SineSum;
use crate::film::{Silhouette, SyntheticFilm};
use crate::random::deviate::{uniform, unit};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, mix, scaled};
use crate::scenery::noise::Noise;

/// Time between fast changes of the target's colour, s, their duration, and the change of hue in turns.
const CALM_S: f64 = 2.2;
const CHANGE_S: f64 = 0.45;
const CHANGE: f64 = 0.17;

/// Circles that move about and change their colours at random; the target is in front. [Andrade-Cetto 2005, Sec. 3.4, first sequence]
pub(super) struct Circles {
    wall: Noise,
    /// The first is the target.
    circles: Vec<CircleRoute>,
}

struct CircleRoute {
    home: (f64, f64),
    path: [SineSum; 2],
    range: (f64, f64),
    size: SineSum,
    radius_px: (f64, f64),
    /// In turns round the colour circle, ahead of the target's.
    hue_ahead: f64,
    hue: SineSum,
    saturation: SineSum,
    value: SineSum,
}

impl Circles {
    pub(super) fn new(streams: &mut RandomStreams) -> Self {
        let wall = Noise::new(streams.of(RandomStreamPurpose::Texture));
        let rng = streams.of(RandomStreamPurpose::Motion);
        let mut circle = |home, range, radius_px, hue_ahead| CircleRoute {
            home,
            path: [SineSum::new(6.0, rng), SineSum::new(5.0, rng)],
            range,
            size: SineSum::new(6.0, rng),
            radius_px,
            hue_ahead,
            hue: SineSum::new(9.0, rng),
            saturation: SineSum::new(5.0, rng),
            value: SineSum::new(4.0, rng),
        };
        let mut circles = vec![circle((160.0, 120.0), (110.0, 75.0), (23.0, 32.0), 0.0)];
        for (i, home) in [(70.0, 60.0), (250.0, 70.0), (90.0, 180.0), (240.0, 175.0)].into_iter().enumerate()
        {
            circles.push(circle(home, (70.0, 55.0), (14.0, 30.0), 0.26 + 0.12 * i as f64));
        }
        let rng = streams.of(RandomStreamPurpose::Light);
        let turn = unit(rng);
        circles[0].hue_ahead = turn;
        for other in &mut circles[1..] {
            other.hue_ahead += turn + uniform(-0.03, 0.03, rng);
        }
        Self { wall, circles }
    }

    /// Hue of the target: a slow oscillation, with occasional fast changes.
    fn hue(&self, seconds: f64) -> f64 {
        let (past, within) = ((seconds / CALM_S).floor(), seconds.rem_euclid(CALM_S));
        let changing = ((within - (CALM_S - CHANGE_S)) / CHANGE_S).clamp(0.0, 1.0);
        self.circles[0].hue_ahead + 0.12 * self.circles[0].hue.at(seconds) + CHANGE * (past + changing)
    }
}

impl SceneModel for Circles {
    fn render(&self, seconds: f64, aside: f64) -> LeagueScene {
        let size = SyntheticFilm::SIZE_PX;
        let mut canvas = Canvas::new(size.0, size.1, |x, y| {
            let mottled = self.wall.fractal(x / 40.0, y / 40.0, 3);
            scaled(mix([0.30, 0.31, 0.34], [0.16, 0.19, 0.20], mottled), 1.1 - 0.3 * y / size.1 as f64)
        });
        let target_hue = self.hue(seconds);
        let mut target = Silhouette::empty(size);
        for (i, circle) in self.circles.iter().enumerate().rev() {
            let moved = if i == 0 { aside } else { 0.0 };
            let centre = (
                circle.home.0 + circle.range.0 * circle.path[0].at(seconds) + moved,
                circle.home.1 + circle.range.1 * circle.path[1].at(seconds),
            );
            let radius = circle.size.between(circle.radius_px.0, circle.radius_px.1, seconds);
            let pose = Pose::new(centre, 0.0, (radius, radius));
            let inside = |x: f64, y: f64| in_ellipse(pose.to_body(x, y), (0.0, 0.0), (1.0, 1.0)) * pose.px();
            let own = if i == 0 {
                target_hue
            } else {
                target_hue + circle.hue_ahead - self.circles[0].hue_ahead + 0.05 * circle.hue.at(seconds)
            };
            let color = paint(
                own,
                circle.saturation.between(0.55, 0.95, seconds),
                circle.value.between(0.30, 0.80, seconds),
            );
            let window = pose.window(1.0, size);
            canvas.paint_in(&window, inside, |_, _| color);
            if i == 0 {
                target = Silhouette::of(size, &window, inside);
            }
        }
        LeagueScene { canvas, target, distractor: Silhouette::empty(size) }
    }

    fn light(&self, _seconds: f64) -> Color {
        [1.0; 3]
    }
}

/// A colour from hue in turns, saturation and value.
fn paint(hue: f64, saturation: f64, value: f64) -> Color {
    [0.0, 1.0, 2.0].map(|c| {
        let share = 0.5 + 0.5 * libm::cos(TAU * (hue - c / 3.0));
        value * (1.0 - saturation * (1.0 - share))
    })
}
