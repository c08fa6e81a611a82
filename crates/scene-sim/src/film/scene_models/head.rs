use super::{LeagueScene, SceneModel};
use crate::film::ground::Ground;
use crate::film::pose::{Pose, in_ellipse};
use crate::film::sine_sum::SineSum;
use crate::film::{Silhouette, SyntheticFilm};
use crate::random::deviate::uniform;
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, distance, mix, scaled, times};
use crate::scenery::noise::Noise;

const SKIN: Color = [0.48, 0.27, 0.18];
const HAIR: Color = [0.085, 0.050, 0.030];
const LIPS: Color = [0.36, 0.12, 0.10];
const SHIRT: Color = [0.10, 0.16, 0.28];
const WOOD: Color = [0.40, 0.23, 0.11];
const WALL: Color = [0.50, 0.47, 0.38];
const BULB: Color = [1.0, 0.80, 0.56];
const DAY: Color = [0.80, 0.94, 1.05];

/// A head that turns about while its owner walks through a room and the light changes from a lamp to daylight and back; the target is skin
/// and hair, without neck and shirt. [Andrade-Cetto 2005, Sec. 3.2, Fig. 9]
pub(super) struct Head {
    room: Ground,
    path: [SineSum; 2],
    tilt: SineSum,
    size: SineSum,
    yaw: SineSum,
    brightness: SineSum,
    daylight: SineSum,
    from: SineSum,
    strands: Noise,
}

impl Head {
    pub(super) fn new(streams: &mut RandomStreams) -> Self {
        let room = Ground::new(streams, furnished_room);
        let strands = Noise::new(streams.of(RandomStreamPurpose::Texture));
        let rng = streams.of(RandomStreamPurpose::Motion);
        let path = [SineSum::new(6.0, rng), SineSum::new(5.0, rng)];
        let (tilt, size, yaw) = (SineSum::new(4.0, rng), SineSum::new(7.0, rng), SineSum::new(7.0, rng));
        let rng = streams.of(RandomStreamPurpose::Light);
        let (brightness, daylight, from) =
            (SineSum::new(6.0, rng), SineSum::new(8.0, rng), SineSum::new(7.0, rng));
        Self { room, path, tilt, size, yaw, brightness, daylight, from, strands }
    }

    fn pose(&self, seconds: f64, aside: f64) -> Pose {
        let centre =
            (160.0 + 85.0 * self.path[0].at(seconds) + aside, 92.0 + 22.0 * self.path[1].at(seconds));
        let size = self.size.between(32.0, 44.0, seconds);
        Pose::new(centre, 0.25 * self.tilt.at(seconds), (0.76 * size, size))
    }

    /// Appearance at a point of the unit disc of a ball turned by `yaw`: face, hair, and its shading.
    fn shade(&self, (u, v): (f64, f64), yaw: f64, from: f64) -> Color {
        let ahead = (1.0 - u * u - v * v).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(yaw);
        let (side, front) = (u * cos - ahead * sin, ahead * cos + u * sin);
        let hair = front < 0.12 + 0.25 * (-v).max(0.0) || v < -0.52 + 0.10 * side * side;
        let color = if hair {
            scaled(HAIR, 0.7 + 0.8 * self.strands.fractal(9.0 * side, 2.0 * v + 5.0, 2))
        } else {
            self.face((side, v))
        };
        scaled(color, 0.72 + 0.28 * ahead + 0.22 * from * u)
    }

    fn face(&self, (side, v): (f64, f64)) -> Color {
        let spot = (side.abs(), v);
        if in_ellipse(spot, (0.33, -0.12), (0.13, 0.06)) > 0.0 {
            return if in_ellipse(spot, (0.33, -0.12), (0.055, 0.055)) > 0.0 { [0.03; 3] } else { [0.6; 3] };
        }
        if in_ellipse(spot, (0.34, -0.28), (0.17, 0.035)) > 0.0 {
            return HAIR;
        }
        if in_ellipse(spot, (0.0, 0.55), (0.24, 0.055)) > 0.0 {
            return LIPS;
        }
        let nose = if in_ellipse(spot, (0.06, 0.18), (0.05, 0.25)) > 0.0 { 0.86 } else { 1.0 };
        scaled(SKIN, nose * (0.92 + 0.16 * self.strands.fractal(4.0 * side, 4.0 * v, 2)))
    }

