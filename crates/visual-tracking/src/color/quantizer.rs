use super::space::{ColorSpace, brightness, hue, saturation, signed};
use crate::TrackingError;
use crate::error::checked;

/// Divides a colour space into bins: every axis into equal parts, bin $`\lfloor x n \rfloor`$ of $`n`$, the upper end in the last one.
///
/// Both bounds of [Andrade-Cetto 2005, Sec. 3.3] cannot hold at once; this is the one by which they segment.
///
/// ```
/// use wayfix_visual_tracking::{ColorQuantizer, ColorSpace};
/// let quantizer = ColorQuantizer::new(ColorSpace::Rgb, [8, 8, 4])?;
/// assert_eq!(quantizer.n_bins(), 256);
/// assert_eq!(quantizer.bin_of_pixel([255, 0, 128]), 7 * 32 + 2);
/// assert_eq!(quantizer.bin_of_point([1.7, -0.2, 0.5]), Some(7 * 32 + 2));
/// assert_eq!(quantizer.bin_of_point([f64::NAN, 0.0, 0.0]), None);
/// assert!(ColorQuantizer::new(ColorSpace::Rgb, [64, 64, 32]).is_err());
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ColorQuantizer {
    space: ColorSpace,
    axes: [Axis; 3],
    tables: Tables,
}

/// Map of a coordinate to a part of an index, in 32 bits, because conversion to 64 takes several instructions.
#[derive(Clone, Copy, Debug)]
struct Axis {
    n: f64,
    last: u32,
    stride: u32,
}

/// Tables for axes that are functions of one small whole number: one or two cache lines per pixel instead of divisions.
#[derive(Clone, Debug)]
enum Tables {
    /// Of $`R`$, $`G`$ and $`B`$.
    Rgb(Box<[[u16; 256]; 3]>),
    /// Of $`B - G`$, $`G - R`$ and $`R + G + B`$.
    Opponent(Box<([u16; 512], [u16; 512], [u16; 1024])>),
    /// Of the hue by $`G - B`$ and $`2R - G - B`$, and of $`R + G + B`$; a megabyte, filled in some 10 ms, of which a picture
    /// touches little.
    Hsi(Box<[u16]>),
    None,
}

/// Entries in a row of the table of hues: $`2R - G - B`$ from -510 to 510.
const HUE_ROW: usize = 1021;

impl ColorQuantizer {
    /// Creates a quantizer with these numbers of bins per axis.
    /// # Errors
    /// Returns [`TrackingError::Parameter`] if an axis has no bin, or all together are more than 65536.
    pub fn new(space: ColorSpace, bins: [usize; 3]) -> Result<Self, TrackingError> {
        for n in bins {
            checked("bins of an axis", n as f64, (1..=65536).contains(&n), "between 1 and 65536")?;
        }
        let n_bins = bins.iter().product::<usize>();
        checked("bins of a colour space", n_bins as f64, n_bins <= 65536, "at most 65536")?;
        let axis = |axis: usize| Axis {
            n: bins[axis] as f64,
            last: bins[axis] as u32 - 1,
            stride: bins[axis + 1..].iter().product::<usize>() as u32,
        };
        let mut quantizer = Self { space, axes: [0, 1, 2].map(axis), tables: Tables::None };
        quantizer.tables = quantizer.tables();
        Ok(quantizer)
    }

    /// The space that is divided.
    pub fn space(&self) -> ColorSpace {
        self.space
    }

    /// Bins of each axis.
    pub fn bins(&self) -> [usize; 3] {
        self.axes.map(|axis| axis.last as usize + 1)
    }

    /// Bins of all axes together.
    pub fn n_bins(&self) -> usize {
        self.bins().iter().product()
    }

    /// The bin of an 8-bit colour, that of its point in the space.
    pub fn bin_of_pixel(&self, rgb: [u8; 3]) -> u16 {
        let mut bin = [0];
        self.bins_of_pixels(&[rgb], &mut bin);
        bin[0]
    }

    /// The bin of a point. Coordinates are clamped to $`[0, 1]`$, the hue wraps around; `None` for NaN or an infinite hue.
    pub fn bin_of_point(&self, point: [f64; 3]) -> Option<u16> {
        let mut bin = 0;
        for (axis, x) in point.into_iter().enumerate() {
            let x = if self.space.is_circular(axis) { x.rem_euclid(1.0) } else { x };
            if x.is_nan() {
                return None;
            }
            bin += self.offset(axis, x);
        }
        Some(bin)
    }

    /// The place of a bin on each axis.
    pub(crate) fn axes_of_bin(&self, bin: u16) -> [usize; 3] {
        self.axes.map(|Axis { last, stride, .. }| (u32::from(bin) / stride % (last + 1)) as usize)
    }

    /// The point in the middle of a bin.
    pub(crate) fn center_of_bin(&self, bin: u16) -> [f64; 3] {
        let axes = self.axes_of_bin(bin);
        [0, 1, 2].map(|axis| (axes[axis] as f64 + 0.5) / self.axes[axis].n)
    }

