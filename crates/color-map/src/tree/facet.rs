use nalgebra::Vector3;

use crate::{
    ColorId,
    map::{PLANE_TOLERANCE_M, Plane},
};

/// A convex flat piece of one surface.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    pub(crate) color: ColorId,
    /// Counter-clockwise seen from the front of its plane.
    pub(crate) edges: Vec<Edge>,
    /// A ball around it.
    pub(crate) center: Vector3<f64>,
    pub(crate) radius: f64,
}

/// One side of a facet, from its own corner to that of the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Edge {
    pub(crate) corner: Vector3<f64>,
    /// The ends of the original edge of this part.
    ///
    /// All parts of an edge are drawn with the line through its ends, which is equal to the last bit, so that adjacent facets
    /// leave no gap and do not overlap.
    pub(crate) whole: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// On which side of a plane something is.
pub(super) enum Side<T> {
    Front(T),
    Back(T),
    Both(T, T),
}

impl Facet {
    /// A facet with these corners.
    pub(super) fn new(color: ColorId, corners: impl IntoIterator<Item = Vector3<f64>>) -> Self {
        let edges = corners.into_iter().map(|corner| Edge { corner, whole: None });
        Self::from_edges(color, edges.collect())
    }

    fn from_edges(color: ColorId, edges: Vec<Edge>) -> Self {
        let center = edges.iter().map(|edge| edge.corner).sum::<Vector3<f64>>() / edges.len() as f64;
        let radius = edges.iter().map(|edge| (edge.corner - center).norm()).fold(0.0, f64::max);
        Self { color, edges, center, radius }
    }

    /// Signs of the least and the largest distance of its corners from a plane.
    pub(super) fn reach(&self, plane: &Plane) -> (i8, i8) {
        reach(self.edges.iter().map(|edge| edge.corner), plane)
    }

    /// Sorts it to the front or the back of a plane, or cuts it.
    pub(super) fn split(self, plane: &Plane) -> Side<Self> {
        match self.reach(plane) {
            (0.., _) => return Side::Front(self),
            (_, ..=0) => return Side::Back(self),
            _ => {}
        }
        let n = self.edges.len();
        let (mut front, mut back) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1));
        for (k, edge) in self.edges.iter().enumerate() {
            let end = self.edges[(k + 1) % n].corner;
            let (here, there) = (plane.distance(&edge.corner), plane.distance(&end));
            let (sign, next) = (sign(here), sign(there));
            // From a corner on the plane, one of the two continues along the edge and the other along the plane.
            let along_plane = Edge { corner: edge.corner, whole: None };
            if sign >= 0 {
                front.push(if sign == 0 && next < 0 { along_plane } else { *edge });
            }
            if sign <= 0 {
                back.push(if sign == 0 && next > 0 { along_plane } else { *edge });
            }
            if sign * next < 0 {
                let corner = edge.corner + (end - edge.corner) * (here / (here - there));
                let whole = Some(edge.whole.unwrap_or((edge.corner, end)));
                let (before, after) =
                    if sign > 0 { (&mut front, &mut back) } else { (&mut back, &mut front) };
                if let Some(first_part) = before.last_mut() {
                    *first_part = Edge { whole, ..*first_part };
                }
                before.push(Edge { corner, whole: None });
                after.push(Edge { corner, whole });
            }
        }
        Side::Both(Self::from_edges(self.color, front), Self::from_edges(self.color, back))
    }
}

/// Signs of the least and the largest distance of some points from a plane.
pub(super) fn reach(points: impl Iterator<Item = Vector3<f64>>, plane: &Plane) -> (i8, i8) {
    let signs = points.map(|point| sign(plane.distance(&point)));
    signs.fold((1, -1), |(least, most), sign| (sign.min(least), sign.max(most)))
}

/// Nearer than a hair is on the plane.
fn sign(distance: f64) -> i8 {
    i8::from(distance > PLANE_TOLERANCE_M) - i8::from(distance < -PLANE_TOLERANCE_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_cut_through_a_corner_and_an_edge() {
        let at = |x, y| Vector3::new(x, y, 0.0);
        let square = Facet::new(ColorId(0), [at(0.0, 0.0), at(2.0, 0.0), at(2.0, 2.0), at(0.0, 2.0)]);
        // The plane x = y / 2 goes through the corner (0, 0) and meets the far edge at (1, 2).
        let plane = Plane { normal: Vector3::new(1.0, -0.5, 0.0).normalize(), offset: 0.0 };
        let Side::Both(front, back) = square.split(&plane) else { panic!("it is cut") };

        let far_edge = Some((at(2.0, 2.0), at(0.0, 2.0)));
        let edge = |x, y, whole| Edge { corner: at(x, y), whole };
        let expected =
            [edge(0.0, 0.0, None), edge(2.0, 0.0, None), edge(2.0, 2.0, far_edge), edge(1.0, 2.0, None)];
        assert_eq!(front.edges, expected);
        assert_eq!(back.edges, [edge(0.0, 0.0, None), edge(1.0, 2.0, far_edge), edge(0.0, 2.0, None)]);
    }

    #[test]
    fn a_part_of_a_part_remembers_the_whole_edge() {
        let at = |x, y| Vector3::new(x, y, 0.0);
        let square = Facet::new(ColorId(0), [at(0.0, 0.0), at(4.0, 0.0), at(4.0, 1.0), at(0.0, 1.0)]);
        let cut = |offset| Plane { normal: Vector3::x(), offset };
        let Side::Both(right, _) = square.split(&cut(1.0)) else { panic!("it is cut") };
        let Side::Both(_, middle) = right.split(&cut(3.0)) else { panic!("it is cut") };
        let floor = middle.edges.iter().find(|edge| edge.corner == at(1.0, 0.0)).unwrap();
        assert_eq!(floor.whole, Some((at(0.0, 0.0), at(4.0, 0.0))));
    }
}
