use nalgebra::{DefaultAllocator, Dim, OMatrix, RealField, allocator::Allocator};

/// A plane rotation that turns $`(a, b)`$ into $`(r, 0)`$, $`r ≥ 0`$.
///
/// Rotations rather than reflections: they keep rows of very different size apart, entry by entry, where a reflection adds a tiny
/// entry to a huge one and loses it (a sensor of 1e-5 against a prior of 1e4 in single precision).
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation<T> {
    cosine: T,
    sine: T,
}

impl<T: RealField + Copy> Rotation<T> {
    /// `None` when `b` is already zero and `a` not negative.
    pub(super) fn eliminating(a: T, b: T) -> Option<Self> {
        if b == T::zero() && a >= T::zero() {
            return None;
        }
        let r = a.hypot(b);
        Some(Self { cosine: a / r, sine: b / r })
    }

    /// Applies itself to two entries.
    pub(super) fn turn(self, a: &mut T, b: &mut T) {
        let (old_a, old_b) = (*a, *b);
        *a = self.cosine * old_a + self.sine * old_b;
        *b = self.cosine * old_b - self.sine * old_a;
    }
}

/// Turns column `j` of `left` against column `k` of `right`, from row `first_row` down.
pub(super) fn turn_columns<T, R, C, K>(
    rotation: Rotation<T>,
    first_row: usize,
    (left, j): (&mut OMatrix<T, R, C>, usize),
    (right, k): (&mut OMatrix<T, R, K>, usize),
) where
    T: RealField + Copy,
    R: Dim,
    C: Dim,
    K: Dim,
    DefaultAllocator: Allocator<R, C> + Allocator<R, K>,
{
    for row in first_row..left.nrows() {
        let (mut a, mut b) = (left[(row, j)], right[(row, k)]);
        rotation.turn(&mut a, &mut b);
        left[(row, j)] = a;
        right[(row, k)] = b;
    }
}

/// Lower triangular $`L`$ with $`L L^T = A A^T + B B^T`$: the triangle of the array $`[A\; B]`$, diagonal not negative.
pub(super) fn triangle_of_sum<T, D>(mut a: OMatrix<T, D, D>, mut b: OMatrix<T, D, D>) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    a = triangle(a);
    for row in 0..a.nrows() {
        for k in 0..a.nrows() {
            if let Some(rotation) = Rotation::eliminating(a[(row, row)], b[(row, k)]) {
                turn_columns(rotation, row, (&mut a, row), (&mut b, k));
            }
        }
    }
    a
}

/// Lower triangular $`L`$ with $`L L^T = A A^T`$, diagonal not negative.
pub(super) fn triangle<T, D>(mut a: OMatrix<T, D, D>) -> OMatrix<T, D, D>
where
    T: RealField + Copy,
    D: Dim,
    DefaultAllocator: Allocator<D, D>,
{
    for row in 0..a.nrows() {
        for column in row + 1..a.nrows() {
            if let Some(rotation) = Rotation::eliminating(a[(row, row)], a[(row, column)]) {
                for below in row..a.nrows() {
                    let (mut x, mut y) = (a[(below, row)], a[(below, column)]);
                    rotation.turn(&mut x, &mut y);
                    a[(below, row)] = x;
                    a[(below, column)] = y;
                }
            }
            a[(row, column)] = T::zero();
        }
        if a[(row, row)] < T::zero() {
            a.column_mut(row).neg_mut();
        }
    }
    a
}
