use super::{Decal, Layer, MapExtent, Prism, check};
use crate::{ColorMapError, ColoredShape, tree::Tree};

/// A validated map of coloured surfaces.
///
/// Polygons may touch and intersect each other, and posts may intersect polygons: every view is sorted exactly. Only posts must not overlap each
/// other, seen from above.
/// ```
/// use nalgebra::Vector3;
/// use wayfix_color_map::{ColorId, ColorMap, ColorMapError, ColoredShape};
///
/// let corner = |x, y| Vector3::new(x, y, 0.0);
/// let carpet = |color| ColoredShape::Polygon { color, vertices: vec![corner(0.0, 0.0), corner(4.0, 0.0), corner(0.0, 3.0)] };
/// let map = ColorMap::new(vec!["green".into()], vec![carpet(ColorId(0))])?;
/// assert_eq!(map.colors()[0], "green");
/// assert_eq!(map.extent().unwrap().max, Vector3::new(4.0, 3.0, 0.0));
///
/// let unknown = ColorMap::new(vec!["green".into()], vec![carpet(ColorId(7))]);
/// assert_eq!(unknown.unwrap_err(), ColorMapError::UnknownColor { shape: 0, color: 7, n_colors: 1 });
/// # Ok::<(), ColorMapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ColorMap {
    colors: Vec<String>,
    shapes: Vec<ColoredShape>,
    extent: Option<MapExtent>,
    pub(crate) layers: Vec<Layer>,
    /// One a band.
    pub(crate) prisms: Vec<Prism>,
    /// The same surfaces, sorted for any view.
    pub(crate) tree: Tree,
}

impl ColorMap {
    /// A map of these shapes; a shape's [`ColorId`](crate::ColorId) is a place in `colors`.
    ///
    /// # Errors
    /// See [`ColorMapError`]: unknown, too many or equally named colours; polygons with too few corners, without width, not flat or not
    /// convex (1e-6 m are tolerated); posts without radius, with bands out of order, or standing in each other; numbers that are NaN or
    /// beyond 1e6 m; surfaces that pierce
    /// each other into more than 200 000 pieces.
    pub fn new(colors: Vec<String>, shapes: Vec<ColoredShape>) -> Result<Self, ColorMapError> {
        check::colors(&colors)?;
        let (mut layers, mut prisms) = (Vec::new(), Vec::new());
        for (i, shape) in shapes.iter().enumerate() {
            match shape {
                ColoredShape::Polygon { color, vertices } => {
                    check::color(i, *color, colors.len())?;
                    let plane = check::polygon(i, vertices)?;
                    let decal = Decal { shape: i, color: *color, vertices: vertices.clone() };
                    Layer::sort_in(&mut layers, plane, decal);
                }
                ColoredShape::Post { x, y, radius, bands } => {
                    check::post(i, *x, *y, *radius, bands)?;
                    bands.iter().try_for_each(|band| check::color(i, band.color, colors.len()))?;
                    prisms.extend(bands.iter().map(|band| Prism::new(i, *x, *y, *radius, band)));
                }
            }
        }
        check::posts_apart(&prisms)?;
        let tree = Tree::build(&layers, &prisms)?;
        let extent = MapExtent::of(&shapes);
        Ok(Self { colors, shapes, extent, layers, prisms, tree })
    }

    /// The names of the colours.
    pub fn colors(&self) -> &[String] {
        &self.colors
    }

    /// The shapes, as given.
    pub fn shapes(&self) -> &[ColoredShape] {
        &self.shapes
    }

    /// The upright box that the map fills; none if it has no shape.
    pub fn extent(&self) -> Option<MapExtent> {
        self.extent
    }
}

/// Equal colours and shapes: the rest follows from them.
impl PartialEq for ColorMap {
    fn eq(&self, other: &Self) -> bool {
        self.colors == other.colors && self.shapes == other.shapes
    }
}
