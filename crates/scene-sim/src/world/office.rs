use nalgebra::Vector2;
use rand::Rng;

use super::{FloorPlan, Wall, layout::MOST_LANDMARKS};
use crate::random::deviate::uniform;
use crate::{SimulationError, check};

/// Square rooms in rows and columns about the origin. A post stands near each corner (the landmarks), a door opens in the middle
/// of each inner wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Office {
    /// Rooms along x.
    pub n_columns: usize,
    /// Rooms along y.
    pub n_rows: usize,
    /// Side of a room, metres.
    pub room_m: f64,
    /// Width of the doors, metres.
    pub door_m: f64,
    /// Maximum offset of each post from its corner along x and y, m.
    pub jitter_m: f64,
}

impl Office {
    /// Places posts and walls.
    ///
    /// # Errors
    /// Returns an error if there is no room, there are too many, or a length is out of range.
    pub fn plan<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<FloorPlan, SimulationError> {
        check::positive("number of rooms", self.n_columns as f64 * self.n_rows as f64)?;
        let n_posts = (self.n_columns.saturating_add(1)).saturating_mul(self.n_rows.saturating_add(1));
        check::count("landmarks", n_posts, MOST_LANDMARKS)?;
        check::positive("width of the doors (m)", self.door_m)?;
        check::above(
            "side of a room (m)",
            self.room_m,
            self.door_m,
            "finite and above the width of its doors",
        )?;
        check::not_negative("jitter of the posts (m)", self.jitter_m)?;
        let posts = (0..=self.n_rows)
            .flat_map(|row| (0..=self.n_columns).map(move |column| (column, row)))
            .map(|(column, row)| {
                let mut jitter = || uniform(-self.jitter_m, self.jitter_m, rng);
                self.corner(column, row) + Vector2::new(jitter(), jitter())
            })
            .collect();
        Ok(FloorPlan::numbered(posts, self.walls()))
    }

    fn corner(&self, column: usize, row: usize) -> Vector2<f64> {
        let middle = Vector2::new(self.n_columns as f64, self.n_rows as f64) * 0.5;
        (Vector2::new(column as f64, row as f64) - middle) * self.room_m
    }

    fn walls(&self) -> Vec<Wall> {
        let mut walls = Vec::new();
        for row in 0..=self.n_rows {
            let outer = row == 0 || row == self.n_rows;
            for column in 0..self.n_columns {
                self.add_side(self.corner(column, row), self.corner(column + 1, row), outer, &mut walls);
            }
        }
        for column in 0..=self.n_columns {
            let outer = column == 0 || column == self.n_columns;
            for row in 0..self.n_rows {
                self.add_side(self.corner(column, row), self.corner(column, row + 1), outer, &mut walls);
            }
        }
        walls
    }

    /// One side of a room: whole, or with a door in its middle.
    fn add_side(&self, from: Vector2<f64>, to: Vector2<f64>, outer: bool, walls: &mut Vec<Wall>) {
        if outer {
            walls.push(Wall { from, to });
        } else {
            let until_door = (to - from) * (0.5 * (1.0 - self.door_m / self.room_m));
            walls.push(Wall { from, to: from + until_door });
            walls.push(Wall { from: to - until_door, to });
        }
    }
}
