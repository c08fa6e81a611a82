use nalgebra::Vector3;

use super::LinearRgb;

/// Background of the field. Implement it for a custom hall.
///
/// **Laws**: reflectances are finite and not negative, normals are unit vectors, and results depend only on the arguments.
pub trait Backdrop {
    /// Intersection of a ray that misses the field; `direction` is not a unit vector.
    fn surface_hit(&self, eye: &Vector3<f64>, direction: &Vector3<f64>) -> SurfaceHit;
}

/// A point of the backdrop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Position, m.
    pub point: Vector3<f64>,
    /// Unit normal, on the side of the eye.
    pub normal: Vector3<f64>,
    /// Its diffuse reflectance.
    pub reflectance: LinearRgb,
}

/// A hall: a dull floor, walls, and people and clutter in front of them.
///
/// ```
/// use wayfix_estimation_traits::nalgebra::Vector3;
/// use wayfix_scene_sim::league::{Backdrop, HallBackdrop};
/// let hall = HallBackdrop::default();
/// let seen = hall.surface_hit(&Vector3::new(0.0, 0.0, 0.2), &Vector3::x());
/// assert_eq!((seen.point.x, seen.normal), (hall.half_length_m, -Vector3::x()));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HallBackdrop {
    /// Half its extent along x, metres. Default 4.
    pub half_length_m: f64,
    /// Half its extent along y, metres. Default 3.2.
    pub half_width_m: f64,
    /// Share of the walls covered by people, in [0, 1]. Default 0.6.
    pub crowd: f64,
    /// Selects the people and the wall. Default 0.
    pub seed: u64,
}

impl Default for HallBackdrop {
    fn default() -> Self {
        Self { half_length_m: 4.0, half_width_m: 3.2, crowd: 0.6, seed: 0 }
    }
}

/// Width of the place that a person takes, metres.
const PLACE_M: f64 = 0.45;

impl Backdrop for HallBackdrop {
    fn surface_hit(&self, eye: &Vector3<f64>, direction: &Vector3<f64>) -> SurfaceHit {
        let reach = |half: f64, from: f64, along: f64| {
            if along == 0.0 { f64::INFINITY } else { ((half.copysign(along) - from) / along).max(0.0) }
        };
        let to_end = reach(self.half_length_m, eye.x, direction.x);
        let to_side = reach(self.half_width_m, eye.y, direction.y);
        let to_floor = if direction.z < 0.0 { -eye.z / direction.z } else { f64::INFINITY };
        let distance = to_end.min(to_side).min(to_floor).min(100.0);
        let mut point = eye + direction * distance;
        if distance == to_floor {
            return SurfaceHit { point, normal: Vector3::z(), reflectance: self.floor(&point) };
        }
        let (normal, along, wall) = if to_end < to_side {
            point.x = self.half_length_m.copysign(direction.x);
            (-Vector3::x().scale(1.0_f64.copysign(direction.x)), point.y, direction.x > 0.0)
        } else {
            point.y = self.half_width_m.copysign(direction.y);
            (-Vector3::y().scale(1.0_f64.copysign(direction.y)), point.x, direction.y > 0.0)
        };
        let number = 2 * u64::from(to_end < to_side) + u64::from(wall);
        SurfaceHit { point, normal, reflectance: self.wall(number, along, point.z) }
    }
}

impl HallBackdrop {
    /// Dull, with tiles that differ a little.
    fn floor(&self, point: &Vector3<f64>) -> LinearRgb {
        let tile = [point.x, point.y].map(|x| (x / 0.3).floor() as i64 as u64);
        let tone = share(self.hash([1, tile[0], tile[1]]), 0);
        LinearRgb::new(0.23, 0.21, 0.19) * (0.9 + 0.2 * tone)
    }

    /// Colour of a wall and the people before it, at the distance `along` from its middle and at the height `z`.
    fn wall(&self, number: u64, along: f64, z: f64) -> LinearRgb {
        let place = (along / PLACE_M).floor();
        let who = self.hash([2 + number, place as i64 as u64, 0]);
        let aside = (along / PLACE_M - place - 0.5).abs();
        let tall = 1.5 + 0.35 * share(who, 0);
        if share(who, 8) < self.crowd
            && let Some(cloth) = person(who, aside, z / tall)
        {
            return cloth;
        }
        let tone = share(self.hash([0, 0, 0]), 0);
        let panel = share(
            self.hash([8 + number, (along / 1.2).floor() as i64 as u64, (z / 0.9).floor() as i64 as u64]),
            0,
        );
        let plaster = LinearRgb::new(0.50, 0.48, 0.44) * (0.6 + 0.5 * tone);
        // Every now and then a poster or a locker.
        if panel < 0.25 {
            vivid(self.hash([9, number, (along / 1.2).floor() as i64 as u64])) * 0.8
        } else {
            plaster
        }
    }

    fn hash(&self, key: [u64; 3]) -> u64 {
        key.into_iter().fold(mix(self.seed), |state, part| mix(state ^ part))
    }
}

/// Colour of a person at the given share of their height, `aside` of the middle of their place; `None` beside them.
fn person(who: u64, aside: f64, height: f64) -> Option<LinearRgb> {
    let (legs, body, head) = (0.26, 0.34, 0.13);
    match height {
        h if h < 0.5 => (aside < legs && aside > 0.03).then(|| trousers(who)),
        h if h < 0.83 => (aside < body).then(|| vivid(mix(who))),
        h if h < 1.0 => (aside < head).then(|| {
            if h < 0.95 { LinearRgb::new(0.50, 0.32, 0.24) } else { LinearRgb::new(0.06, 0.04, 0.03) }
        }),
        _ => None,
    }
}

/// Mostly blue or dark.
fn trousers(who: u64) -> LinearRgb {
    let tone = 0.5 + share(who, 16);
    match who >> 24 & 3 {
        0 => LinearRgb::new(0.04, 0.07, 0.16) * tone,
        1 => LinearRgb::new(0.05, 0.05, 0.05) * tone,
        2 => LinearRgb::new(0.20, 0.17, 0.12) * tone,
        _ => LinearRgb::new(0.07, 0.10, 0.20) * tone,
    }
}

/// Shirts and posters: any hue, some of them near the colours of the map.
fn vivid(what: u64) -> LinearRgb {
    let tone = 0.3 + 0.6 * share(what, 0);
    let tint = LinearRgb::new(share(what, 8), share(what, 16), share(what, 24));
    tint.map(|t| 0.03 + 0.7 * t * t) * tone
}

/// Eight bits as a number in [0, 1].
fn share(hash: u64, shift: u32) -> f64 {
    f64::from((hash >> shift) as u8) / 255.0
}

/// The finalizer of SplitMix64 [Steele et al. 2014].
fn mix(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
