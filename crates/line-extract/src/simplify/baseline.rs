use std::cmp::Ordering;

use nalgebra::Vector2;

use super::exact::cross_sign;

/// Half the distance from 1 to the next double: the relative error of one rounding.
const U: f64 = f64::EPSILON / 2.0;

/// The line through two different points, as something to compare distances from.
pub(super) struct Baseline<'a> {
    a: &'a Vector2<f64>,
    b: &'a Vector2<f64>,
    d: Vector2<f64>,
    /// Error bound of [`Self::cross`] for any point of the chain.
    slack: f64,
}

impl<'a> Baseline<'a> {
    /// `extent` is the width and height of all points to test.
    pub(super) fn new(a: &'a Vector2<f64>, b: &'a Vector2<f64>, extent: &Vector2<f64>) -> Self {
        let d = b - a;
        Self { a, b, d, slack: slack(&d, extent) }
    }

    /// Twice the signed area over the line, $`(b - a) \times (p - a)`$: positive to the left.
    #[inline]
    pub(super) fn cross(&self, p: &Vector2<f64>) -> f64 {
        self.d.x * (p.y - self.a.y) - self.d.y * (p.x - self.a.x)
    }

    /// Twice the largest error of [`Self::cross`]: values that differ by more are in this order.
    #[inline]
    pub(super) fn margin(&self) -> f64 {
        2.0 * self.slack
    }

    /// Between the two points, metres.
    pub(super) fn length(&self) -> f64 {
        self.d.norm()
    }

    /// Distance to the line, metres.
    pub(super) fn distance(&self, p: &Vector2<f64>) -> f64 {
        self.cross(p).abs() / self.length()
    }

    /// No smaller than [`Self::cross`] of any point in the box from `low` to `high`, whatever its sign.
    pub(super) fn bound(&self, low: &Vector2<f64>, high: &Vector2<f64>) -> f64 {
        let corners = [*low, *high, Vector2::new(low.x, high.y), Vector2::new(high.x, low.y)];
        corners.iter().map(|corner| self.cross(corner).abs()).fold(0.0, f64::max) + self.margin()
    }

    /// Which of two points is farther from the line, exactly.
    pub(super) fn compare(&self, p: &Vector2<f64>, q: &Vector2<f64>) -> Ordering {
        let (at_p, at_q) = (self.cross(p), self.cross(q));
        let difference = at_p.abs() - at_q.abs();
        // The bound of these two is often far below that of the whole chain.
        let off = (p - self.a).abs() + (q - self.a).abs();
        if difference.abs() > slack(&self.d, &off) {
            return if difference > 0.0 { Ordering::Greater } else { Ordering::Less };
        }
        match (self.side(p), self.side(q)) {
            (Ordering::Equal, Ordering::Equal) => Ordering::Equal,
            (Ordering::Equal, _) => Ordering::Less,
            (_, Ordering::Equal) => Ordering::Greater,
            (side, other) => {
                let left = if side == other {
                    cross_sign(self.a, self.b, &[(1.0, p), (-1.0, q)])
                } else {
                    cross_sign(self.a, self.b, &[(1.0, p), (-1.0, self.a), (1.0, q), (-1.0, self.a)])
                };
                if side == Ordering::Greater { left } else { left.reverse() }
            }
        }
    }

    /// The exact sign of $`(b - a) \times (q - p)`$: whether the direction from `p` to `q` is to the left of the line.
    pub(super) fn turn(&self, p: &Vector2<f64>, q: &Vector2<f64>) -> Ordering {
        turn(self.a, self.b, p, q)
    }

    /// Whether the line points to larger x, or straight up.
    pub(super) fn is_rightward(&self) -> bool {
        (self.a.x, self.a.y) < (self.b.x, self.b.y)
    }

    fn side(&self, p: &Vector2<f64>) -> Ordering {
        self.turn(self.a, p)
    }
}

/// Rounding error bound of a cross product of `d` with a vector of a size up to `extent`.
#[inline]
fn slack(d: &Vector2<f64>, extent: &Vector2<f64>) -> f64 {
    // Three factors of (1 + U) in a product and one in the difference: 4 U; 5 U covers the extent's own rounding, too.
    5.0 * U * (d.x.abs() * extent.y + d.y.abs() * extent.x) + f64::MIN_POSITIVE
}

/// The sign of $`(b - a) \times (q - p)`$, exactly.
#[inline]
pub(super) fn turn(a: &Vector2<f64>, b: &Vector2<f64>, p: &Vector2<f64>, q: &Vector2<f64>) -> Ordering {
    let left = (b.x - a.x) * (q.y - p.y);
    let right = (b.y - a.y) * (q.x - p.x);
    let difference = left - right;
    if difference.abs() > 5.0 * U * (left.abs() + right.abs()) + f64::MIN_POSITIVE {
        return if difference > 0.0 { Ordering::Greater } else { Ordering::Less };
    }
    cross_sign(a, b, &[(1.0, q), (-1.0, p)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_on_both_sides_are_ties() {
        let (a, b) = (Vector2::new(0.1, 0.1), Vector2::new(0.7, 0.1));
        let line = Baseline::new(&a, &b, &Vector2::new(1.0, 1.0));
        let (above, below) = (Vector2::new(0.3, 0.1 + 0.0625), Vector2::new(0.2, 0.1 - 0.0625));
        // 0.1 ± 1/16 round differently, so there is no tie; the integers of the significands decide.
        let up = above.y - a.y;
        let down = a.y - below.y;
        assert_eq!(line.compare(&above, &below), up.partial_cmp(&down).unwrap()); // both differences are exact (Sterbenz)
        assert_eq!(line.compare(&above, &Vector2::new(-3.0, above.y)), Ordering::Equal);
        assert_eq!(line.compare(&a, &below), Ordering::Less);
        assert_eq!(line.compare(&below, &b), Ordering::Greater);
        assert_eq!(line.compare(&a, &b), Ordering::Equal);
    }
}
