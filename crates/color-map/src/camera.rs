use nalgebra::{Vector2, Vector3};

use crate::RenderError;

/// Most pixels a side.
const MAX_SIDE: u32 = 16384;
/// Largest focal length and offset of the optical axis, pixels: above it, sums lose the digits of a pixel.
const MAX_PIXELS: f64 = 1e6;

/// A pinhole camera without distortion.
///
/// A point $`(x, y, z)`$ in the camera frame (x forward, y left, z up) appears at column $`u = c_x - f_x y / x`$ and row
/// $`v = c_y - f_y z / x`$.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_color_map::PinholeCamera;
///
/// let camera = PinholeCamera::from_field_of_view(208, 160, 56.9_f64.to_radians(), 45.2_f64.to_radians())?; // an ERS-7
/// let ahead = camera.project(&Vector3::new(2.0, 0.0, 0.0)).unwrap();
/// assert_eq!((ahead.x, ahead.y), (104.0, 80.0));
/// let again = camera.project(&camera.ray(10.5, 20.5)).unwrap();
/// assert!((again.x - 10.5).abs() < 1e-12 && (again.y - 20.5).abs() < 1e-12);
/// # Ok::<(), wayfix_color_map::RenderError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeCamera {
    width: u32,
    height: u32,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
}

impl PinholeCamera {
    /// A camera of `width` × `height` pixels with focal lengths and the optical axis' place, all in pixels.
    ///
    /// # Errors
    /// [`RenderError::Camera`]: sides outside 1 to 16384, focal lengths outside (0, 1e6], an axis beyond ±1e6, anything NaN.
    pub fn new(width: u32, height: u32, fx: f64, fy: f64, cx: f64, cy: f64) -> Result<Self, RenderError> {
        let error = |what, value, must| Err(RenderError::Camera { what, value, must });
        for (what, side) in [("width, pixels", width), ("height, pixels", height)] {
            if !(1..=MAX_SIDE).contains(&side) {
                return error(what, f64::from(side), "from 1 to 16384");
            }
        }
        for (what, focal) in [("focal length fx, pixels", fx), ("focal length fy, pixels", fy)] {
            if !(focal > 0.0 && focal <= MAX_PIXELS) {
                return error(what, focal, "above 0 and at most 1e6");
            }
        }
        for (what, axis) in [("axis column cx, pixels", cx), ("axis row cy, pixels", cy)] {
            if !(-MAX_PIXELS..=MAX_PIXELS).contains(&axis) {
                return error(what, axis, "within ±1e6");
            }
        }
        Ok(Self { width, height, fx, fy, cx, cy })
    }

    /// A camera with these fields of view between the outer edges of its outer pixels, rad, and its axis in the middle.
    /// # Errors
    /// Returns the errors of [`PinholeCamera::new`]; the angles must lie in (0, π).
    pub fn from_field_of_view(
        width: u32,
        height: u32,
        horizontal_rad: f64,
        vertical_rad: f64,
    ) -> Result<Self, RenderError> {
        for (what, angle) in
            [("horizontal angle, rad", horizontal_rad), ("vertical angle, rad", vertical_rad)]
        {
            if !(angle > 0.0 && angle < std::f64::consts::PI) {
                return Err(RenderError::Camera { what, value: angle, must: "above 0 and below π" });
            }
        }
        let (cx, cy) = (0.5 * f64::from(width), 0.5 * f64::from(height));
        let focal = |half_side: f64, angle: f64| half_side / libm::tan(0.5 * angle);
        Self::new(width, height, focal(cx, horizontal_rad), focal(cy, vertical_rad), cx, cy)
    }

    /// The camera for images averaged over squares of `by` × `by` pixels; incomplete squares at the right and at the bottom are
    /// dropped.
    /// # Errors
    /// [`RenderError::Camera`]: no square fits into the image, or `by` is 0.
    ///
    /// ```
    /// # use nalgebra::Vector3;
    /// # use wayfix_color_map::PinholeCamera;
    /// let camera = PinholeCamera::from_field_of_view(208, 160, 1.0, 0.8)?;
    /// let small = camera.shrunk(2)?;
    /// let (point, half) = (Vector3::new(2.0, 0.3, 0.1), small.project(&Vector3::new(2.0, 0.3, 0.1)).unwrap());
    /// assert!((camera.project(&point).unwrap() / 2.0 - half).norm() < 1e-12);
    /// # Ok::<(), wayfix_color_map::RenderError>(())
    /// ```
    pub fn shrunk(&self, by: u32) -> Result<Self, RenderError> {
        let side = |n: u32| n.checked_div(by).unwrap_or(0);
        let share = 1.0 / f64::from(by.max(1));
        let [fx, fy, cx, cy] = [self.fx, self.fy, self.cx, self.cy].map(|value| value * share);
        Self::new(side(self.width), side(self.height), fx, fy, cx, cy)
    }

    /// Columns of the image.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows of the image.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Focal length along a row, pixels.
    pub fn fx(&self) -> f64 {
        self.fx
    }

    /// Focal length along a column, pixels.
    pub fn fy(&self) -> f64 {
        self.fy
    }

    /// Column of the optical axis.
    pub fn cx(&self) -> f64 {
        self.cx
    }

    /// Row of the optical axis.
    pub fn cy(&self) -> f64 {
        self.cy
    }

    /// Image position of a point of the camera frame, (column, row), inside or outside the image; `None` behind the camera.
    pub fn project(&self, point: &Vector3<f64>) -> Option<Vector2<f64>> {
        (point.x > 0.0).then(|| {
            Vector2::new(self.cx - self.fx * point.y / point.x, self.cy - self.fy * point.z / point.x)
        })
    }

    /// The direction, in the camera frame and with x = 1, that appears at this column and row. A pixel's centre is at +0.5.
    pub fn ray(&self, column: f64, row: f64) -> Vector3<f64> {
        Vector3::new(1.0, (self.cx - column) / self.fx, (self.cy - row) / self.fy)
    }
}
