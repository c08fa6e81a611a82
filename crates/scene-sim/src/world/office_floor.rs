use nalgebra::Vector2;
use rand::Rng;

use super::{FloorPlan, Wall};
use crate::random::deviate::{chance, uniform};
use crate::{SimulationError, check, plane};

/// The most rooms on a side of the corridor.
const MOST_ROOMS: usize = 1000;

/// A corridor around a closed block about the origin, as in offices. The outer long sides have rooms with open doors and furniture, the short ones
/// closed doors in niches; pillars and cabinets stand along the block. It has only walls and no landmarks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfficeFloor {
    /// Extent of the corridor's centre line along x, metres.
    pub length_m: f64,
    /// Extent of the centre line along y, metres.
    pub width_m: f64,
    /// Distance between the walls of the corridor, metres.
    pub corridor_m: f64,
    /// Rooms on each of the two long sides, side by side about its middle.
    pub n_rooms: usize,
    /// Extent of a room along the corridor, metres.
    pub room_m: f64,
    /// Extent of a room away from the corridor, metres.
    pub room_depth_m: f64,
    /// Width of the doors, metres.
    pub door_m: f64,
    /// Mean distance of the pillars and cabinets along the block, metres.
    pub spacing_m: f64,
}

impl OfficeFloor {
    /// Places the walls.
    ///
    /// # Errors
    /// Returns an error if a number is not positive, the corridor leaves no block inside, or the rooms and doors do not fit.
    ///
    /// ```
    /// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    /// use wayfix_scene_sim::world::OfficeFloor;
    /// let floor = OfficeFloor { length_m: 28.4, width_m: 17.4, corridor_m: 2.0, n_rooms: 5, room_m: 4.0, room_depth_m: 3.0, door_m: 0.9, spacing_m: 5.0 };
    /// let plan = floor.plan(&mut ChaCha8Rng::seed_from_u64(1))?;
    /// assert!(plan.landmarks.is_empty() && plan.walls.len() > 100);
    /// assert!((floor.area_m2() - (2.0 * 91.6 + 10.0 * 12.0)).abs() < 1e-9); // of the corridor and of the rooms
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    pub fn plan<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<FloorPlan, SimulationError> {
        self.validate()?;
        let mut walls = Vec::new();
        for turn in 0..4 {
            let outer = self.side(turn, self.corridor_m);
            if turn.is_multiple_of(2) {
                self.add_rooms(&outer, rng, &mut walls);
            } else {
                self.add_niches(&outer, &mut walls);
            }
        }
        for turn in 0..4 {
            self.add_block_side(&self.side(turn, -self.corridor_m), rng, &mut walls);
        }
        Ok(FloorPlan { landmarks: Vec::new(), walls })
    }

    /// Floor of the corridor and of the rooms, m².
    pub fn area_m2(&self) -> f64 {
        let corridor = 2.0 * (self.length_m + self.width_m) * self.corridor_m;
        corridor + 2.0 * self.n_rooms as f64 * self.room_m * self.room_depth_m
    }

    fn validate(&self) -> Result<(), SimulationError> {
        check::positive("width of the corridor (m)", self.corridor_m)?;
        check::positive("spacing of the pillars (m)", self.spacing_m)?;
        let must = "finite and above the width of the corridor";
        check::above("length of the floor (m)", self.length_m, self.corridor_m, must)?;
        check::above("width of the floor (m)", self.width_m, self.corridor_m, must)?;
        let n_about = 2.0 * (self.length_m + self.width_m) / self.spacing_m;
        check::count("pillars", n_about as usize, 4 * MOST_ROOMS)?;
        check::count("rooms on a side", self.n_rooms, MOST_ROOMS)?;
        check::positive("width of the doors (m)", self.door_m)?;
        check::above(
            "extent of a room (m)",
            self.room_m,
            self.door_m,
            "finite and above the width of its door",
        )?;
        check::positive("depth of a room (m)", self.room_depth_m)?;
        let rooms = self.n_rooms as f64 * self.room_m;
        check::at_most(
            "extent of all rooms of a side (m)",
            rooms,
            self.length_m,
            "at most the length of the floor",
        )
    }

    /// A side of the rectangle `offset / 2` outside the centre line; the lower one first, counter-clockwise.
    fn side(&self, turn: usize, offset: f64) -> Side {
        let (x, y) = (0.5 * (self.length_m + offset), 0.5 * (self.width_m + offset));
        let (half, away) = if turn.is_multiple_of(2) { (x, y) } else { (y, x) };
        let quarter = |v: Vector2<f64>| Vector2::new(-v.y, v.x);
        let along = (0..turn).fold(Vector2::new(1.0, 0.0), |v, _| quarter(v));
        Side { middle: -quarter(along) * away, along, outward: -quarter(along), half_m: half }
    }

