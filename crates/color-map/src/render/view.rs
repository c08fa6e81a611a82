use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Pose3;

use crate::PinholeCamera;

/// A camera at a pose, as the linear map from the world to homogeneous pixels.
///
/// [Olano & Greer 1997]: a point becomes $`h = (u w, v w, w)`$ with w its depth; the line through two points is $`h_a × h_b`$, and the side on which
/// a pixel's ray passes it is the sign of $`(h_a × h_b)^T (u, v, 1)`$, also for points behind the camera. No clipping is needed.
#[derive(Clone, Debug)]
pub(super) struct View {
    pub(super) eye: Vector3<f64>,
    matrix: Matrix3<f64>,
    n_columns: f64,
    /// Unit normals of the planes through the eye and the image's sides and of that across the axis, inward.
    frustum: [Vector3<f64>; 5],
}

/// A point in camera view.
#[derive(Clone, Copy, Debug)]
pub(super) struct ImagePoint {
    /// Homogeneous pixel.
    pub(super) pixel: Vector3<f64>,
    /// Row; of no meaning behind the camera.
    pub(super) row: f64,
}

impl View {
    pub(super) fn new(camera: &PinholeCamera, pose: &Pose3<f64>) -> Self {
        let to_camera = pose.rotation.to_rotation_matrix().into_inner().transpose();
        let to_pixels =
            Matrix3::new(camera.cx(), -camera.fx(), 0.0, camera.cy(), 0.0, -camera.fy(), 1.0, 0.0, 0.0);
        let matrix = to_pixels * to_camera;
        let (width, height) = (f64::from(camera.width()), f64::from(camera.height()));
        let [u, v, w] = [0, 1, 2].map(|i| matrix.row(i).transpose());
        let frustum = [u, w * width - u, v, w * height - v, w].map(|normal| normal.normalize());
        Self { eye: pose.translation, matrix, n_columns: width, frustum }
    }

    pub(super) fn point(&self, world: &Vector3<f64>) -> ImagePoint {
        let pixel = self.matrix * (world - self.eye);
        ImagePoint { pixel, row: pixel.y / pixel.z }
    }

    /// Whether all points lie on the outer side of the image's left border, or of its right one.
    pub(super) fn is_beside(&self, points: &[ImagePoint]) -> bool {
        points.iter().all(|p| p.pixel.x < 0.0)
            || points.iter().all(|p| p.pixel.x > p.pixel.z * self.n_columns)
    }

    /// Whether a ball is wholly outside the image.
    pub(super) fn misses(&self, center: &Vector3<f64>, radius: f64) -> bool {
        let from_eye = center - self.eye;
        self.frustum.iter().any(|normal| normal.dot(&from_eye) < -radius)
    }
}

impl ImagePoint {
    fn is_behind(&self) -> bool {
        self.pixel.z <= 0.0
    }

    /// Rows that the visible part of the edge between two points reaches; none if all of it is behind the camera.
    pub(super) fn rows_to(&self, other: &Self) -> Option<(f64, f64)> {
        match (self.is_behind(), other.is_behind()) {
            (false, false) => Some((self.row.min(other.row), self.row.max(other.row))),
            (false, true) => Some(self.rows_to_horizon(other)),
            (true, false) => Some(other.rows_to_horizon(self)),
            (true, true) => None,
        }
    }

    /// If the edge passes beside the camera its image extends to infinity, up or down by the sign of `v w`.
    fn rows_to_horizon(&self, behind: &Self) -> (f64, f64) {
        let (front_w, front_v) = (self.pixel.z, self.pixel.y);
        let (behind_w, behind_v) = (behind.pixel.z, behind.pixel.y);
        let v = front_v * -behind_w + behind_v * front_w;
        // Too close to call: both ways, which costs rows and is never wrong.
        let rounding = 1e-12 * (front_v * behind_w).abs().max((behind_v * front_w).abs());
        let top = if v <= rounding { f64::NEG_INFINITY } else { self.row };
        let bottom = if v >= -rounding { f64::INFINITY } else { self.row };
        (top, bottom)
    }
}
