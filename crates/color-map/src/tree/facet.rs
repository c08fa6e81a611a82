use nalgebra::Vector3;

use crate::{
    ColorId,
    map::{HAIR, Plane},
};

/// A convex flat piece of one surface. Corners are places in a list of points, counter-clockwise seen from the front of its plane.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    pub(crate) color: ColorId,
    pub(crate) edges: Vec<Edge>,
}

/// One side of a facet, from its own corner to that of the next one.
///
/// Where a surface was cut, an edge may be a part of a longer one. All parts name the same two points as their line, so that they are the
/// same line to the last bit in every view, and facets that share it leave no gap and do not overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub(crate) corner: usize,
    pub(crate) line: (usize, usize),
}

/// On which side of a plane something is.
pub(super) enum Side<T> {
    Front(T),
    Back(T),
    Both(T, T),
}

impl Facet {
    /// A facet with these corners, which are added to `points`.
    pub(super) fn new(
        color: ColorId,
        corners: impl IntoIterator<Item = Vector3<f64>>,
        points: &mut Vec<Vector3<f64>>,
    ) -> Self {
        let first = points.len();
        points.extend(corners);
        let n = points.len() - first;
        let edge = |k| Edge { corner: first + k, line: (first + k, first + (k + 1) % n) };
        Self { color, edges: (0..n).map(edge).collect() }
    }

    /// Signs of the least and the largest distance of its corners from a plane.
    pub(super) fn reach(&self, plane: &Plane, points: &[Vector3<f64>]) -> (i8, i8) {
        let signs = self.edges.iter().map(|edge| sign(plane.distance(&points[edge.corner])));
        signs.fold((1, -1), |(least, most), sign| (sign.min(least), sign.max(most)))
    }

    /// Sorts it to the front or the back of a plane, or cuts it. New corners are added to `points`.
    pub(super) fn split(self, plane: &Plane, points: &mut Vec<Vector3<f64>>) -> Side<Self> {
        match self.reach(plane, points) {
            (0.., _) => return Side::Front(self),
            (_, ..=0) => return Side::Back(self),
            _ => {}
        }
        let signs: Vec<i8> =
            self.edges.iter().map(|edge| sign(plane.distance(&points[edge.corner]))).collect();
        let n = self.edges.len();
        let (mut front, mut back) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1));
        // The edge along the plane gets its line below, when both its ends are known.
        let (mut front_cut, mut back_cut) = (0, 0);
        for (k, &edge) in self.edges.iter().enumerate() {
            let Edge { corner, line } = edge;
            let (here, next) = (signs[k], signs[(k + 1) % n]);
            if here >= 0 {
                if here == 0 && next < 0 {
                    front_cut = front.len();
                }
                front.push(edge);
            }
            if here <= 0 {
                if here == 0 && next > 0 {
                    back_cut = back.len();
                }
                back.push(edge);
            }
            if here * next < 0 {
                let crossing = crossing(plane, &points[corner], &points[self.edges[(k + 1) % n].corner]);
                let cut = Edge { corner: points.len(), line };
                points.push(crossing);
                if here > 0 {
                    front_cut = front.len();
                } else {
                    back_cut = back.len();
                }
                front.push(cut);
                back.push(cut);
            }
        }
        let (from, to) = (front[front_cut].corner, front[(front_cut + 1) % front.len()].corner);
        front[front_cut].line = (from, to);
        back[back_cut].line = (to, from);
        let color = self.color;
        Side::Both(Self { color, edges: front }, Self { color, edges: back })
    }
}

pub(super) fn sign(distance: f64) -> i8 {
    i8::from(distance > HAIR) - i8::from(distance < -HAIR)
}

fn crossing(plane: &Plane, a: &Vector3<f64>, b: &Vector3<f64>) -> Vector3<f64> {
    let (from, to) = (plane.distance(a), plane.distance(b));
    a + (b - a) * (from / (from - to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_cut_through_a_corner_and_an_edge() {
        let mut points = Vec::new();
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| Vector3::new(x, y, 0.0));
        let square = Facet::new(ColorId(0), corners, &mut points);
        // The plane x = y / 2 goes through the corner (0, 0) and meets the far edge at (1, 2).
        let plane = Plane { normal: Vector3::new(1.0, -0.5, 0.0).normalize(), offset: 0.0 };
        let Side::Both(front, back) = square.split(&plane, &mut points) else { panic!("it is cut") };
        let corners = |facet: &Facet| facet.edges.iter().map(|e| points[e.corner]).collect::<Vec<_>>();
        let at = |x, y| Vector3::new(x, y, 0.0);
        assert_eq!(corners(&front), [at(0.0, 0.0), at(2.0, 0.0), at(2.0, 2.0), at(1.0, 2.0)]);
        assert_eq!(corners(&back), [at(0.0, 0.0), at(1.0, 2.0), at(0.0, 2.0)]);
        // The shared edge is one line, there and back, and the cut edge remembers its whole length.
        assert_eq!(front.edges[3].line, (4, 0));
        assert_eq!(back.edges[0].line, (0, 4));
        assert_eq!(front.edges[2].line, back.edges[1].line);
    }
}
