use std::collections::BTreeMap;

use nalgebra::Vector2;
use rand::Rng;
use wayfix_estimation_traits::Pose2;

use super::super::rounded::rounded;
use crate::random::deviate::{below, uniform};
use crate::route::Route;
use crate::{SimulationError, check};

/// Longest tour, metres: a day's drive and more.
const LONGEST_M: f64 = 100_000.0;

/// A grid of aisles: where people walk and robots drive.
#[derive(Clone, Debug, PartialEq)]
pub struct AisleGrid {
    /// x of the aisles along y, increasing, m.
    pub(in crate::indoors) xs: Vec<f64>,
    /// y of the aisles along x, increasing, m.
    pub(in crate::indoors) ys: Vec<f64>,
    /// Maximum distance of a robot from the middle of an aisle, m.
    pub(in crate::indoors) max_lateral_offset_m: f64,
    /// Radius of its turns, metres.
    pub(in crate::indoors) turn_m: f64,
}

/// A crossing: number of the aisle along y, then along x.
pub type AisleCrossing = [usize; 2];

impl AisleGrid {
    /// All crossings.
    pub fn crossings(&self) -> Vec<AisleCrossing> {
        let (n, m) = (self.xs.len(), self.ys.len());
        (0..n * m).map(|i| [i % n, i / n]).collect()
    }

    /// Position of a crossing, m.
    pub fn place(&self, [i, j]: AisleCrossing) -> Vector2<f64> {
        Vector2::new(self.xs[i], self.ys[j])
    }

    /// A random tour from the crossing in the corner of low x and y, where the robot is charged: first along x, at every crossing on into the
    /// aisle that was driven least, never straight back; left or right of the middle by chance. It ends at the first crossing after `length_m`.
    ///
    /// # Errors
    /// Returns an error if the length is no length.
    pub fn tour<R: Rng + ?Sized>(&self, length_m: f64, rng: &mut R) -> Result<Route, SimulationError> {
        self.tour_from([0, 0], length_m, rng)
    }

    /// The same from another crossing.
    ///
    /// # Errors
    /// Returns an error if the length is no length, or there is no such crossing.
    pub fn tour_from<R: Rng + ?Sized>(
        &self,
        start: AisleCrossing,
        length_m: f64,
        rng: &mut R,
    ) -> Result<Route, SimulationError> {
        check::positive("length of the tour (m)", length_m)?;
        check::at_most("length of the tour (m)", length_m, LONGEST_M, "at most 1e5")?;
        check::count("crossing along x", start[0], self.xs.len() - 1)?;
        check::count("crossing along y", start[1], self.ys.len() - 1)?;
        let first = if start[0] + 1 < self.xs.len() { start[0] + 1 } else { start[0] - 1 };
        let mut walk = vec![start, [first, start[1]]];
        let mut driven = BTreeMap::from([(edge(walk[0], walk[1]), 1)]);
        let mut sum_m = self.distance(walk[0], walk[1]);
        while sum_m < length_m {
            let (last, here) = (walk[walk.len() - 2], walk[walk.len() - 1]);
            let times = |to: &AisleCrossing| driven.get(&edge(here, *to)).copied().unwrap_or(0);
            let ahead: Vec<AisleCrossing> =
                self.neighbours(here).into_iter().filter(|to| *to != last).collect();
            let least = ahead.iter().map(times).min().unwrap_or(0);
            let fresh: Vec<AisleCrossing> = ahead.into_iter().filter(|to| times(to) == least).collect();
            let next = fresh[below(fresh.len(), rng)];
            *driven.entry(edge(here, next)).or_insert(0) += 1;
            sum_m += self.distance(here, next);
            walk.push(next);
        }
        self.route(&walk, rng)
    }

    /// Laps around everything, counter-clockwise from the same corner; left or right of the middle by chance.
    ///
    /// # Errors
    /// Returns an error if there are no laps, or more than the longest tour.
    pub fn laps<R: Rng + ?Sized>(&self, n_laps: usize, rng: &mut R) -> Result<Route, SimulationError> {
        check::positive("laps", n_laps as f64)?;
        check::count("laps", n_laps, 1000)?;
        let (right, top) = (self.xs.len() - 1, self.ys.len() - 1);
        let corners = [[0, 0], [right, 0], [right, top], [0, top]];
        let mut walk: Vec<AisleCrossing> = corners.into_iter().cycle().take(4 * n_laps).collect();
        walk.push([0, 0]);
        self.route(&walk, rng)
    }

    /// Start of a tour: the middle of the corner's crossing, along x.
    pub fn station(&self) -> Pose2<f64> {
        Pose2::new(self.xs[0], self.ys[0], 0.0)
    }

    /// The crossings next to one.
    pub(in crate::indoors) fn neighbours(&self, [i, j]: AisleCrossing) -> Vec<AisleCrossing> {
        let along =
            |k: usize, n: usize| [k.checked_sub(1), (k + 1 < n).then_some(k + 1)].into_iter().flatten();
        let x = along(i, self.xs.len()).map(|i| [i, j]);
        x.chain(along(j, self.ys.len()).map(|j| [i, j])).collect()
    }

    pub(in crate::indoors) fn distance(&self, a: AisleCrossing, b: AisleCrossing) -> f64 {
        (self.place(a) - self.place(b)).norm()
    }

    /// A route through the crossings, with each straight stretch offset randomly from the middle; the first stretch starts in the middle.
    fn route<R: Rng + ?Sized>(&self, walk: &[AisleCrossing], rng: &mut R) -> Result<Route, SimulationError> {
        let mut points = vec![self.place(walk[0])];
        let mut aside = 0.0;
        for three in walk.windows(3) {
            let along_x = three[0][1] == three[1][1];
            if along_x == (three[1][1] == three[2][1]) {
                continue;
            }
            let next = uniform(-self.max_lateral_offset_m, self.max_lateral_offset_m, rng);
            let offset = if along_x { Vector2::new(next, aside) } else { Vector2::new(aside, next) };
            points.push(self.place(three[1]) + offset);
            aside = next;
        }
        let end = walk[walk.len() - 1];
        let before = walk[walk.len() - 2];
        let offset = if before[1] == end[1] { Vector2::new(0.0, aside) } else { Vector2::new(aside, 0.0) };
        points.push(self.place(end) + offset);
        rounded(&points, self.turn_m)
    }
}

fn edge(a: AisleCrossing, b: AisleCrossing) -> [AisleCrossing; 2] {
    if a < b { [a, b] } else { [b, a] }
}
