use crate::BoundingBox;
use crate::{AffineMap, PixelMask, TrackingError};

/// A closed polygon around a target; points `[u, v]` in pixels, where the pixel in column `u` and row `v` covers $`[u, u+1) × [v, v+1)`$.
///
/// The points are ordered so that the signed area in image coordinates (v down) is positive, for either input order.
/// ```
/// use wayfix_visual_tracking::Outline;
/// let square = Outline::from_points(vec![[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0]])?;
/// assert_eq!((square.area(), square.centroid()), (16.0, [2.0, 2.0]));
/// assert_eq!(square.resampled(16)?.points().len(), 16);
/// assert!(Outline::from_points(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).is_err());
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    points: Vec<[f64; 2]>,
}

impl Outline {
    /// From the corners of a polygon in order.
    ///
    /// # Errors
    /// Returns [`TrackingError::NotFinite`], or [`TrackingError::Parameter`] if the area is less than one square pixel.
    pub fn from_points(mut points: Vec<[f64; 2]>) -> Result<Self, TrackingError> {
        for (index, point) in points.iter().enumerate() {
            if let Some(&value) = point.iter().find(|value| value.is_nan() || value.abs() >= 1e9) {
                return Err(TrackingError::NotFinite { what: "point of an outline", index, value });
            }
        }
        let area = signed_area(&points);
        crate::error::checked("area of an outline", area.abs(), area.abs() >= 1.0, "at least one pixel")?;
        if area < 0.0 {
            points.reverse();
        }
        Ok(Self { points })
    }

    /// The ellipse that fills a box, as a polygon of `n_points` corners.
    ///
    /// # Errors
    /// Returns the errors of [`from_points`](Self::from_points).
    pub fn ellipse(bounds: &BoundingBox, n_points: usize) -> Result<Self, TrackingError> {
        let ([u, v], (a, b)) = (bounds.center(), (bounds.width() / 2.0, bounds.height() / 2.0));
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n_points as f64;
        Self::from_points((0..n_points).map(|i| [u + a * angle(i).cos(), v + b * angle(i).sin()]).collect())
    }

    /// The outer contour of a mask with one blob, whose top left pixel is pixel `corner` of the image: along the rim of its pixels, without
    /// their steps. `None` for an empty mask or one too thin to enclose an area.
    pub fn of_mask(mask: &PixelMask, corner: (usize, usize)) -> Option<Self> {
        let middle = |[u, v]: [usize; 2]| [(u + corner.0) as f64 + 0.5, (v + corner.1) as f64 + 0.5];
        let middles = Self::from_points(mask.outer_contour().into_iter().map(middle).collect()).ok()?;
        let smooth = middles.smoothed(2).unwrap_or(middles);
        // From the middles of the pixels out to their rim.
        let rim = smooth.points.iter().zip(smooth.normals());
        Self::from_points(rim.map(|(p, n)| [p[0] + 0.5 * n[0], p[1] + 0.5 * n[1]]).collect()).ok()
    }

    /// The points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Enclosed area in square pixels.
    pub fn area(&self) -> f64 {
        signed_area(&self.points)
    }

    /// Centre of mass of the enclosed area.
    pub fn centroid(&self) -> [f64; 2] {
        let origin = self.points[0];
        let mut sum = [0.0; 2];
        for (p, q) in edges(&self.points) {
            let (p, q) = ([p[0] - origin[0], p[1] - origin[1]], [q[0] - origin[0], q[1] - origin[1]]);
            let cross = p[0] * q[1] - q[0] * p[1];
            for axis in 0..2 {
                sum[axis] += (p[axis] + q[axis]) * cross;
            }
        }
        let area = self.area();
        [0, 1].map(|axis| origin[axis] + sum[axis] / (6.0 * area))
    }

    /// The upright box around it.
    pub fn bounding_box(&self) -> BoundingBox {
        let limit = |axis: usize, pick: fn(f64, f64) -> f64| {
            self.points
                .iter()
                .map(|point| point[axis])
                .reduce(pick)
                .expect("invariant: an outline has points")
        };
        let [left, top] = [0, 1].map(|axis| limit(axis, f64::min));
        let [right, bottom] = [0, 1].map(|axis| limit(axis, f64::max));
        BoundingBox::from_corner(left, top, right - left, bottom - top)
            .expect("invariant: an outline has an area")
    }

    /// `n_points` points at equal distances along the outline.
    ///
    /// # Errors
    /// Returns the errors of [`from_points`](Self::from_points): so few points may not enclose anything.
    pub fn resampled(&self, n_points: usize) -> Result<Self, TrackingError> {
        let length: f64 = edges(&self.points).map(|(p, q)| (q[0] - p[0]).hypot(q[1] - p[1])).sum();
        let step = length / n_points.max(1) as f64;
        let mut points = Vec::with_capacity(n_points);
        let mut start = 0.0;
        for (p, q) in edges(&self.points) {
            let edge = (q[0] - p[0]).hypot(q[1] - p[1]);
            while points.len() < n_points && points.len() as f64 * step < start + edge {
                let share = (points.len() as f64 * step - start) / edge;
                points.push([0, 1].map(|axis| p[axis] + share * (q[axis] - p[axis])));
            }
            start += edge;
        }
        Self::from_points(points)
    }

