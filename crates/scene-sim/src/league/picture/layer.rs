use nalgebra::Vector3;

use super::surface::{SurfaceShape, plane_normal};
use super::view::{Affine, View};

/// Surfaces in one plane, seen at the same depth but for rounding: the later one is on top.
const SAME_DEPTH: f64 = 1.0 - 1e-9;

/// First intersections of one bundle of rays: for each pixel the nearest surface and its nearness.
///
/// A polygon is inside the planes through the eye and its edges, which are affine functions of the image point; so is the inverse of its depth.
/// This equals ray casting without tracing single rays.
pub(super) struct Layer {
    /// 1 / (distance along the ray in units of its direction); 0 without an intersection.
    pub(super) nearness: Vec<f64>,
    /// Number of the surface; [`Layer::NOTHING`] without an intersection.
    pub(super) surface: Vec<u16>,
}

impl Layer {
    pub(super) const NOTHING: u16 = u16::MAX;

    pub(super) fn new(n_pixels: usize) -> Self {
        Self { nearness: vec![0.0; n_pixels], surface: vec![Self::NOTHING; n_pixels] }
    }

    pub(super) fn clear(&mut self) {
        self.nearness.fill(0.0);
        self.surface.fill(Self::NOTHING);
    }

    pub(super) fn draw(&mut self, number: u16, form: &SurfaceShape, view: &View) {
        match form {
            SurfaceShape::Polygon { corners } => self.draw_polygon(number, corners, view),
            SurfaceShape::Tube { axis, radius, from, to } => {
                let meet = |ray: &Vector3<f64>| {
                    tube_nearness(&(axis - view.eye), *radius, [from - view.eye.z, to - view.eye.z], ray)
                };
                self.draw_round(number, axis, *radius, view, meet);
            }
            SurfaceShape::Ball { centre, radius } => {
                let meet = |ray: &Vector3<f64>| ball_nearness(&(centre - view.eye), *radius, ray);
                self.draw_round(number, centre, *radius, view, meet);
            }
        }
    }

    fn draw_polygon(&mut self, number: u16, corners: &[Vector3<f64>], view: &View) {
        let normal = plane_normal(corners);
        let Some(first) = corners.first() else { return };
        let height = normal.dot(&(first - view.eye));
        if height.abs() < 1e-12 {
            return; // seen edge-on
        }
        let nearness = view.affine(&(normal / height));
        let next = corners.iter().cycle().skip(1);
        let edges: Vec<Affine> = corners
            .iter()
            .zip(next)
            .map(|(a, b)| view.affine(&((a - view.eye).cross(&(b - view.eye)) * height.signum())))
            .collect();
        let (width, rows) = view.size();
        if is_outside(&edges, width as f64, rows as f64) {
            return;
        }
        for row in 0..rows {
            for column in view.columns(row, &edges) {
                let near = nearness.at(column as f64 + view.spot.0, row as f64 + view.spot.1);
                self.put(row * width + column, number, near);
            }
        }
    }

    /// A body of revolution about a vertical axis: only columns between its tangent planes are tested.
    fn draw_round(
        &mut self,
        number: u16,
        axis: &Vector3<f64>,
        radius: f64,
        view: &View,
        meet: impl Fn(&Vector3<f64>) -> f64,
    ) {
        let Some(planes) = tangent_planes(&(axis - view.eye), radius) else { return };
        let planes = planes.map(|plane| view.affine(&plane));
        let (width, rows) = view.size();
        for row in 0..rows {
            for column in view.columns(row, &planes) {
                self.put(row * width + column, number, meet(&view.ray(column, row)));
            }
        }
    }

    fn put(&mut self, pixel: usize, number: u16, nearness: f64) {
        if nearness > 0.0 && nearness >= self.nearness[pixel] * SAME_DEPTH {
            self.nearness[pixel] = nearness;
            self.surface[pixel] = number;
        }
    }
}

/// Whether some edge has the whole image on its outer side.
fn is_outside(edges: &[Affine], width: f64, height: f64) -> bool {
    let corners = [(-1.0, -1.0), (width + 1.0, -1.0), (-1.0, height + 1.0), (width + 1.0, height + 1.0)];
    edges.iter().any(|edge| corners.iter().all(|&(u, v)| edge.at(u, v) < 0.0))
}

/// The two upright planes through the eye that touch the cylinder, positive on its side; none from inside it.
fn tangent_planes(to_axis: &Vector3<f64>, radius: f64) -> Option<[Vector3<f64>; 2]> {
    let squared = to_axis.x * to_axis.x + to_axis.y * to_axis.y;
    let sin = radius / squared.sqrt();
    if !(0.0..1.0).contains(&sin) {
        return None;
    }
    let cos = (1.0 - sin * sin).sqrt();
    let (x, y) = (to_axis.x, to_axis.y);
    let left = (x * cos - y * sin, x * sin + y * cos);
    let right = (x * cos + y * sin, y * cos - x * sin);
    Some([Vector3::new(left.1, -left.0, 0.0), Vector3::new(-right.1, right.0, 0.0)])
}

fn tube_nearness(to_axis: &Vector3<f64>, radius: f64, heights: [f64; 2], ray: &Vector3<f64>) -> f64 {
    let a = ray.x * ray.x + ray.y * ray.y;
    let b = ray.x * to_axis.x + ray.y * to_axis.y;
    let c = to_axis.x * to_axis.x + to_axis.y * to_axis.y - radius * radius;
    let distance = (b - (b * b - a * c).max(0.0).sqrt()) / a;
    let height = distance * ray.z;
    if heights[0] <= height && height <= heights[1] { 1.0 / distance } else { 0.0 }
}

fn ball_nearness(to_centre: &Vector3<f64>, radius: f64, ray: &Vector3<f64>) -> f64 {
    let (a, b) = (ray.norm_squared(), ray.dot(to_centre));
    let discriminant = b * b - a * (to_centre.norm_squared() - radius * radius);
    if discriminant < 0.0 { 0.0 } else { a / (b - discriminant.sqrt()) }
}
