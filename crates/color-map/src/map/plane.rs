use nalgebra::Vector3;

/// Distance treated as zero, m: a surface whose plane passes the eye within it is edge-on and invisible, and surfaces that extend less than this
/// beyond a plane do not cross it.
pub(crate) const PLANE_TOLERANCE_M: f64 = 1e-9;

/// $`n^T x = d`$ with a unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    pub(crate) normal: Vector3<f64>,
    pub(crate) offset: f64,
}

impl Plane {
    /// Signed distance, positive on the side the normal points to.
    pub(crate) fn distance(&self, point: &Vector3<f64>) -> f64 {
        self.normal.dot(point) - self.offset
    }

    /// The plane's point next to `point`.
    pub(crate) fn foot(&self, point: &Vector3<f64>) -> Vector3<f64> {
        point - self.normal * self.distance(point)
    }
}
