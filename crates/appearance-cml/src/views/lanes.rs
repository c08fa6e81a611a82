use wide::{f32x8, i8x16, i16x16, i32x8};

/// Harmonics that are multiplied side by side.
pub(super) const HARMONICS: usize = 8;

/// What eight pairs of real and imaginary parts are multiplied with, for the real and the imaginary part of their products with a view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pairs {
    own: i16x16,
    turned: i16x16,
}

/// $`\sum_r a_r \bar b_r`$ of the eight harmonics of a group, real and imaginary parts.
///
/// Exact: whole numbers of up to 127, and sums of at most 2 · 255 of their products stay below $`2^{24}`$, in single precision too.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    re: i32x8,
    im: i32x8,
}

impl Pairs {
    /// Of one cosine of a view.
    pub(super) fn new(lanes: &[i8]) -> Self {
        let own = sixteen(lanes);
        let parts = own.to_array();
        let turned = |lane: usize| if lane.is_multiple_of(2) { parts[lane + 1] } else { -parts[lane - 1] };
        Self { own, turned: i16x16::new(std::array::from_fn(turned)) }
    }
}

impl Sums {
    /// Takes in some cosines of a view and as many of a reference.
    #[inline]
    pub(super) fn add(&mut self, own: &[Pairs], other: &[i8]) {
        for (own, other) in own.iter().zip(other.chunks_exact(2 * HARMONICS)) {
            let other = sixteen(other);
            self.re += own.own.dot(other);
            self.im += own.turned.dot(other);
        }
    }

    /// The sum of their magnitudes, but for the rounding of single precision.
    #[inline]
    pub(super) fn magnitude(&self) -> f32 {
        let (re, im) = (f32x8::from_i32x8(self.re), f32x8::from_i32x8(self.im));
        (re * re + im * im).sqrt().reduce_add()
    }

    /// Harmonic by harmonic.
    pub(super) fn harmonics(&self) -> impl Iterator<Item = (f64, f64)> {
        let parts = self.re.to_array().into_iter().zip(self.im.to_array());
        parts.map(|(re, im)| (f64::from(re), f64::from(im)))
    }
}

/// Sixteen numbers from the first on; none where there are fewer.
#[inline]
pub(super) fn sixteen(numbers: &[i8]) -> i16x16 {
    numbers.first_chunk().map_or(i16x16::ZERO, |sixteen| i16x16::from(i8x16::new(*sixteen)))
}
