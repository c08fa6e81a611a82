use nalgebra::Vector3;
use wayfix_color_map::{ColorId, ColorMap, ColoredShape};

use crate::league::LinearRgb;

/// The geometry of one surface. All are seen from both sides.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceShape {
    /// A planar convex polygon.
    Polygon {
        /// Its corners in order, metres.
        corners: Vec<Vector3<f64>>,
    },
    /// The side of an upright cylinder.
    Tube {
        /// A point of its axis; z is not used.
        axis: Vector3<f64>,
        /// Radius, metres.
        radius: f64,
        /// Height of its lower end, metres.
        from: f64,
        /// Height of its upper end, metres.
        to: f64,
    },
    /// A ball.
    Ball {
        /// Its centre, metres.
        centre: Vector3<f64>,
        /// Radius, metres.
        radius: f64,
    },
}

/// Paint of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// A colour of the map; the venue defines its reflectance.
    Map(ColorId),
    /// A diffuse reflectance that no map lists.
    Unmapped(LinearRgb),
}

/// Something to see.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSurface {
    /// Shape and position.
    pub form: SurfaceShape,
    /// Paint.
    pub material: Material,
}

impl SceneSurface {
    /// The surfaces of a map, in its order.
    pub fn of_map(map: &ColorMap) -> Vec<Self> {
        map.shapes().iter().flat_map(of_shape).collect()
    }

    /// The sides and the top of a box that is upright but turned by `heading`: `low` and `high` are opposite corners in its own frame.
    pub(in crate::league) fn cuboid(
        place: &wayfix_estimation_traits::Pose2<f64>,
        low: [f64; 3],
        high: [f64; 3],
        material: Material,
    ) -> [Self; 5] {
        let ahead = crate::plane::direction(place.heading());
        let corner = |k: usize| {
            let pick = |axis: usize| if k >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let (x, y) = (pick(0), pick(1));
            let at = place.translation + ahead * x + nalgebra::Vector2::new(-ahead.y, ahead.x) * y;
            Vector3::new(at.x, at.y, pick(2))
        };
        [[0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6]]
            .map(|side| Self { form: SurfaceShape::Polygon { corners: side.map(corner).to_vec() }, material })
    }
}

fn of_shape(shape: &ColoredShape) -> Vec<SceneSurface> {
    match shape {
        ColoredShape::Polygon { color, vertices } => {
            vec![SceneSurface {
                form: SurfaceShape::Polygon { corners: vertices.clone() },
                material: Material::Map(*color),
            }]
        }
        ColoredShape::Post { x, y, radius, bands } => bands
            .iter()
            .map(|band| SceneSurface {
                form: SurfaceShape::Tube {
                    axis: Vector3::new(*x, *y, 0.0),
                    radius: *radius,
                    from: band.from,
                    to: band.to,
                },
                material: Material::Map(band.color),
            })
            .collect(),
    }
}

impl SurfaceShape {
    /// The unit normal at a point of the surface, on the side of `eye`.
    pub(super) fn normal(&self, at: &Vector3<f64>, eye: &Vector3<f64>) -> Vector3<f64> {
        let outward = match self {
            Self::Polygon { corners } => plane_normal(corners),
            Self::Tube { axis, .. } => Vector3::new(at.x - axis.x, at.y - axis.y, 0.0),
            Self::Ball { centre, .. } => at - centre,
        };
        let unit = outward.try_normalize(0.0).unwrap_or_else(Vector3::z);
        if unit.dot(&(eye - at)) < 0.0 { -unit } else { unit }
    }
}

/// Points at viewers who see the corners counter-clockwise; not of unit length.
pub(super) fn plane_normal(corners: &[Vector3<f64>]) -> Vector3<f64> {
    let Some((first, rest)) = corners.split_first() else { return Vector3::zeros() };
    rest.windows(2).map(|pair| (pair[0] - first).cross(&(pair[1] - first))).sum()
}
