use std::f64::consts::TAU;

use nalgebra::Vector2;
use wayfix_estimation_traits::{LieGroup, Pose2};

use crate::{
    ScanMatchError,
    surface::{SurfacePoint, surfaces},
    tree::Tree,
};

/// A scan prepared for matching: its points and their surface normals.
#[derive(Clone, Debug, Default)]
pub struct ScanPointCloud {
    /// Subsampled points, at most one per degree: enough for matching.
    pub(crate) points: Vec<Vector2<f64>>,
    /// Radians from one of the points to the next.
    pub(crate) spacing: f64,
    pub(crate) surfaces: Tree,
}

/// Minimum spacing of the points of a cloud, rad.
const SPACING: f64 = 0.0174;
/// More beams than any laser has; a longer list is not a scan.
const MOST_BEAMS: usize = 1 << 20;

impl ScanPointCloud {
    /// The cloud of a scan: beam $`i`$ points along `angle_min` $`+ i\,`$`angle_increment`, rad; `ranges` in m. Values outside
    /// (0, `max_range`] are no echoes.
    /// # Errors
    /// Returns an error if the geometry is not finite, the range not positive, or the beams go around more than once.
    pub fn from_ranges(
        angle_min: f64,
        angle_increment: f64,
        ranges: &[f64],
        max_range: f64,
    ) -> Result<Self, ScanMatchError> {
        Self::from_ranges_deskewed(angle_min, angle_increment, ranges, max_range, None)
    }

    /// The same of a laser that moves by `step` from one beam to the next, in its own frame; the cloud is seen from where the first beam was sent.
    ///
    /// # Errors
    /// Returns the errors of [`from_ranges`](Self::from_ranges), and for a step that is not finite.
    pub fn from_ranges_deskewed(
        angle_min: f64,
        angle_increment: f64,
        ranges: &[f64],
        max_range: f64,
        step: Option<&Pose2<f64>>,
    ) -> Result<Self, ScanMatchError> {
        let refuse = |what, value, must| Err(ScanMatchError::Value { what, value, must });
        if !angle_min.is_finite() {
            return refuse("angle_min (rad)", angle_min, "finite");
        }
        if !(max_range > 0.0 && max_range <= 1e6) {
            return refuse("max_range (m)", max_range, "in (0, 1e6]");
        }
        if ranges.len() > MOST_BEAMS {
            return refuse("number of beams", ranges.len() as f64, "at most 2^20");
        }
        let turn = angle_increment.abs() * ranges.len().saturating_sub(1) as f64;
        if !(turn <= TAU * 1.001 && angle_increment != 0.0) {
            return refuse("angle_increment (rad)", angle_increment, "not zero, and within one turn");
        }
        let numbers = step.map(|step| [step.x(), step.y(), step.heading()]).into_iter().flatten();
        if let Some(value) = numbers.into_iter().find(|number| !number.is_finite()) {
            return refuse("motion from beam to beam", value, "finite");
        }
        let mut laser = Pose2::identity();
        let point = |(beam, range): (usize, &f64)| {
            let (sin, cos) = (angle_min + beam as f64 * angle_increment).sin_cos();
            let at = (*range > 0.0 && *range <= max_range).then(|| Vector2::new(cos, sin) * *range);
            let Some(step) = step else { return at };
            let seen_from_the_first = at.map(|at| laser.transform(&at));
            laser = laser.compose(step);
            seen_from_the_first
        };
        let all: Vec<Option<Vector2<f64>>> = ranges.iter().enumerate().map(point).collect();
        let stride = ((SPACING / angle_increment.abs()).round() as usize).max(1);
        Ok(Self {
            points: all.iter().step_by(stride).flatten().copied().collect(),
            spacing: angle_increment.abs() * stride as f64,
            surfaces: Tree::new(surfaces(&all)),
        })
    }

    /// The same scan in the frame of a robot that carries the laser at `mount`.
    pub fn transformed(self, mount: &Pose2<f64>) -> Self {
        let rotation = mount.rotation_matrix();
        let points = self.points.iter().map(|point| mount.transform(point)).collect();
        let carry = |surface: &SurfacePoint| SurfacePoint {
            at: mount.transform(&surface.at),
            normal: rotation * surface.normal,
            ..*surface
        };
        Self { points, surfaces: Tree::new(self.surfaces.iter().map(carry).collect()), ..self }
    }

    /// Its points, at most one per degree, in m.
    pub fn points(&self) -> &[Vector2<f64>] {
        &self.points
    }

    /// Number of its points on straight surfaces.
    pub fn n_surface_points(&self) -> usize {
        self.surfaces.len()
    }
}
