//! Rooms of walls, and a laser in them.

#![allow(dead_code, reason = "not every test and benchmark needs every room")]

use rand::Rng;
use rand_distr::{Distribution, StandardNormal};
use wayfix_line_extract::RangeBearingNoise;
use wayfix_line_extract::nalgebra::Vector2;

/// From, to.
pub(crate) type Wall = (Vector2<f64>, Vector2<f64>);

pub(crate) fn wall(x1: f64, y1: f64, x2: f64, y2: f64) -> Wall {
    (Vector2::new(x1, y1), Vector2::new(x2, y2))
}

/// Four walls around the sensor, which is not in the middle.
pub(crate) fn room() -> Vec<Wall> {
    vec![
        wall(3.0, -2.0, 3.0, 1.5),
        wall(3.0, 1.5, -4.0, 1.5),
        wall(-4.0, 1.5, -4.0, -2.0),
        wall(-4.0, -2.0, 3.0, -2.0),
    ]
}

/// A room with a door to a corridor, a recess, cupboards, and table legs; the sensor stands at the origin.
pub(crate) fn office() -> Vec<Wall> {
    let mut walls = vec![
        wall(-2.5, -3.0, 4.0, -3.0),
        wall(4.0, -3.0, 4.0, -0.5),
        wall(4.0, 0.6, 4.0, 2.5),
        wall(6.0, -5.0, 6.0, 5.0),
        wall(4.0, 2.5, 1.5, 2.5),
        wall(1.5, 2.5, 1.5, 3.5),
        wall(1.5, 3.5, -1.0, 3.5),
        wall(-1.0, 3.5, -1.0, 2.5),
        wall(-1.0, 2.5, -2.5, 2.5),
        wall(-2.5, 2.5, -2.5, -3.0),
    ];
    for (x, y, width, depth) in [(1.0, -3.0, 1.2, 0.5), (3.5, 1.2, 0.5, 0.8), (-2.5, 1.5, 0.4, 1.0)] {
        walls.extend([
            wall(x, y, x, y + depth),
            wall(x, y + depth, x + width, y + depth),
            wall(x + width, y + depth, x + width, y),
            wall(x, y, x + width, y),
        ]);
    }
    for (x, y) in [(1.8, 0.4), (2.6, 0.4), (1.8, -0.8), (2.6, -0.8), (-0.5, -1.6), (0.3, -1.6)] {
        walls.push(wall(x - 0.03, y, x + 0.03, y));
        walls.push(wall(x, y - 0.03, x, y + 0.03));
    }
    walls
}

/// Beams of a laser at the origin that looks forward.
#[derive(Clone, Copy)]
pub(crate) struct Laser {
    pub(crate) n_beams: usize,
    pub(crate) angle_min: f64,
    pub(crate) angle_increment: f64,
}

impl Laser {
    pub(crate) fn over(field_of_view_deg: f64, n_beams: usize) -> Self {
        let angle_increment = field_of_view_deg.to_radians() / (n_beams - 1) as f64;
        Self { n_beams, angle_min: -field_of_view_deg.to_radians() / 2.0, angle_increment }
    }

    /// True ranges; infinite where nothing is.
    pub(crate) fn ranges(&self, walls: &[Wall]) -> Vec<f64> {
        (0..self.n_beams).map(|i| cast(self.bearing(i), walls)).collect()
    }

    /// Ranges along directions that are off by the noise, off by the noise.
    pub(crate) fn noisy_ranges(
        &self,
        walls: &[Wall],
        noise: &RangeBearingNoise,
        rng: &mut impl Rng,
    ) -> Vec<f64> {
        let mut normal = |sigma: f64| -> f64 { sigma * Distribution::<f64>::sample(&StandardNormal, rng) };
        (0..self.n_beams)
            .map(|i| {
                cast(self.bearing(i) + normal(noise.sigma_bearing_rad), walls) + normal(noise.sigma_range_m)
            })
            .collect()
    }

    pub(crate) fn bearing(&self, beam: usize) -> f64 {
        self.angle_min + beam as f64 * self.angle_increment
    }
}

fn cast(bearing: f64, walls: &[Wall]) -> f64 {
    let ray = Vector2::new(bearing.cos(), bearing.sin());
    let hit = |(a, b): &Wall| {
        let along = b - a;
        let facing = ray.perp(&along);
        let (range, share) = (a.perp(&along) / facing, a.perp(&ray) / facing);
        (range > 0.0 && (0.0..=1.0).contains(&share)).then_some(range)
    };
    walls.iter().filter_map(hit).fold(f64::INFINITY, f64::min)
}
