//! Signs that no rounding can turn.

use std::cmp::Ordering;

use nalgebra::Vector2;

/// The sign of $`(b - a) \times \sum_k c_k w_k`$, exact unless a product of coordinates under- or overflows.
///
/// Two stages [Shewchuk 1997]: where all sums are free of rounding (grids, integers) two products and their tails decide; otherwise
/// all products are added up as an expansion.
pub(super) fn cross_sign(a: &Vector2<f64>, b: &Vector2<f64>, w: &[(f64, &Vector2<f64>)]) -> Ordering {
    if let Some(sign) = sign_on_a_grid(a, b, w) {
        return sign;
    }
    let mut sum = Expansion::default();
    for (c, p) in w {
        sum.add_product(b.x, c * p.y);
        sum.add_product(-a.x, c * p.y);
        sum.add_product(-b.y, c * p.x);
        sum.add_product(a.y, c * p.x);
    }
    sum.sign()
}

fn sign_on_a_grid(a: &Vector2<f64>, b: &Vector2<f64>, w: &[(f64, &Vector2<f64>)]) -> Option<Ordering> {
    let dx = exact_sum([b.x, -a.x])?;
    let dy = exact_sum([b.y, -a.y])?;
    let wx = exact_sum(w.iter().map(|(c, p)| c * p.x))?;
    let wy = exact_sum(w.iter().map(|(c, p)| c * p.y))?;
    let (left, left_tail) = two_product(dx, wy);
    let (right, right_tail) = two_product(dy, wx);
    // Rounding is monotone, so only equal products need their tails.
    Some(order(left, right).then(order(left_tail, right_tail)))
}

/// The sum, if no addition was rounded.
fn exact_sum(terms: impl IntoIterator<Item = f64>) -> Option<f64> {
    terms.into_iter().try_fold(0.0, |sum, term| {
        let (sum, tail) = two_sum(sum, term);
        (tail == 0.0).then_some(sum)
    })
}

/// A number as a sum of doubles that do not overlap, smallest first, without zeros.
#[derive(Default)]
struct Expansion {
    parts: [f64; 2 * MAX_PRODUCTS],
    len: usize,
}

/// Four products for each of at most four points.
const MAX_PRODUCTS: usize = 16;

impl Expansion {
    fn add_product(&mut self, a: f64, b: f64) {
        let (product, tail) = two_product(a, b);
        self.add(tail);
        self.add(product);
    }

    fn add(&mut self, term: f64) {
        let (mut carry, mut kept) = (term, 0);
        for at in 0..self.len {
            let (sum, tail) = two_sum(carry, self.parts[at]);
            carry = sum;
            if tail != 0.0 {
                self.parts[kept] = tail;
                kept += 1;
            }
        }
        if carry != 0.0 {
            self.parts[kept] = carry;
            kept += 1;
        }
        self.len = kept;
    }

    fn sign(&self) -> Ordering {
        order(self.parts[..self.len].last().copied().unwrap_or(0.0), 0.0)
    }
}

/// `a + b` rounded, and the rounding error [Knuth 1969].
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_virtual = sum - a;
    (sum, (a - (sum - b_virtual)) + (b - b_virtual))
}

/// `a b` rounded, and the rounding error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

/// Finite numbers only.
fn order(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coordinates in units of 2^-60 as integers, where arithmetic is exact without our help.
    fn reference(a: [i128; 2], b: [i128; 2], p: [i128; 2], q: [i128; 2]) -> Ordering {
        ((b[0] - a[0]) * (p[1] - q[1]) - (b[1] - a[1]) * (p[0] - q[0])).cmp(&0)
    }

    #[test]
    fn near_ties_are_decided_as_integers_decide_them() {
        let unit = 2f64.powi(-60);
        let point = |v: [i128; 2]| Vector2::new(v[0] as f64 * unit, v[1] as f64 * unit);
        // Large coordinates that are doubles, with differences that are not.
        let big = 1_i128 << 52;
        let (mut seen, mut state) = ([0; 3], 1_i128);
        let mut small = || {
            state = (state * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407) % (1 << 63);
            (state >> 40) % 7 - 3
        };
        for _ in 0..20_000 {
            let a = [small(), small()];
            let b = [big + small(), big + small()];
            let p = [big / 2 + small(), big / 2 + small()];
            let q = [small() * (big / 8), 0].map(|v| v + small());
            let q = [q[0], q[0] + small()];
            let sign = cross_sign(&point(a), &point(b), &[(1.0, &point(p)), (-1.0, &point(q))]);
            let expected = reference(a, b, p, q);
            assert_eq!(sign, expected, "{a:?} {b:?} {p:?} {q:?}");
            seen[(expected as i8 + 1) as usize] += 1;
        }
        assert!(seen.iter().all(|n| *n > 100), "the cases must meet all three signs: {seen:?}");
    }

    #[test]
    fn four_points_with_coordinates_of_very_different_size() {
        let (a, b) = (Vector2::new(1e10, 1.0), Vector2::new(-1e-10, 3.0));
        let p = Vector2::new(0.1, 0.2);
        let terms = [(1.0, &p), (1.0, &p), (-2.0, &p)];
        assert_eq!(cross_sign(&a, &b, &terms), Ordering::Equal);
        let nudged = Vector2::new(0.1, 0.2_f64.next_up());
        let terms = [(1.0, &nudged), (1.0, &p), (-2.0, &p)];
        assert_eq!(cross_sign(&a, &b, &terms), Ordering::Less); // b - a points to negative x
    }
}