    /// A wall with open doors, and behind it the rooms.
    fn add_rooms<R: Rng + ?Sized>(&self, side: &Side, rng: &mut R, walls: &mut Vec<Wall>) {
        let (depth, first) = (self.room_depth_m, -0.5 * self.n_rooms as f64 * self.room_m);
        let mut wall_from = -side.half_m;
        for k in 0..self.n_rooms {
            let left = first + k as f64 * self.room_m;
            let door = left + uniform(0.1, 0.9, rng) * (self.room_m - self.door_m);
            walls.push(side.wall((wall_from, 0.0), (door, 0.0)));
            wall_from = door + self.door_m;
            walls.push(side.wall((left, 0.0), (left, depth)));
            let leaf = plane::direction(uniform(1.2, 1.9, rng)) * self.door_m;
            walls.push(side.wall((door, 0.0), (door + leaf.x, leaf.y)));
            self.add_furniture(side, left, rng, walls);
        }
        walls.push(side.wall((wall_from, 0.0), (side.half_m, 0.0)));
        if self.n_rooms > 0 {
            walls.push(side.wall((-first, 0.0), (-first, depth)));
            walls.push(side.wall((first, depth), (-first, depth)));
        }
    }

    /// A cupboard at the back wall and a table at a random place in the room that begins at `left`.
    fn add_furniture<R: Rng + ?Sized>(&self, side: &Side, left: f64, rng: &mut R, walls: &mut Vec<Wall>) {
        let (room, depth) = (self.room_m, self.room_depth_m);
        let at = left + uniform(0.1, 0.6, rng) * room;
        let front = depth * uniform(0.8, 0.9, rng);
        let to = at + uniform(0.15, 0.3, rng) * room;
        walls.extend(side.chain(&[(at, depth), (at, front), (to, front), (to, depth)]));
        let centre = Vector2::new(left + uniform(0.25, 0.75, rng) * room, 0.6 * depth);
        let (a, b) = (0.15 * room.min(depth), uniform(0.08, 0.15, rng) * room.min(depth));
        let ahead = plane::direction(uniform(0.0, 1.6, rng));
        let corner = |x: f64, y: f64| {
            let p = centre + ahead * x + Vector2::new(-ahead.y, ahead.x) * y;
            (p.x, p.y)
        };
        walls.extend(side.chain(&[
            corner(-a, -b),
            corner(a, -b),
            corner(a, b),
            corner(-a, b),
            corner(-a, -b),
        ]));
    }

    /// A wall with three closed doors, each a hand's breadth back in its niche.
    fn add_niches(&self, side: &Side, walls: &mut Vec<Wall>) {
        const NICHE_M: f64 = 0.1;
        let half_door = (0.5 * self.door_m).min(0.1 * side.half_m);
        let mut wall_from = -side.half_m;
        for share in [-0.5, 0.0, 0.5] {
            let (from, to) = (share * side.half_m - half_door, share * side.half_m + half_door);
            walls.push(side.wall((wall_from, 0.0), (from, 0.0)));
            walls.extend(side.chain(&[(from, 0.0), (from, NICHE_M), (to, NICHE_M), (to, 0.0)]));
            wall_from = to;
        }
        walls.push(side.wall((wall_from, 0.0), (side.half_m, 0.0)));
    }

    /// A side of the block: a whole wall, and before it pillars of 0.3 × 0.2 m and a few cabinets of 0.9 × 0.4 m.
    fn add_block_side<R: Rng + ?Sized>(&self, side: &Side, rng: &mut R, walls: &mut Vec<Wall>) {
        walls.push(side.wall((-side.half_m, 0.0), (side.half_m, 0.0)));
        let n_stretches = (2.0 * side.half_m / self.spacing_m).round() as usize;
        let stretch = 2.0 * side.half_m / n_stretches.max(1) as f64;
        for k in 0..n_stretches {
            let at = -side.half_m + (k as f64 + uniform(0.35, 0.65, rng)) * stretch;
            let (half, out) = if chance(0.25, rng) { (0.45, 0.4) } else { (0.15, 0.2) };
            let half = f64::min(half, 0.3 * stretch);
            let out = f64::min(out, 0.25 * self.corridor_m);
            walls.extend(side.chain(&[
                (at - half, 0.0),
                (at - half, out),
                (at + half, out),
                (at + half, 0.0),
            ]));
        }
    }
}

/// One side of a rectangle about the origin, with coordinates along it from its middle and away from the origin.
struct Side {
    middle: Vector2<f64>,
    along: Vector2<f64>,
    outward: Vector2<f64>,
    half_m: f64,
}

impl Side {
    fn at(&self, (along, out): (f64, f64)) -> Vector2<f64> {
        self.middle + self.along * along + self.outward * out
    }

    fn wall(&self, from: (f64, f64), to: (f64, f64)) -> Wall {
        Wall { from: self.at(from), to: self.at(to) }
    }

    /// Walls from each point to the next.
    fn chain(&self, points: &[(f64, f64)]) -> Vec<Wall> {
        points.windows(2).map(|pair| self.wall(pair[0], pair[1])).collect()
    }
}