    /// Each point replaced by the mean of itself and `reach` neighbours on either side: takes the steps of pixels off a contour.
    ///
    /// # Errors
    /// Returns the errors of [`from_points`](Self::from_points): a thin outline may vanish.
    pub fn smoothed(&self, reach: usize) -> Result<Self, TrackingError> {
        let n = self.points.len();
        let reach = reach.min((n - 1) / 2);
        let mean = |i: usize| {
            let sum = (0..=2 * reach).fold([0.0; 2], |sum, k| {
                let point = self.points[(i + n + k - reach) % n];
                [sum[0] + point[0], sum[1] + point[1]]
            });
            sum.map(|sum| sum / (2 * reach + 1) as f64)
        };
        Self::from_points((0..n).map(mean).collect())
    }

    /// Unit normals at the points, pointing out.
    pub fn normals(&self) -> Vec<[f64; 2]> {
        let n = self.points.len();
        let normal = |i: usize| {
            let (p, q) = (self.points[(i + n - 1) % n], self.points[(i + 1) % n]);
            let (du, dv) = (q[0] - p[0], q[1] - p[1]);
            let length = du.hypot(dv);
            if length > 0.0 { [dv / length, -du / length] } else { [0.0; 2] }
        };
        (0..n).map(normal).collect()
    }

    /// The smallest convex outline around it, by Andrew's monotone chain.
    pub(crate) fn convex_hull(&self) -> Self {
        let mut sorted = self.points.clone();
        sorted.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
        let turn = |o: [f64; 2], p: [f64; 2], q: [f64; 2]| {
            (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0])
        };
        let half = |points: &mut dyn Iterator<Item = &[f64; 2]>| {
            let mut chain: Vec<[f64; 2]> = Vec::new();
            for &point in points {
                while let [.., o, p] = chain[..]
                    && turn(o, p, point) <= 0.0
                {
                    chain.pop();
                }
                chain.push(point);
            }
            chain.pop();
            chain
        };
        let mut hull = half(&mut sorted.iter());
        hull.extend(half(&mut sorted.iter().rev()));
        Self::from_points(hull).expect("invariant: a hull is no smaller than what it holds")
    }

    /// The outline under an affine map.
    ///
    /// # Errors
    /// Returns the errors of [`from_points`](Self::from_points): the map may flatten it.
    pub fn mapped(&self, map: &AffineMap) -> Result<Self, TrackingError> {
        Self::from_points(self.points.iter().map(|point| map.apply(*point)).collect())
    }
}

/// The sides of a polygon.
fn edges(points: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    points.iter().copied().zip(points.iter().copied().cycle().skip(1))
}

/// The shoelace formula, about the first point to avoid loss of precision far from the origin.
fn signed_area(points: &[[f64; 2]]) -> f64 {
    let Some(origin) = points.first() else { return 0.0 };
    let cross = |p: [f64; 2], q: [f64; 2]| {
        (p[0] - origin[0]) * (q[1] - origin[1]) - (q[0] - origin[0]) * (p[1] - origin[1])
    };
    edges(points).map(|(p, q)| cross(p, q)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn ellipse_outline_has_area_centre_and_outward_normals() {
        let bounds = BoundingBox::from_corner(10.0, 20.0, 40.0, 20.0).unwrap();
        let ellipse = Outline::ellipse(&bounds, 200).unwrap();
        assert_abs_diff_eq!(ellipse.area(), std::f64::consts::PI * 200.0, epsilon = 1.0);
        assert_abs_diff_eq!(ellipse.centroid()[0], 30.0, epsilon = 1e-9);
        assert_abs_diff_eq!(ellipse.centroid()[1], 30.0, epsilon = 1e-9);
        for (point, normal) in ellipse.points().iter().zip(ellipse.normals()) {
            assert!((point[0] - 30.0) * normal[0] + (point[1] - 30.0) * normal[1] > 0.0);
            assert_abs_diff_eq!(normal[0].hypot(normal[1]), 1.0, epsilon = 1e-12);
        }
        assert!(ellipse.bounding_box().iou(&bounds) > 0.999);
    }

    #[test]
    fn a_hull_spans_the_notch_and_leaves_out_the_points_inside() {
        let l_shape = [[0.0, 0.0], [10.0, 0.0], [10.0, 2.0], [2.0, 2.0], [2.0, 10.0], [0.0, 10.0]];
        let hull = Outline::from_points(l_shape.to_vec()).unwrap().convex_hull();
        assert_eq!((hull.points().len(), hull.area()), (5, 68.0));
        assert_eq!(hull.convex_hull(), hull);
    }

    #[test]
    fn resampled_outline_is_evenly_spaced_in_either_orientation() {
        let l_shape = [[0.0, 0.0], [10.0, 0.0], [10.0, 2.0], [2.0, 2.0], [2.0, 10.0], [0.0, 10.0]];
        let there = Outline::from_points(l_shape.to_vec()).unwrap();
        let back = Outline::from_points(l_shape.iter().rev().copied().collect()).unwrap();
        assert_eq!(there.area(), 36.0);
        assert_eq!(back.area(), 36.0);
        let even = there.resampled(80).unwrap();
        let gaps: Vec<f64> = edges(even.points()).map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1])).collect();
        assert!(gaps.iter().all(|gap| (gap - 0.5).abs() < 1e-9));
        assert!(there.resampled(0).is_err() && there.resampled(2).is_err());
        assert!(Outline::from_points(vec![]).is_err());
        assert!(Outline::from_points(vec![[f64::NAN, 0.0]; 3]).is_err());
    }
}