    /// The bins of many pixels; `bins` and `pixels` have equal length.
    pub(super) fn bins_of_pixels(&self, pixels: &[[u8; 3]], bins: &mut [u16]) {
        match &self.tables {
            Tables::Rgb(tables) => fill(pixels, bins, |rgb| {
                (0..3).map(|channel| tables[channel][usize::from(rgb[channel])]).sum()
            }),
            Tables::Opponent(tables) => fill(pixels, bins, |rgb| {
                let [r, g, b] = rgb.map(usize::from);
                // The masks cost nothing and prove to the compiler that every index is in bounds.
                tables.0[(255 + b - g) & 511] + tables.1[(255 + g - r) & 511] + tables.2[(r + g + b) & 1023]
            }),
            Tables::Hsi(hues) => fill(pixels, bins, |rgb| {
                let [r, g, b] = rgb.map(i32::from);
                let (sum, least) = (r + g + b, r.min(g).min(b));
                hues[hue_index(g - b, 2 * r - g - b)]
                    + self.offset(1, saturation(sum, least))
                    + self.offset(2, brightness(sum))
            }),
            Tables::None => fill(pixels, bins, |rgb| {
                let point = self.space.convert(rgb);
                self.offset(0, point[0]) + self.offset(1, point[1]) + self.offset(2, point[2])
            }),
        }
    }

    /// Contribution of a coordinate to the bin index. The integer conversion saturates, which clamps to the range.
    #[inline]
    fn offset(&self, axis: usize, x: f64) -> u16 {
        let Axis { n, last, stride } = self.axes[axis];
        (((x * n) as u32).min(last) * stride) as u16
    }

    fn tables(&self) -> Tables {
        match self.space {
            ColorSpace::Rgb => Tables::Rgb(Box::new(std::array::from_fn(|axis| {
                std::array::from_fn(|value| self.offset(axis, value as f64 / 255.0))
            }))),
            ColorSpace::Opponent => {
                let difference = |axis| std::array::from_fn(|k| self.offset(axis, signed(k as i32 - 255)));
                let sum = std::array::from_fn(|k| self.offset(2, brightness(k as i32)));
                Tables::Opponent(Box::new((difference(0), difference(1), sum)))
            }
            ColorSpace::Hsi => {
                let row =
                    |green_blue| (-510..=510).map(move |red_rest| self.offset(0, hue(green_blue, red_rest)));
                Tables::Hsi((-255..=255).flat_map(row).collect())
            }
            ColorSpace::NormalizedRgb | ColorSpace::Yuv | ColorSpace::Custom(_) => Tables::None,
        }
    }
}

/// Two quantizers are equal if they divide the same space equally; the tables follow from that.
impl PartialEq for ColorQuantizer {
    fn eq(&self, other: &Self) -> bool {
        self.space == other.space && self.bins() == other.bins()
    }
}

impl Eq for ColorQuantizer {}

fn hue_index(green_blue: i32, red_rest: i32) -> usize {
    (green_blue + 255) as usize * HUE_ROW + (red_rest + 510) as usize
}

#[inline]
fn fill(pixels: &[[u8; 3]], bins: &mut [u16], bin: impl Fn([u8; 3]) -> u16) {
    for (slot, &pixel) in bins.iter_mut().zip(pixels) {
        *slot = bin(pixel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bin_of_a_pixel_is_the_bin_of_its_point() {
        for space in ColorSpace::ALL {
            for bins in [[1, 1, 1], [16, 16, 16], [32, 32, 8], [7, 30, 51], [255, 1, 256], [1, 65536, 1]] {
                let quantizer = ColorQuantizer::new(space, bins).unwrap();
                // Steps of a prime meet all residues, and every channel takes all its values.
                for code in (0..1_u32 << 24).step_by(1009) {
                    let [r, g, b, _] = code.to_le_bytes();
                    let point = space.convert([r, g, b]);
                    assert_eq!(
                        Some(quantizer.bin_of_pixel([r, g, b])),
                        quantizer.bin_of_point(point),
                        "{space:?} {bins:?} {r} {g} {b}"
                    );
                }
            }
        }
    }

    #[test]
    fn centers_and_axes_belong_to_their_bin() {
        let quantizer = ColorQuantizer::new(ColorSpace::Yuv, [5, 11, 3]).unwrap();
        for bin in 0..quantizer.n_bins() as u16 {
            assert_eq!(quantizer.bin_of_point(quantizer.center_of_bin(bin)), Some(bin));
            let [i, j, k] = quantizer.axes_of_bin(bin);
            assert_eq!((i * 11 + j) * 3 + k, usize::from(bin));
        }
    }

    #[test]
    fn hues_turn_where_other_coordinates_saturate() {
        let quantizer = ColorQuantizer::new(ColorSpace::Hsi, [10, 10, 10]).unwrap();
        assert_eq!(quantizer.bin_of_point([1.05, 7.0, -7.0]), Some(90));
        assert_eq!(quantizer.bin_of_point([-0.05, 0.0, 0.0]), Some(900));
        assert_eq!(quantizer.bin_of_point([f64::INFINITY, 0.0, 0.0]), None);
        let rgb = ColorQuantizer::new(ColorSpace::Rgb, [10, 10, 10]).unwrap();
        assert_eq!(rgb.bin_of_point([f64::INFINITY, f64::NEG_INFINITY, 0.0]), Some(900));
    }

    #[test]
    fn bins_that_cannot_be_numbered_are_refused() {
        for bins in [[0, 8, 8], [8, 8, 0], [65537, 1, 1], [256, 256, 2], [usize::MAX, usize::MAX, 3]] {
            let refused = ColorQuantizer::new(ColorSpace::Opponent, bins);
            assert!(matches!(refused, Err(TrackingError::Parameter { .. })), "{bins:?}");
        }
    }
}
