use wide::{f32x4, i16x8, i32x4};

/// Harmonics that are multiplied side by side.
pub(super) const HARMONICS: usize = 8;

/// What eight pairs of real and imaginary parts are multiplied with, for the real and the imaginary part of their products with a view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pairs {
    own: [i16x8; 2],
    turned: [i16x8; 2],
}

/// $`\sum_r a_r \bar b_r`$ of the eight harmonics of a group, real and imaginary parts.
///
/// Exact: whole numbers of up to 127, and sums of at most 2 · 255 of their products stay below $`2^{24}`$, in single precision too.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    re: [i32x4; 2],
    im: [i32x4; 2],
}

impl Pairs {
    /// Of one cosine of a view.
    pub(super) fn new(lanes: &[i8]) -> Self {
        let turned = |half: &i16x8| {
            let own = half.to_array();
            let lane = |lane: usize| if lane.is_multiple_of(2) { own[lane + 1] } else { -own[lane - 1] };
            i16x8::new(std::array::from_fn(lane))
        };
        let own = [eight(lanes), eight(&lanes[HARMONICS..])];
        Self { own, turned: [turned(&own[0]), turned(&own[1])] }
    }
}

impl Sums {
    /// Takes in some cosines of a view and as many of a reference.
    #[inline]
    pub(super) fn add(&mut self, own: &[Pairs], other: &[i8]) {
        for (own, other) in own.iter().zip(other.chunks_exact(2 * HARMONICS)) {
            let halves = [eight(other), eight(&other[HARMONICS..])];
            for (half, other) in halves.into_iter().enumerate() {
                self.re[half] += own.own[half].dot(other);
                self.im[half] += own.turned[half].dot(other);
            }
        }
    }

    /// The sum of their magnitudes, but for the rounding of single precision.
    #[inline]
    pub(super) fn magnitude(&self) -> f32 {
        let of = |half: usize| {
            let (re, im) = (f32x4::from_i32x4(self.re[half]), f32x4::from_i32x4(self.im[half]));
            (re * re + im * im).sqrt()
        };
        (of(0) + of(1)).reduce_add()
    }

    /// Harmonic by harmonic.
    pub(super) fn harmonics(&self) -> impl Iterator<Item = (f64, f64)> {
        let parts = |part: &[i32x4; 2]| part.map(|half| half.to_array()).concat();
        parts(&self.re).into_iter().zip(parts(&self.im)).map(|(re, im)| (f64::from(re), f64::from(im)))
    }
}

/// Eight numbers from the first on.
#[inline]
pub(super) fn eight(numbers: &[i8]) -> i16x8 {
    match numbers.first_chunk::<8>() {
        Some(eight) => i16x8::new(eight.map(i16::from)),
        None => i16x8::ZERO,
    }
}
