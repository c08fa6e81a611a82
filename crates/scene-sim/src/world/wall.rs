use nalgebra::Vector2;

/// A straight wall; it hides everything behind it.
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
    /// assert!(wall.occludes(&eye, &Vector2::new(2.0, 0.5)));
    /// assert!(!wall.occludes(&eye, &Vector2::new(1.0, 0.5)) && !wall.occludes(&eye, &Vector2::new(2.0, 3.0)));
    /// ```
    pub fn occludes(&self, eye: &Vector2<f64>, point: &Vector2<f64>) -> bool {
        self.crossing(eye, &(point - eye)).is_some_and(|along| (0.0..1.0 - SURFACE).contains(&along))
    }

    /// Distance from `eye` along the unit vector `direction` to the wall, m; `None` if the ray misses it.
    /// ```
    /// use wayfix_estimation_traits::nalgebra::Vector2;
    /// use wayfix_scene_sim::world::Wall;
    /// let wall = Wall { from: Vector2::new(2.0, -1.0), to: Vector2::new(2.0, 1.0) };
    /// let eye = Vector2::new(0.0, 0.0);
    /// assert_eq!(wall.distance(&eye, &Vector2::new(1.0, 0.0)), Some(2.0));
    /// assert_eq!(wall.distance(&eye, &Vector2::new(-1.0, 0.0)), None);
    /// ```
    pub fn distance(&self, eye: &Vector2<f64>, direction: &Vector2<f64>) -> Option<f64> {
        self.crossing(eye, direction).filter(|along| *along >= 0.0)
    }

    /// Intersection of the line through `eye` along `sight` with the wall, in lengths of `sight`.
    fn crossing(&self, eye: &Vector2<f64>, sight: &Vector2<f64>) -> Option<f64> {
        let (wall, offset) = (self.to - self.from, self.from - eye);
        let determinant = sight.perp(&wall);
        let along_wall = offset.perp(sight) / determinant;
        let crosses = determinant != 0.0 && (0.0..=1.0).contains(&along_wall);
        crosses.then(|| offset.perp(&wall) / determinant)
    }

    /// The four sides of a rectangle about the origin.
    pub(super) fn rectangle(length: f64, width: f64) -> [Self; 4] {
        let (x, y) = (0.5 * length, 0.5 * width);
        let corners = [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| Vector2::new(x, y));
        [0, 1, 2, 3].map(|k| Self { from: corners[k], to: corners[(k + 1) % 4] })
    }
}
