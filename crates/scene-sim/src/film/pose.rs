use crate::scenery::canvas::Window;

/// Position and rotation of a flat object in the image, and its scale along and across.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub(super) centre: (f64, f64),
    sin: f64,
    cos: f64,
    pub(super) unit_px: (f64, f64),
}

impl Pose {
    /// Turned by `angle` radians, clockwise as the picture shows it.
    pub(super) fn new(centre: (f64, f64), angle: f64, unit_px: (f64, f64)) -> Self {
        let (sin, cos) = libm::sincos(angle);
        Self { centre, sin, cos, unit_px }
    }

    /// A point of the picture in the units of the thing.
    pub(super) fn to_body(self, x: f64, y: f64) -> (f64, f64) {
        let (dx, dy) = (x - self.centre.0, y - self.centre.1);
        let (along, across) = (self.cos * dx + self.sin * dy, self.cos * dy - self.sin * dx);
        (along / self.unit_px.0, across / self.unit_px.1)
    }

    /// Turns a distance in units into pixels, for the softness of edges.
    pub(super) fn px(self) -> f64 {
        self.unit_px.0.min(self.unit_px.1)
    }

    /// The part of an image within this number of units of the centre.
    pub(super) fn window(self, units: f64, size: (usize, usize)) -> Window {
        Window::around(self.centre, 2.0 + units * self.unit_px.0.max(self.unit_px.1), size)
    }
}

/// Position of a point relative to an upright ellipse, positive inside, in the units of the point.
pub(super) fn in_ellipse((u, v): (f64, f64), centre: (f64, f64), radii: (f64, f64)) -> f64 {
    let (a, b) = ((u - centre.0) / radii.0, (v - centre.1) / radii.1);
    (1.0 - (a * a + b * b).sqrt()) * radii.0.min(radii.1)
}
