use wayfix_estimation_traits::Pose2;

use crate::{SimulationError, check, plane};

/// Maximum length of a route, m; beyond it, the arc length loses digits that the driver needs.
const LONGEST_M: f64 = 1e7;
/// Maximum gap between the ends of a closed route, m.
const CLOSING_GAP_M: f64 = 1e-6;

/// A stretch of constant curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoutePiece {
    /// Length along the stretch, metres.
    pub length_m: f64,
    /// Curvature, 1/m: 0 straight, positive to the left.
    pub curvature_per_m: f64,
}

/// Straight lines and arcs, end to end, parametrized by arc length.
///
/// ```
/// use std::f64::consts::PI;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_scene_sim::route::{RoutePiece, Route};
/// let half_circle = RoutePiece { length_m: 2.0 * PI, curvature_per_m: 0.5 };
/// let route = Route::open(Pose2::new(0.0, 0.0, 0.0), vec![half_circle])?;
/// assert!((route.at(2.0 * PI).y() - 4.0).abs() < 1e-12); // on the other side of a circle of radius 2 m
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Arc length and pose at the start of each piece.
    starts: Vec<(f64, Pose2<f64>)>,
    pieces: Vec<RoutePiece>,
    length_m: f64,
    closed: bool,
}

impl Route {
    /// A route from `start` that ends where its last piece ends.
    ///
    /// # Errors
    /// Returns an error if there is no piece, a number is not finite, a length is not positive, or the whole is longer than 10 000 km.
    pub fn open(start: Pose2<f64>, pieces: Vec<RoutePiece>) -> Result<Self, SimulationError> {
        check::finite("start of the route", start.x() + start.y() + start.heading())?;
        let mut starts = Vec::with_capacity(pieces.len());
        let (mut length_m, mut pose) = (0.0, start);
        for piece in &pieces {
            check::positive("length of a piece of the route (m)", piece.length_m)?;
            check::finite("curvature of a piece of the route (1/m)", piece.curvature_per_m)?;
            starts.push((length_m, pose));
            length_m += piece.length_m;
            pose = plane::advance(&pose, piece.length_m, piece.length_m * piece.curvature_per_m);
        }
        check::positive("length of the route (m)", length_m)?;
        check::at_most("length of the route (m)", length_m, LONGEST_M, "at most 1e7")?;
        Ok(Self { starts, pieces, length_m, closed: false })
    }

    /// A route that is driven lap after lap.
    ///
    /// # Errors
    /// Returns the errors of [`open`](Self::open), and an error if the end differs from the start by more than a micrometre or a microradian.
    pub fn closed(start: Pose2<f64>, pieces: Vec<RoutePiece>) -> Result<Self, SimulationError> {
        let route = Self::open(start, pieces)?;
        let gap = plane::relative(&start, &route.end());
        let gap_m = gap.translation.norm().max(gap.heading().abs());
        check::at_most("gap between the ends of a closed route (m)", gap_m, CLOSING_GAP_M, "at most 1e-6")?;
        Ok(Self { closed: true, ..route })
    }

    /// The pose at arc length `s` metres: around again on a closed route, straight on beyond the ends of an open one.
    pub fn at(&self, s: f64) -> Pose2<f64> {
        let s = if self.closed { s.rem_euclid(self.length_m) } else { s };
        let idx = self.starts.partition_point(|(start, _)| *start <= s).saturating_sub(1);
        let ((start, pose), piece) = (self.starts[idx], self.pieces[idx]);
        let along = s - start;
        let on_piece = along.clamp(0.0, piece.length_m);
        let pose = plane::advance(&pose, on_piece, on_piece * piece.curvature_per_m);
        if self.closed { pose } else { plane::advance(&pose, along - on_piece, 0.0) }
    }

    /// Length of the route or of one lap, metres.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Whether it is driven lap after lap.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    fn end(&self) -> Pose2<f64> {
        self.at(self.length_m)
    }
}
