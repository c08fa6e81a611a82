use nalgebra::Vector3;

use super::Plane;
use crate::ColorId;

/// Tolerance within which polygons lie on a common plane, m.
pub(crate) const FLAT: f64 = 1e-6;

/// All polygons on one plane, in map order: later ones on top.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    pub(crate) plane: Plane,
    pub(crate) decals: Vec<Decal>,
}

/// A polygon on a plane.
#[derive(Clone, Debug)]
pub(crate) struct Decal {
    pub(crate) shape: usize,
    pub(crate) color: ColorId,
    /// Counter-clockwise seen from where the plane's normal points to.
    pub(crate) vertices: Vec<Vector3<f64>>,
}

impl Layer {
    /// Adds a polygon with its plane to the first layer that contains it, or to a new one.
    pub(crate) fn sort_in(layers: &mut Vec<Self>, plane: Plane, mut decal: Decal) {
        let lies_on = |layer: &Self| decal.vertices.iter().all(|v| layer.plane.distance(v).abs() <= FLAT);
        let index = layers.iter().position(lies_on).unwrap_or_else(|| {
            layers.push(Self { plane, decals: Vec::new() });
            layers.len() - 1
        });
        let layer = &mut layers[index];
        if layer.plane.normal.dot(&plane.normal) < 0.0 {
            decal.vertices.reverse();
        }
        for vertex in &mut decal.vertices {
            *vertex = layer.plane.foot(vertex);
        }
        layer.decals.push(decal);
    }
}

impl Decal {
    /// Whether a point of the plane is inside the polygon.
    pub(crate) fn contains(&self, normal: &Vector3<f64>, point: &Vector3<f64>) -> bool {
        let next = self.vertices.iter().cycle().skip(1);
        self.vertices.iter().zip(next).all(|(a, b)| normal.cross(&(b - a)).dot(&(point - a)) >= 0.0)
    }
}