    fn lamp(&self, seconds: f64) -> Color {
        let strength = self.brightness.between(0.35, 1.15, seconds);
        scaled(mix(BULB, DAY, self.daylight.between(0.0, 1.0, seconds)), strength)
    }
}

impl SceneModel for Head {
    fn render(&self, seconds: f64, aside: f64) -> LeagueScene {
        let size = SyntheticFilm::SIZE_PX;
        let (pose, lamp, from) = (self.pose(seconds, aside), self.lamp(seconds), self.from.at(seconds));
        let yaw = 2.6 * self.yaw.at(seconds);
        let light = |x: f64| scaled(lamp, 1.0 + 0.35 * from * (x / 160.0 - 1.0));
        let room = self.room.at(seconds);
        let mut canvas = Canvas::new(size.0, size.1, |x, y| times(room(x, y), light(x)));
        let (centre, unit) = (pose.centre, pose.unit_px.1);
        let below = |units: f64| centre.1 + units * unit;
        let whole = pose.window(9.0, size);
        let neck = |x: f64, y: f64| 0.34 * unit - distance((x, y), centre, (centre.0, below(1.5)));
        canvas.paint_in(&whole, neck, |x, _| times(scaled(SKIN, 0.7), light(x)));
        let torso = |x: f64, y: f64| in_ellipse((x, y), (centre.0, below(3.1)), (1.45 * unit, 1.85 * unit));
        canvas.paint_in(&whole, torso, |x, y| {
            let fold = 0.8 + 0.4 * self.strands.fractal((x - centre.0) / 14.0, (y - centre.1) / 30.0, 2);
            times(scaled(SHIRT, fold), light(x))
        });
        let head = |x: f64, y: f64| in_ellipse(pose.to_body(x, y), (0.0, 0.0), (1.0, 1.0)) * pose.px();
        let window = pose.window(1.0, size);
        canvas.paint_in(&window, head, |x, y| times(self.shade(pose.to_body(x, y), yaw, from), light(x)));
        let target = Silhouette::of(size, &window, head);
        LeagueScene { canvas, target, distractor: Silhouette::empty(size) }
    }

    fn light(&self, seconds: f64) -> Color {
        self.lamp(seconds)
    }
}

/// A plastered wall with a door and a cupboard of wood, a window and a plant.
fn furnished_room((width, height): (usize, usize), streams: &mut RandomStreams) -> Canvas {
    let noise = Noise::new(streams.of(RandomStreamPurpose::Texture));
    let h = height as f64;
    let mut canvas =
        Canvas::new(width, height, |x, y| scaled(WALL, 0.85 + 0.25 * noise.fractal(x / 50.0, y / 50.0, 3)));
    let wood = |x: f64, y: f64| scaled(WOOD, 0.75 + 0.5 * noise.fractal(x / 3.0, y / 45.0, 2));
    let rng = streams.of(RandomStreamPurpose::Objects);
    let door = uniform(15.0, 60.0, rng);
    canvas.rectangle((door, 38.0), (door + 62.0, h + 1.0), wood);
    for top in [50.0, 145.0] {
        canvas.rectangle((door + 10.0, top), (door + 52.0, top + 78.0), |x, y| scaled(wood(x, y), 0.8));
    }
    let shelf = uniform(215.0, 250.0, rng);
    canvas.rectangle((shelf, 70.0), (shelf + 80.0, h + 1.0), wood);
    let mut left = shelf + 4.0;
    while left < shelf + 70.0 {
        let (thick, tall) = (uniform(4.0, 9.0, rng), uniform(24.0, 38.0, rng));
        let color = [uniform(0.08, 0.5, rng), uniform(0.06, 0.35, rng), uniform(0.05, 0.35, rng)];
        for bottom in [120.0, 168.0] {
            canvas.rectangle((left, bottom - tall), (left + thick, bottom), |_, _| color);
        }
        left += thick;
    }
    let window = uniform(125.0, 145.0, rng);
    canvas.rectangle((window, 15.0), (window + 62.0, 85.0), |x, y| {
        let bar = (x - window - 31.0).abs() < 2.0 || (y - 50.0).abs() < 2.0;
        if bar {
            [0.6; 3]
        } else {
            mix([0.55, 0.66, 0.78], [0.34, 0.46, 0.30], ((y - 40.0) / 40.0).clamp(0.0, 1.0))
        }
    });
    canvas
}
