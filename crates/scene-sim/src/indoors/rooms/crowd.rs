use nalgebra::Vector2;
use rand::Rng;

use super::super::color::{Rgb8, about, from_hsv};
use super::aisles::{AisleCrossing, AisleGrid};
use crate::random::deviate::{below, chance, uniform};

/// Minimum distance of people from the robot, m.
const CLEARANCE_M: f64 = 0.6;
/// Heights of hips, shoulders and crown, metres.
pub(in crate::indoors) const HEIGHTS_M: [f64; 3] = [0.9, 1.45, 1.75];
/// Half of a person's width, metres.
pub(in crate::indoors) const HALF_WIDTH_M: f64 = 0.25;

/// People who walk along the aisles, and stop.
#[derive(Clone, Debug)]
pub(in crate::indoors) struct Crowd {
    people: Vec<Person>,
}

#[derive(Clone, Debug)]
struct Person {
    /// Colours of legs, body and head.
    clothes: [Rgb8; 3],
    from: AisleCrossing,
    to: AisleCrossing,
    /// Progress along the path, m.
    along_m: f64,
    aside_m: f64,
    speed_mps: f64,
    pause_s: f64,
}

impl Crowd {
    pub(in crate::indoors) fn draw<R: Rng + ?Sized>(n: usize, aisles: &AisleGrid, rng: &mut R) -> Self {
        let crossings = aisles.crossings();
        let person = |_| {
            let from = crossings[below(crossings.len(), rng)];
            let trousers = from_hsv(0.62, uniform(0.0, 0.6, rng), uniform(0.1, 0.5, rng));
            let top = about(uniform(0.0, 1.0, rng), 0.0, rng);
            let hair = from_hsv(0.07, 0.5, uniform(0.1, 0.7, rng));
            let mut person = Person {
                clothes: [trousers, top, hair],
                from,
                to: from,
                along_m: 0.0,
                aside_m: 0.0,
                speed_mps: uniform(0.5, 1.2, rng),
                pause_s: 0.0,
            };
            person.turn(aisles, rng);
            person.along_m = uniform(0.0, 1.0, rng) * aisles.distance(person.from, person.to);
            person
        };
        Self { people: (0..n).map(person).collect() }
    }

    pub(in crate::indoors) fn advance<R: Rng + ?Sized>(
        &mut self,
        seconds: f64,
        aisles: &AisleGrid,
        rng: &mut R,
    ) {
        for person in &mut self.people {
            person.advance(seconds, aisles, rng);
        }
    }

    /// Positions and clothes of all people; those in the robot's path step aside.
    pub(in crate::indoors) fn standing(
        &self,
        aisles: &AisleGrid,
        robot: Vector2<f64>,
    ) -> impl Iterator<Item = (Vector2<f64>, [Rgb8; 3])> {
        self.people.iter().map(move |person| {
            let off = person.place(aisles) - robot;
            let distance = off.norm();
            let place = if distance < CLEARANCE_M && distance > 0.0 {
                robot + off * (CLEARANCE_M / distance)
            } else {
                robot + off
            };
            (place, person.clothes)
        })
    }
}

impl Person {
    fn advance<R: Rng + ?Sized>(&mut self, seconds: f64, aisles: &AisleGrid, rng: &mut R) {
        if self.pause_s > 0.0 {
            self.pause_s -= seconds;
            return;
        }
        self.along_m += self.speed_mps * seconds;
        if chance(0.03 * seconds, rng) {
            self.pause_s = uniform(3.0, 30.0, rng);
        }
        if self.along_m >= aisles.distance(self.from, self.to) {
            self.turn(aisles, rng);
        }
    }

    fn turn<R: Rng + ?Sized>(&mut self, aisles: &AisleGrid, rng: &mut R) {
        let ways = aisles.neighbours(self.to);
        (self.from, self.to) = (self.to, ways[below(ways.len(), rng)]);
        self.along_m = 0.0;
        self.aside_m = uniform(-2.0, 2.0, rng) * aisles.max_lateral_offset_m;
    }

    fn place(&self, aisles: &AisleGrid) -> Vector2<f64> {
        let (from, to) = (aisles.place(self.from), aisles.place(self.to));
        let ahead = (to - from).normalize();
        from + ahead * self.along_m + Vector2::new(-ahead.y, ahead.x) * self.aside_m
    }
}
