use std::ops::{Add, Sub};

/// Number of channels processed together; a loop over them compiles to two vector instructions on baseline x86-64.
pub(in crate::correlation) const LANES: usize = 8;

/// The values of eight channels at one place.
pub(in crate::correlation) type Lane = [f32; LANES];

/// Complex values of eight channels at one frequency.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::correlation) struct ComplexLane {
    pub(in crate::correlation) re: Lane,
    pub(in crate::correlation) im: Lane,
}

impl ComplexLane {
    /// $`e^{iφ} z`$ for `turn` $`= [\cos φ, \sin φ]`$.
    #[inline(always)]
    pub(in crate::correlation) fn turned(self, [cos, sin]: [f32; 2]) -> Self {
        Self {
            re: lane(|c| self.re[c] * cos - self.im[c] * sin),
            im: lane(|c| self.re[c] * sin + self.im[c] * cos),
        }
    }

    /// $`-i z`$.
    #[inline(always)]
    pub(in crate::correlation) fn over_i(self) -> Self {
        Self { re: self.im, im: lane(|c| -self.re[c]) }
    }

    /// Real and imaginary part exchanged; a forward transform between two of these is a backward one.
    #[inline(always)]
    pub(in crate::correlation) fn swapped(self) -> Self {
        Self { re: self.im, im: self.re }
    }

    /// $`a z`$ for a real `a`.
    #[inline(always)]
    pub(in crate::correlation) fn scaled(self, by: f32) -> Self {
        Self { re: lane(|c| self.re[c] * by), im: lane(|c| self.im[c] * by) }
    }

    /// $`\sum_c \bar a_c b_c`$ over the eight channels, `a` being `self`.
    #[inline(always)]
    pub(in crate::correlation) fn dot(&self, other: &Self) -> [f32; 2] {
        let re = lane(|c| self.re[c] * other.re[c] + self.im[c] * other.im[c]);
        let im = lane(|c| self.re[c] * other.im[c] - self.im[c] * other.re[c]);
        [re.iter().sum(), im.iter().sum()]
    }

    /// $`\sum_c |a_c|^2`$.
    #[inline(always)]
    pub(in crate::correlation) fn energy(&self) -> f32 {
        lane(|c| self.re[c] * self.re[c] + self.im[c] * self.im[c]).iter().sum()
    }
}

impl Add for ComplexLane {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { re: lane(|c| self.re[c] + other.re[c]), im: lane(|c| self.im[c] + other.im[c]) }
    }
}

impl Sub for ComplexLane {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { re: lane(|c| self.re[c] - other.re[c]), im: lane(|c| self.im[c] - other.im[c]) }
    }
}

#[inline(always)]
pub(in crate::correlation) fn lane(value: impl Fn(usize) -> f32) -> Lane {
    std::array::from_fn(value)
}
