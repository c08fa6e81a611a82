use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::{LeagueScene, SceneModel};
use crate::film::sine_sum::SineSum;
use crate::film::{Silhouette, SyntheticFilm};
use crate::random::deviate::{chance, uniform, unit};
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::{Canvas, Color, Window, mix, scaled, times};
use crate::scenery::noise::Noise;

/// Focal length of the camera, in pixels.
const FOCAL_PX: f64 = 330.0;
/// Position of the lamp in the camera frame, m: x right, y down, z ahead.
const LAMP: [f64; 3] = [0.0, 0.02, 2.0];
/// Semi-axes of the orbit, m: sideways, vertical, and in depth; points behind the lamp are higher in the image.
const ORBIT_M: [f64; 3] = [0.52, 0.34, 0.36];
/// Half of its width and of its height.
const HALF_M: (f64, f64) = (0.21, 0.15);
const RED: Color = [0.58, 0.17, 0.12];
const LAMPLIGHT: Color = [1.0, 0.86, 0.66];
/// Daylight from the left behind the camera, and ambient light.
const WINDOW_LIGHT: Color = [0.11, 0.13, 0.16];
const WINDOW: [f64; 3] = [-0.7, -0.2, -0.68];
/// Radiance a metre before the lamp.
const LAMP_POWER: f64 = 0.26;
const GLOSS: f64 = 0.10;
const SHARPNESS: i32 = 12;

/// A reddish rectangle, Lambertian but for a little gloss, that revolves round a lamp. [Andrade-Cetto 2005, Fig. 8; Sec. 3.4, second sequence]
pub(super) struct Rectangle {
    wall: Canvas,
    start: f64,
    rate: f64,
    yaw: SineSum,
    pitch: SineSum,
    roll: SineSum,
    radius: SineSum,
    power: SineSum,
    grain: Noise,
}

impl Rectangle {
    pub(super) fn new(streams: &mut RandomStreams) -> Self {
        let grain = Noise::new(streams.of(RandomStreamPurpose::Texture));
        let wall = furnished_wall(&grain, streams);
        let rng = streams.of(RandomStreamPurpose::Motion);
        let sense = if chance(0.5, rng) { 1.0 } else { -1.0 };
        Self {
            wall,
            start: TAU * unit(rng),
            rate: sense * TAU / uniform(5.5, 7.0, rng),
            yaw: SineSum::new(4.0, rng),
            pitch: SineSum::new(5.0, rng),
            roll: SineSum::new(6.0, rng),
            radius: SineSum::new(7.0, rng),
            power: SineSum::new(3.0, streams.of(RandomStreamPurpose::Light)),
            grain,
        }
    }

    fn power(&self, seconds: f64) -> f64 {
        LAMP_POWER * self.power.between(0.75, 1.15, seconds)
    }

    fn plane(&self, seconds: f64, aside: f64) -> Plane {
        let (sin, cos) = libm::sincos(self.start + self.rate * seconds);
        let wide = self.radius.between(0.85, 1.0, seconds);
        let mut centre = Vector3::from(LAMP)
            + Vector3::new(ORBIT_M[0] * cos * wide, -ORBIT_M[1] * sin * wide, ORBIT_M[2] * sin * wide);
        centre.x += aside / FOCAL_PX * centre.z;
        let (yaw, pitch, roll) =
            (0.75 * self.yaw.at(seconds), 0.35 * self.pitch.at(seconds), 0.5 * self.roll.at(seconds));
        Plane::new(centre, yaw, pitch, roll)
    }

    /// The light that a matt white surface sends back.
    fn lit(&self, point: &Vector3<f64>, normal: &Vector3<f64>, power: f64) -> f64 {
        let to_lamp = Vector3::from(LAMP) - point;
        // The bulb's finite size limits its light.
        (power * normal.dot(&to_lamp.normalize()) / (to_lamp.norm_squared() + 0.02)).max(0.0)
    }

    fn radiance(&self, point: &Vector3<f64>, plane: &Plane, (s, t): (f64, f64), power: f64) -> Color {
        let grain = 0.88 + 0.24 * self.grain.fractal(18.0 * s + 7.0, 18.0 * t + 7.0, 2);
        let matt = self.lit(point, &plane.normal, power);
        let half = (Vector3::from(LAMP) - point).normalize() - point.normalize();
        let shine = plane.normal.dot(&half.normalize()).max(0.0).powi(SHARPNESS);
        let gloss = GLOSS * matt.min(1.0) * shine;
        let day = 0.5 + 0.8 * plane.normal.dot(&Vector3::from(WINDOW)).max(0.0);
        [0, 1, 2]
            .map(|c| RED[c] * grain * (LAMPLIGHT[c] * matt + WINDOW_LIGHT[c] * day) + LAMPLIGHT[c] * gloss)
    }
}

