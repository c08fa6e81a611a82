use nalgebra::{Matrix2, Vector2};

/// An affine map of the picture plane, $`\mathbf p ↦ M \mathbf p + \mathbf t`$, in pixels.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use wayfix_visual_tracking::AffineMap;
/// let map = AffineMap { linear: Matrix2::identity() * 2.0, translation: Vector2::new(1.0, 0.0) };
/// assert_eq!(map.apply([3.0, 4.0]), [7.0, 8.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AffineMap {
    /// $`M`$.
    pub linear: Matrix2<f64>,
    /// $`\mathbf t`$.
    pub translation: Vector2<f64>,
}

impl AffineMap {
    /// Maps a point.
    pub fn apply(&self, point: [f64; 2]) -> [f64; 2] {
        (self.linear * Vector2::from(point) + self.translation).into()
    }

    /// The map followed by a translation in pixels.
    pub fn shifted(mut self, by: [f64; 2]) -> Self {
        self.translation += Vector2::from(by);
        self
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.linear.iter().chain(&self.translation).all(|value| value.is_finite())
    }
}
