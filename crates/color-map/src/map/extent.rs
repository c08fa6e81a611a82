use nalgebra::Vector3;

use crate::ColoredShape;

/// The upright box that a map fills, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapExtent {
    /// Smallest coordinates.
    pub min: Vector3<f64>,
    /// Largest coordinates.
    pub max: Vector3<f64>,
}

impl MapExtent {
    /// Of all shapes; none if there are none.
    pub(crate) fn of(shapes: &[ColoredShape]) -> Option<Self> {
        let mut extent: Option<Self> = None;
        let mut add = |point: Vector3<f64>| {
            let grown = extent.map_or(Self { min: point, max: point }, |e| Self {
                min: e.min.inf(&point),
                max: e.max.sup(&point),
            });
            extent = Some(grown);
        };
        for shape in shapes {
            match shape {
                ColoredShape::Polygon { vertices, .. } => vertices.iter().copied().for_each(&mut add),
                ColoredShape::Post { x, y, radius, bands } => {
                    for band in bands {
                        add(Vector3::new(x - radius, y - radius, band.from));
                        add(Vector3::new(x + radius, y + radius, band.to));
                    }
                }
            }
        }
        extent
    }
}
