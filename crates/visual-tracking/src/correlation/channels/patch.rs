use crate::RgbImage;
use crate::picture::rgb_pixels;

/// A piece of a picture, resampled: red, green and blue from 0 to 255.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::correlation) struct Patch {
    pub(in crate::correlation) width: usize,
    pub(in crate::correlation) height: usize,
    pub(in crate::correlation) pixels: Vec<[f32; 3]>,
}

/// Pixels of one side that are mixed into one: the first and the shares, from there on.
struct Taps {
    indices: Vec<usize>,
    shares: Vec<f32>,
    ends: Vec<usize>,
}

impl Patch {
    /// The rectangle of `extent` pixels around `center`, resampled to `width × height` with a tent as wide as a new pixel (or as an old
    /// one, if that is wider). Beyond the edge the last pixel repeats.
    pub(in crate::correlation) fn sampled(
        picture: &RgbImage,
        center: [f64; 2],
        extent: [f64; 2],
        size: (usize, usize),
    ) -> Self {
        let (width, height) = size;
        let columns = Taps::new(center[0], extent[0], width, picture.width() as usize);
        let rows = Taps::new(center[1], extent[1], height, picture.height() as usize);
        let first = rows.indices.iter().copied().min().unwrap_or(0);
        let last = rows.indices.iter().copied().max().unwrap_or(0);
        let mut narrowed = Vec::with_capacity((last + 1 - first) * width);
        for y in first..=last {
            let row = &rgb_pixels(picture)[y * picture.width() as usize..(y + 1) * picture.width() as usize];
            narrowed.extend((0..width).map(|x| columns.mixed(x, |i| row[i].map(f32::from))));
        }
        let mut pixels = vec![[0.0; 3]; width * height];
        for (y, out) in pixels.chunks_exact_mut(width).enumerate() {
            for (index, share) in rows.of(y) {
                let row = &narrowed[(index - first) * width..][..width];
                for (sum, pixel) in out.iter_mut().zip(row) {
                    for c in 0..3 {
                        sum[c] += share * pixel[c];
                    }
                }
            }
        }
        Self { width, height, pixels }
    }

    /// The square of `side` pixels in the middle, rotated: direction `angle` (rad, from the first axis to the second) becomes the first axis.
    /// The rotated square must lie inside.
    pub(in crate::correlation) fn turned(&self, angle: f64, side: usize) -> Self {
        let (sin, cos) = (libm::sin(angle) as f32, libm::cos(angle) as f32);
        let off = |i: usize| i as f32 + 0.5 - 0.5 * side as f32;
        let pixel = |i: usize| {
            let (x, y) = (off(i % side), off(i / side));
            let along = |at: f32, n: usize| (0.5 * n as f32 + at - 0.5).clamp(0.0, n as f32 - 1.001);
            self.between(along(cos * x - sin * y, self.width), along(sin * x + cos * y, self.height))
        };
        Self { width: side, height: side, pixels: (0..side * side).map(pixel).collect() }
    }

    /// The colour between four pixels.
    fn between(&self, u: f32, v: f32) -> [f32; 3] {
        let (column, row) = (u as usize, v as usize);
        let (du, dv) = (u - column as f32, v - row as f32);
        let at = |du: usize, dv: usize| self.pixels[(row + dv) * self.width + column + du];
        let (a, b, c, d) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
        std::array::from_fn(|k| {
            (a[k] * (1.0 - du) + b[k] * du) * (1.0 - dv) + (c[k] * (1.0 - du) + d[k] * du) * dv
        })
    }
}

impl Taps {
    fn new(center: f64, extent: f64, n_out: usize, n_in: usize) -> Self {
        let step = extent / n_out as f64;
        let reach = step.max(1.0);
        let (mut indices, mut shares, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..n_out {
            let at = center + ((i as f64 + 0.5) / n_out as f64 - 0.5) * extent - 0.5;
            let start = indices.len();
            let mut sum = 0.0;
            for index in (at - reach).ceil() as i64..=(at + reach).floor() as i64 {
                let share = 1.0 - (index as f64 - at).abs() / reach;
                indices.push(index.clamp(0, n_in as i64 - 1) as usize);
                shares.push(share as f32);
                sum += share;
            }
            for share in &mut shares[start..] {
                *share /= sum as f32;
            }
            ends.push(indices.len());
        }
        Self { indices, shares, ends }
    }

    fn of(&self, i: usize) -> impl Iterator<Item = (usize, f32)> {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        let range = start..self.ends[i];
        self.indices[range.clone()].iter().copied().zip(self.shares[range].iter().copied())
    }

    fn mixed(&self, i: usize, pixel: impl Fn(usize) -> [f32; 3]) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for (index, share) in self.of(i) {
            let pixel = pixel(index);
            for c in 0..3 {
                sum[c] += share * pixel[c];
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    fn ramp() -> RgbImage {
        let value = |i: usize| [(4 * (i % 20)) as u8, (5 * (i / 20)) as u8, 7];
        RgbImage::from_raw(20, 16, (0..320).flat_map(value).collect()).expect("3 bytes a pixel")
    }

    #[test]
    fn at_its_own_size_a_piece_is_the_piece() {
        let patch = Patch::sampled(&ramp(), [8.0, 7.0], [4.0, 6.0], (4, 6));
        assert_eq!(patch.pixels[0], [24.0, 20.0, 7.0]);
        assert_eq!(patch.pixels[23], [36.0, 45.0, 7.0]);
    }

    #[test]
    fn a_quarter_turn_lays_the_second_axis_along_the_first() {
        let patch = Patch::sampled(&ramp(), [10.0, 8.0], [8.0, 8.0], (8, 8));
        let turned = patch.turned(std::f64::consts::FRAC_PI_2, 4);
        let row: Vec<f32> = turned.pixels[..4].iter().map(|pixel| pixel[1]).collect();
        // rows 6 to 9 of the ramp, which grows by 5 a row
        for (value, expected) in row.iter().zip([30.0, 35.0, 40.0, 45.0]) {
            assert!(abs_diff_eq!(*value, expected, epsilon = 1e-3), "{row:?}");
        }
        assert!(turned.pixels[..4].iter().all(|pixel| (pixel[0] - turned.pixels[0][0]).abs() < 1e-3));
    }

    #[test]
    fn a_ramp_stays_a_ramp_when_resampled_and_ends_at_the_edge() {
        let patch = Patch::sampled(&ramp(), [10.0, 8.0], [10.0, 8.0], (5, 16));
        for (x, pixel) in patch.pixels[..5].iter().enumerate() {
            // pixel x covers columns 5 + 2x and 6 + 2x
            assert!(abs_diff_eq!(pixel[0], 4.0 * (5.5 + 2.0 * x as f32), epsilon = 1e-4), "{x}");
        }
        let beyond = Patch::sampled(&ramp(), [-50.0, 100.0], [4.0, 4.0], (2, 2));
        assert!(beyond.pixels.iter().all(|pixel| *pixel == [0.0, 75.0, 7.0]));
    }
}