impl SceneModel for Rectangle {
    fn render(&self, seconds: f64, aside: f64) -> LeagueScene {
        let size = SyntheticFilm::SIZE_PX;
        let power = self.power(seconds);
        let lamp = project(&Vector3::from(LAMP));
        let mut canvas = Canvas::new(size.0, size.1, |x, y| {
            let wall = Vector3::new((x - 160.0) / FOCAL_PX, (y - 120.0) / FOCAL_PX, 1.0) * 2.7;
            let lit = self.lit(&wall, &-Vector3::z(), power);
            let albedo = self.wall.pixels[y as usize * size.0 + x as usize];
            let light = [0, 1, 2].map(|c| LAMPLIGHT[c] * lit + WINDOW_LIGHT[c]);
            times(albedo, light)
        });
        let bulb = |x: f64, y: f64| 9.0 - libm::hypot(x - lamp.0, y - lamp.1);
        canvas.line(&[(lamp.0, -2.0), lamp], 2.0, |_, _| [0.02; 3]);
        canvas.paint_in(&Window::around(lamp, 11.0, size), bulb, |_, _| scaled(LAMPLIGHT, 3.0 * power));
        let plane = self.plane(seconds, aside);
        let inside = |x: f64, y: f64| plane.hit(x, y).map_or(-9.0, |(_, spot)| plane.inside_px(spot));
        let window = Window::around(
            project(&plane.centre),
            2.0 + FOCAL_PX * libm::hypot(HALF_M.0, HALF_M.1) / (plane.centre.z - 0.3),
            size,
        );
        canvas.paint_in(&window, inside, |x, y| {
            plane.hit(x, y).map_or([0.0; 3], |(point, spot)| self.radiance(&point, &plane, spot, power))
        });
        let target = Silhouette::of(size, &window, inside);
        LeagueScene { canvas, target, distractor: Silhouette::empty(size) }
    }

    fn light(&self, seconds: f64) -> Color {
        scaled(LAMPLIGHT, 2.0 * self.power(seconds))
    }
}

/// Position and normal of the rectangle.
struct Plane {
    centre: Vector3<f64>,
    /// Towards the camera.
    normal: Vector3<f64>,
    along: Vector3<f64>,
    across: Vector3<f64>,
}

impl Plane {
    fn new(centre: Vector3<f64>, yaw: f64, pitch: f64, roll: f64) -> Self {
        let (sin, cos) = libm::sincos(yaw);
        let right = Vector3::new(cos, 0.0, sin);
        let away = Vector3::new(-sin, 0.0, cos);
        let (sin, cos) = libm::sincos(pitch);
        let down = Vector3::y() * cos + away * sin;
        let (sin, cos) = libm::sincos(roll);
        let (along, across) = (right * cos + down * sin, down * cos - right * sin);
        let normal = across.cross(&along).normalize();
        let normal = if normal.dot(&centre) > 0.0 { -normal } else { normal };
        Self { centre, normal, along, across }
    }

    /// Intersection of the ray through an image point with the plane, in space and in plane coordinates.
    fn hit(&self, x: f64, y: f64) -> Option<(Vector3<f64>, (f64, f64))> {
        let ray = Vector3::new((x - 160.0) / FOCAL_PX, (y - 120.0) / FOCAL_PX, 1.0);
        let depth = self.normal.dot(&self.centre) / self.normal.dot(&ray);
        let point = ray * depth;
        let off = point - self.centre;
        (depth > 0.1).then(|| (point, (self.along.dot(&off), self.across.dot(&off))))
    }

    fn inside_px(&self, (s, t): (f64, f64)) -> f64 {
        let px = FOCAL_PX / self.centre.z * self.normal.z.abs();
        (HALF_M.0 - s.abs()).min(HALF_M.1 - t.abs()) * px
    }
}

fn project(point: &Vector3<f64>) -> (f64, f64) {
    (160.0 + FOCAL_PX * point.x / point.z, 120.0 + FOCAL_PX * point.y / point.z)
}

/// A papered wall with a shelf of books and a picture.
fn furnished_wall(noise: &Noise, streams: &mut RandomStreams) -> Canvas {
    let (width, height) = SyntheticFilm::SIZE_PX;
    let mut wall = Canvas::new(width, height, |x, y| {
        let stripe = if (x / 16.0).floor().rem_euclid(2.0) > 0.5 { 0.92 } else { 1.0 };
        scaled([0.42, 0.44, 0.40], stripe * (0.85 + 0.3 * noise.fractal(x / 25.0, y / 25.0, 3)))
    });
    wall.rectangle((18.0, 30.0), (84.0, 82.0), |x, y| {
        let (edge_x, edge_y) = ((x - 18.0).min(84.0 - x), (y - 30.0).min(82.0 - y));
        if edge_x.min(edge_y) < 4.0 {
            [0.20, 0.13, 0.06]
        } else {
            mix([0.12, 0.25, 0.40], [0.20, 0.34, 0.16], (y - 30.0) / 52.0)
        }
    });
    let rng = streams.of(RandomStreamPurpose::Objects);
    let mut left = 200.0;
    while left < 316.0 {
        let (thick, tall) = (uniform(5.0, 12.0, rng), uniform(26.0, 42.0, rng));
        let color = [uniform(0.05, 0.40, rng), uniform(0.10, 0.40, rng), uniform(0.08, 0.45, rng)];
        wall.rectangle((left, 212.0 - tall), (left + thick, 212.0), |_, _| color);
        left += thick + 0.5;
    }
    wall.rectangle((190.0, 212.0), (321.0, 220.0), |x, _| {
        scaled([0.30, 0.20, 0.10], 0.8 + 0.3 * noise.at(x / 6.0, 2.0))
    });
    wall
}
