use rand::Rng;

use crate::random::deviate::unit;

/// Points a side of the lattice, after which the texture repeats.
const SIDE: usize = 64;

/// A smooth random texture: numbers on a lattice, with a curve of no slope at the points in between (value noise).
pub(crate) struct Noise {
    lattice: Vec<f64>,
}

impl Noise {
    pub(crate) fn new<R: Rng + ?Sized>(rng: &mut R) -> Self {
        Self { lattice: (0..SIDE * SIDE).map(|_| unit(rng)).collect() }
    }

    /// A number in [0, 1] with features one unit wide.
    pub(crate) fn at(&self, x: f64, y: f64) -> f64 {
        let (left, top) = (x.floor(), y.floor());
        let (u, v) = (ease(x - left), ease(y - top));
        let index = |i: f64| (i as i64).rem_euclid(SIDE as i64) as usize;
        let corner = |dx: f64, dy: f64| self.lattice[index(top + dy) * SIDE + index(left + dx)];
        let upper = corner(0.0, 0.0) * (1.0 - u) + corner(1.0, 0.0) * u;
        let lower = corner(0.0, 1.0) * (1.0 - u) + corner(1.0, 1.0) * u;
        upper * (1.0 - v) + lower * v
    }

    /// Sums octaves, each half as wide and half as strong; in [0, 1].
    pub(crate) fn fractal(&self, x: f64, y: f64, octaves: u32) -> f64 {
        let (mut sum, mut weight, mut scale) = (0.0, 0.0, 1.0);
        for octave in 0..octaves {
            let apart = 17.3 * f64::from(octave); // else the octaves share their points at the origin
            sum += self.at(x * scale + apart, y * scale - apart) / scale;
            weight += 1.0 / scale;
            scale *= 2.0;
        }
        sum / weight
    }
}

fn ease(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}
