use nalgebra::{Matrix2, Vector2};

use super::fit::{LEAST_AREA, fit};
use super::{AffineMap, EdgeSearch, Outline};
use crate::TrackingError;
use crate::error::checked;

/// Parameters of the snake fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct SnakeParams {
    /// Points along the contour. Default 80.
    pub n_points: usize,
    /// Initial search distance for an edge along the normals, in radii of a circle of equal area, at least 3 pixels; it shrinks to a
    /// quarter. Default 0.5.
    pub search_distance: f64,
    /// A point this near to an edge is on it, in pixels. Default 1.5.
    pub tolerance: f64,
    /// Weight of the shape at the start against that of the edges; 0.01 lets a shape follow nearly all of a change that is seen all round.
    /// Above 0. Default 0.02.
    pub stiffness: f64,
    /// Steps of least squares. Default 10.
    pub max_iterations: usize,
}

impl Default for SnakeParams {
    fn default() -> Self {
        Self { n_points: 80, search_distance: 0.5, tolerance: 1.5, stiffness: 0.02, max_iterations: 10 }
    }
}

impl SnakeParams {
    /// # Errors
    /// Returns [`TrackingError::Parameter`] with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), TrackingError> {
        let n_points = self.n_points as f64;
        checked("n_points", n_points, (8..=10_000).contains(&self.n_points), "from 8 to 10000")?;
        checked(
            "search_distance",
            self.search_distance,
            (0.0..=10.0).contains(&self.search_distance),
            "from 0 to 10",
        )?;
        checked(
            "tolerance",
            self.tolerance,
            self.tolerance > 0.0 && self.tolerance <= 1e3,
            "from 0 to 1000",
        )?;
        let stiffness = self.stiffness;
        checked("stiffness", stiffness, stiffness > 0.0 && stiffness.is_finite(), "positive")?;
        let max_iterations = self.max_iterations as f64;
        checked(
            "max_iterations",
            max_iterations,
            (1..=1000).contains(&self.max_iterations),
            "from 1 to 1000",
        )?;
        Ok(())
    }
}

/// A contour with a fixed shape up to an affine map, $`\mathbf r_i = M \mathbf q_i + \mathbf t`$. [Andrade-Cetto 2005, Sec. 3.1, Fig. 12;
/// "a restriction to the classical snake minimization procedure, to obtain affine deformations only"]
/// ```
/// use wayfix_visual_tracking::{AffineSnake, PixelMask, BoundingBox, MaskEdgeSearch, Outline, SnakeParams};
/// let params = SnakeParams::default();
/// let circle = Outline::ellipse(&BoundingBox::from_center([50.0, 50.0], 40.0, 40.0)?, 100)?;
/// let snake = AffineSnake::new(&circle, &params)?;
/// // It has moved and become an ellipse.
/// let mask = PixelMask::from_fn(120, 100, |u, v| {
///     ((u as f64 + 0.5 - 56.0) / 25.0).powi(2) + ((v as f64 + 0.5 - 47.0) / 16.0).powi(2) < 1.0
/// })?;
/// let fit = snake.fit(snake.map(), &MaskEdgeSearch::new(&mask, (0, 0)), &params);
/// assert!(fit.support > 0.95);
/// let outline = snake.outline_at(&fit.map)?;
/// assert!((outline.area() - mask.area() as f64).abs() < 0.05 * outline.area());
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AffineSnake {
    shape: Vec<Vector2<f64>>,
    map: AffineMap,
}

/// Result of a snake fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnakeFit {
    /// The map from the shape of the snake into the picture.
    pub map: AffineMap,
    /// $`Φ_\text{affine}`$: the share of the visible points that lie on an edge; 0 if no point is visible.
    pub support: f64,
    /// The share of the points that are in sight.
    pub visible: f64,
}

impl AffineSnake {
    /// A snake with the shape and the position of an outline.
    /// # Errors
    /// Returns [`TrackingError::Parameter`] for parameters out of range or an outline of less than four square pixels.
    pub fn new(outline: &Outline, params: &SnakeParams) -> Result<Self, TrackingError> {
        params.validate()?;
        let outline = outline.resampled(params.n_points)?;
        let area = outline.area();
        checked("area of a snake", area, area >= LEAST_AREA, "at least four pixels")?;
        let center = Vector2::from(outline.centroid());
        let radius = (outline.area() / std::f64::consts::PI).sqrt();
        let shape = outline.points().iter().map(|point| (Vector2::from(*point) - center) / radius).collect();
        let map = AffineMap { linear: Matrix2::identity() * radius, translation: center };
        Ok(Self { shape, map })
    }

    /// The current map from the shape, which has the area of the unit circle and is centred at the origin, to the image.
    pub fn map(&self) -> &AffineMap {
        &self.map
    }

    /// The area under a map, in square pixels.
    pub(crate) fn area_at(&self, map: &AffineMap) -> f64 {
        std::f64::consts::PI * map.linear.determinant().abs()
    }

    /// Sets the map.
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if the map turns the shape over or flattens it.
    pub(crate) fn moved_to(&self, map: &AffineMap) -> Result<Self, TrackingError> {
        self.outline_at(map)?;
        checked("determinant", map.linear.determinant(), map.linear.determinant() > 0.0, "positive")?;
        Ok(Self { map: *map, ..self.clone() })
    }

    /// The contour.
    pub fn outline(&self) -> Outline {
        self.outline_at(&self.map).expect("invariant: the snake encloses an area")
    }

    /// The contour under a map.
    /// # Errors
    /// Returns the errors of [`Outline::from_points`].
    pub fn outline_at(&self, map: &AffineMap) -> Result<Outline, TrackingError> {
        Outline::from_points(self.shape.iter().map(|point| map.apply((*point).into())).collect())
    }

    /// Fits the snake to edges from a start, by re-weighted least squares along its normals:
    /// $`\min \sum_i w_i (\mathbf n_i \cdot δ\mathbf r_i - d_i)^2 + κ N \| M - M_0 \|^2`$ with distances $`d_i`$ to the edge and biweights
    /// $`w_i = (1 - d_i^2/r^2)^2`$ whose radius $`r`$ shrinks. Points without an edge have no weight, so a part may be hidden.
    ///
    /// The area stays between half and twice that at the start, the shape is never turned over, and its two sides never stretched more than
    /// six times apart; a step that would is not taken.
    pub fn fit(&self, start: &AffineMap, edges: &impl EdgeSearch, params: &SnakeParams) -> SnakeFit {
        fit(&self.shape, start, edges, params)
    }
}
