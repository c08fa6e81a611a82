use crate::TrackingError;

/// An upright rectangle in a picture, in pixels: the top left corner, width and height. The pixel in column `u` and row `v` covers
/// $`[u, u+1) × [v, v+1)`$.
///
/// ```
/// use wayfix_visual_tracking::BoundingBox;
/// let left = BoundingBox::from_corner(0.0, 0.0, 20.0, 10.0)?;
/// let right = BoundingBox::from_corner(10.0, 0.0, 20.0, 10.0)?;
/// assert_eq!(left.center(), [10.0, 5.0]);
/// assert!((left.iou(&right) - 1.0 / 3.0).abs() < 1e-12);
/// assert!(BoundingBox::from_corner(0.0, 0.0, 0.0, 10.0).is_err());
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl BoundingBox {
    /// From the top left corner.
    ///
    /// # Errors
    /// Returns [`TrackingError::NotFinite`] and, without an extent, [`TrackingError::Parameter`].
    pub fn from_corner(x: f64, y: f64, width: f64, height: f64) -> Result<Self, TrackingError> {
        for (index, value) in [x, y, width, height].into_iter().enumerate() {
            if !value.is_finite() {
                return Err(TrackingError::NotFinite { what: "box", index, value });
            }
        }
        for (what, value) in [("width of a box", width), ("height of a box", height)] {
            if value <= 0.0 {
                return Err(TrackingError::Parameter { what, value, range: "positive" });
            }
        }
        Ok(Self { x, y, width, height })
    }

    /// From the centre.
    ///
    /// # Errors
    /// Returns the errors of [`from_corner`](Self::from_corner).
    pub fn from_center(center: [f64; 2], width: f64, height: f64) -> Result<Self, TrackingError> {
        Self::from_corner(center[0] - width / 2.0, center[1] - height / 2.0, width, height)
    }

    /// The top left corner.
    pub fn corner(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    /// The centre.
    pub fn center(&self) -> [f64; 2] {
        [self.x + self.width / 2.0, self.y + self.height / 2.0]
    }

    /// Width in pixels.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// Area in square pixels.
    pub fn area(&self) -> f64 {
        self.width * self.height
    }

    /// Intersection over union, 0 for boxes apart and 1 for the same box.
    pub fn iou(&self, other: &Self) -> f64 {
        let overlap =
            |a: f64, a_len: f64, b: f64, b_len: f64| ((a + a_len).min(b + b_len) - a.max(b)).max(0.0);
        let shared = overlap(self.x, self.width, other.x, other.width)
            * overlap(self.y, self.height, other.y, other.height);
        shared / (self.area() + other.area() - shared)
    }

    /// The part inside a picture of `size` pixels.
    ///
    /// # Errors
    /// Returns [`TrackingError::OutsidePicture`] if there is none.
    pub fn clipped(&self, size: (usize, usize)) -> Result<Self, TrackingError> {
        let (width, height) = (size.0 as f64, size.1 as f64);
        let (left, top) = (self.x.max(0.0), self.y.max(0.0));
        let (right, bottom) = ((self.x + self.width).min(width), (self.y + self.height).min(height));
        Self::from_corner(left, top, right - left, bottom - top).map_err(|_| TrackingError::OutsidePicture {
            bounding_box: [self.x, self.y, self.width, self.height],
            picture: size,
        })
    }
}
