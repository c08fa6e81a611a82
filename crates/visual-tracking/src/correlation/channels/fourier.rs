use std::f64::consts::TAU;

use super::lane::{ComplexLane, lane};

/// The discrete Fourier transform of one length $`2^a 3^b`$, of eight channels at once: Stockham's form with radices 4, 3 and 2, which needs no
/// reordering. It gives equal bits on every machine because nothing is chosen at run time.
#[derive(Clone, Debug)]
pub(in crate::correlation) struct Fourier {
    stages: Vec<Stage>,
    len: usize,
}

/// Joins `radix` transforms of length `done` into one of length `done · radix`.
#[derive(Clone, Debug)]
struct Stage {
    radix: usize,
    done: usize,
    /// $`e^{-2πi k s / (\text{done} · \text{radix})}`$ at `k · radix + s`.
    turns: Vec<[f32; 2]>,
}

impl Fourier {
    /// Of length `len`, which has no prime factors but 2 and 3.
    pub(in crate::correlation) fn new(len: usize) -> Self {
        let (mut done, mut stages) = (1, Vec::new());
        while done < len {
            let radix = [4, 3, 2].into_iter().find(|radix| (len / done).is_multiple_of(*radix));
            let radix = radix.expect("invariant: the length has no prime factors but 2 and 3");
            let turn = |i: usize| {
                let angle = -TAU * ((i / radix) * (i % radix)) as f64 / (done * radix) as f64;
                [libm::cos(angle) as f32, libm::sin(angle) as f32]
            };
            stages.push(Stage { radix, done, turns: (0..done * radix).map(turn).collect() });
            done *= radix;
        }
        Self { stages, len }
    }

    /// $`X_k = \sum_j x_j e^{-2πi jk/n}`$ in place; `scratch` and `data` have equal length.
    pub(in crate::correlation) fn forward(&self, data: &mut [ComplexLane], scratch: &mut [ComplexLane]) {
        let (data, scratch) = (&mut data[..self.len], &mut scratch[..self.len]);
        for (i, stage) in self.stages.iter().enumerate() {
            if i % 2 == 0 { stage.join(data, scratch) } else { stage.join(scratch, data) }
        }
        if self.stages.len() % 2 == 1 {
            data.copy_from_slice(scratch);
        }
    }
}

impl Stage {
    fn join(&self, from: &[ComplexLane], to: &mut [ComplexLane]) {
        let Self { radix, done, .. } = *self;
        let n_left = from.len() / (done * radix);
        for j in 0..n_left {
            for k in 0..done {
                let first = self.part(from, j, k, 0);
                let at = j * done * radix + k;
                match radix {
                    4 => {
                        let a = self.part(from, j + n_left, k, 1);
                        let b = self.part(from, j + 2 * n_left, k, 2);
                        let c = self.part(from, j + 3 * n_left, k, 3);
                        let (even, odd) = (first + b, first - b);
                        let (sum, difference) = (a + c, (a - c).over_i());
                        to[at] = even + sum;
                        to[at + done] = odd + difference;
                        to[at + 2 * done] = even - sum;
                        to[at + 3 * done] = odd - difference;
                    }
                    3 => {
                        let a = self.part(from, j + n_left, k, 1);
                        let b = self.part(from, j + 2 * n_left, k, 2);
                        let sum = a + b;
                        let middle = ComplexLane {
                            re: lane(|c| first.re[c] - 0.5 * sum.re[c]),
                            im: lane(|c| first.im[c] - 0.5 * sum.im[c]),
                        };
                        let difference = (a - b).over_i().scaled(HALF_SQRT_3);
                        to[at] = first + sum;
                        to[at + done] = middle + difference;
                        to[at + 2 * done] = middle - difference;
                    }
                    _ => {
                        let a = self.part(from, j + n_left, k, 1);
                        to[at] = first + a;
                        to[at + done] = first - a;
                    }
                }
            }
        }
    }

    /// Frequency `k` of the `s`-th transform to combine, with index `j`; frequency 0 needs no rotation.
    #[inline(always)]
    fn part(&self, from: &[ComplexLane], j: usize, k: usize, s: usize) -> ComplexLane {
        let value = from[j * self.done + k];
        if k == 0 || s == 0 { value } else { value.turned(self.turns[k * self.radix + s]) }
    }
}

/// $`\sin(π/3)`$.
const HALF_SQRT_3: f32 = 0.866_025_4;

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    #[test]
    fn agrees_with_the_sum_of_the_definition() {
        for len in [1, 2, 3, 4, 6, 8, 12, 17_usize.next_power_of_two(), 48, 64] {
            let value = |j: usize, c: usize| ((j * 37 + c * 11) % 23) as f32 - 9.0;
            let input: Vec<_> = (0..len)
                .map(|j| ComplexLane { re: lane(|c| value(j, c)), im: lane(|c| value(j + 5, c + 3)) })
                .collect();
            let (mut data, mut scratch) = (input.clone(), input.clone());
            Fourier::new(len).forward(&mut data, &mut scratch);
            for (k, got) in data.iter().enumerate() {
                for c in 0..8 {
                    let (mut re, mut im) = (0.0, 0.0);
                    for (j, x) in input.iter().enumerate() {
                        let (sin, cos) = (-TAU * ((j * k) % len) as f64 / len as f64).sin_cos();
                        let (a, b) = (f64::from(x.re[c]), f64::from(x.im[c]));
                        re += a * cos - b * sin;
                        im += a * sin + b * cos;
                    }
                    // f32 rounding of sums of up to 64 numbers below 14
                    assert!(abs_diff_eq!(f64::from(got.re[c]), re, epsilon = 1e-3), "{len} {k}");
                    assert!(abs_diff_eq!(f64::from(got.im[c]), im, epsilon = 1e-3), "{len} {k}");
                }
            }
        }
    }
}
