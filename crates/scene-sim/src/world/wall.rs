use nalgebra::Vector2;

/// A straight wall; what stands behind it is hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// One end, metres.
    pub from: Vector2<f64>,
    /// The other end, metres.
    pub to: Vector2<f64>,
}

/// Share of the line of sight, at the seen end, that walls do not cut: landmarks hang on walls.
const SURFACE: f64 = 1e-6;

impl Wall {
    /// Whether the wall cuts the line of sight from `eye` to `point`; a point on the wall itself is seen.
    ///
    /// ```
    /// use wayfix_estimation_traits::nalgebra::Vector2;
    /// use wayfix_scene_sim::world::Wall;
    /// let wall = Wall { from: Vector2::new(1.0, -1.0), to: Vector2::new(1.0, 1.0) };
    /// let eye = Vector2::new(0.0, 0.0);
    /// assert!(wall.hides(&eye, &Vector2::new(2.0, 0.5)));
    /// assert!(!wall.hides(&eye, &Vector2::new(1.0, 0.5)) && !wall.hides(&eye, &Vector2::new(2.0, 3.0)));
    /// ```
    pub fn hides(&self, eye: &Vector2<f64>, point: &Vector2<f64>) -> bool {
        let (sight, wall, offset) = (point - eye, self.to - self.from, self.from - eye);
        let determinant = sight.perp(&wall);
        if determinant == 0.0 {
            return false;
        }
        let along_sight = offset.perp(&wall) / determinant;
        let along_wall = offset.perp(&sight) / determinant;
        (0.0..1.0 - SURFACE).contains(&along_sight) && (0.0..=1.0).contains(&along_wall)
    }

    /// The four sides of a rectangle about the origin.
    pub(super) fn rectangle(length: f64, width: f64) -> [Self; 4] {
        let (x, y) = (0.5 * length, 0.5 * width);
        let corners = [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| Vector2::new(x, y));
        [0, 1, 2, 3].map(|k| Self { from: corners[k], to: corners[(k + 1) % 4] })
    }
}
