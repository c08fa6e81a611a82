/// Which standard's Y, U (Cb) and V (Cr), in which range.
///
/// $`Y = K_r R + K_g G + K_b B`$, $`U = (B - Y) / 2(1 - K_b)`$, $`V = (R - Y) / 2(1 - K_r)`$ with
/// $`(K_r, K_b)`$ = (0.299, 0.114) in [ITU-R BT.601-7] and (0.2126, 0.0722) in [ITU-R BT.709-6]. Full range spreads them over 0 to 255 with
/// U = V = 128 for grey, limited range over 16 to 235 (Y) and 16 to 240.
///
/// ```
/// use wayfix_color_model::YuvStandard;
/// assert_eq!(YuvStandard::Bt601Full.from_rgb([255, 0, 0]), [76, 85, 255]); // as JFIF has it
/// assert_eq!(YuvStandard::Bt601Limited.from_rgb([255, 255, 255]), [235, 128, 128]);
/// assert_eq!(YuvStandard::Bt709Limited.from_rgb([0, 255, 0]), [173, 42, 26]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum YuvStandard {
    /// That of JPEG files.
    #[default]
    Bt601Full,
    /// That of most cameras in YUYV.
    Bt601Limited,
    /// High definition, full range.
    Bt709Full,
    /// High definition, as broadcast.
    Bt709Limited,
}

/// Fixed-point digits of the conversion: 16 leave an error of less than 0.01 before rounding.
const SHIFT: u32 = 16;

/// A conversion in fixed point: rows of weights for R, G, B and an offset that includes the rounding.
pub(super) type Weights = [[i32; 4]; 3];

impl YuvStandard {
    /// The YUV of one pixel.
    pub fn from_rgb(self, rgb: [u8; 3]) -> [u8; 3] {
        convert(&self.weights(), rgb)
    }

    /// The RGB of one pixel, saturated where YUV leaves the cube of colours.
    pub fn to_rgb(self, [y, u, v]: [u8; 3]) -> [u8; 3] {
        let (kr, kb) = self.luma();
        let (y_offset, y_span, c_span) = self.range();
        let y = (f64::from(y) - y_offset) / y_span;
        let (u, v) = ((f64::from(u) - 128.0) / c_span, (f64::from(v) - 128.0) / c_span);
        let (r, b) = (y + 2.0 * (1.0 - kr) * v, y + 2.0 * (1.0 - kb) * u);
        let g = (y - kr * r - kb * b) / (1.0 - kr - kb);
        [r, g, b].map(|channel| (255.0 * channel).round().clamp(0.0, 255.0) as u8)
    }

    pub(super) fn weights(self) -> Weights {
        let (kr, kb) = self.luma();
        let kg = 1.0 - kr - kb;
        let (y_offset, y_span, c_span) = self.range();
        let (u, v) = (0.5 / (1.0 - kb), 0.5 / (1.0 - kr));
        let fixed = |weights: [f64; 3], span: f64, offset: f64| {
            let one = f64::from(1 << SHIFT);
            let [r, g, b] = weights.map(|weight| (weight * span / 255.0 * one).round() as i32);
            [r, g, b, ((offset + 0.5) * one) as i32]
        };
        [
            fixed([kr, kg, kb], y_span, y_offset),
            fixed([-u * kr, -u * kg, u * (1.0 - kb)], c_span, 128.0),
            fixed([v * (1.0 - kr), -v * kg, -v * kb], c_span, 128.0),
        ]
    }

    fn luma(self) -> (f64, f64) {
        match self {
            Self::Bt601Full | Self::Bt601Limited => (0.299, 0.114),
            Self::Bt709Full | Self::Bt709Limited => (0.2126, 0.0722),
        }
    }

    /// Offset and span of Y, span of U and V.
    fn range(self) -> (f64, f64, f64) {
        match self {
            Self::Bt601Full | Self::Bt709Full => (0.0, 255.0, 255.0),
            Self::Bt601Limited | Self::Bt709Limited => (16.0, 219.0, 224.0),
        }
    }
}

#[inline]
pub(super) fn convert(weights: &Weights, rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(i32::from);
    weights.map(|[wr, wg, wb, offset]| ((wr * r + wg * g + wb * b + offset) >> SHIFT).clamp(0, 255) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [YuvStandard; 4] = [
        YuvStandard::Bt601Full,
        YuvStandard::Bt601Limited,
        YuvStandard::Bt709Full,
        YuvStandard::Bt709Limited,
    ];

    /// The textbook's formula in floating point.
    fn plain(standard: YuvStandard, rgb: [u8; 3]) -> [f64; 3] {
        let [r, g, b] = rgb.map(|channel| f64::from(channel) / 255.0);
        let (kr, kb) = standard.luma();
        let y = kr * r + (1.0 - kr - kb) * g + kb * b;
        let (u, v) = (0.5 * (b - y) / (1.0 - kb), 0.5 * (r - y) / (1.0 - kr));
        let (offset, y_span, c_span) = standard.range();
        [offset + y_span * y, 128.0 + c_span * u, 128.0 + c_span * v]
    }

    #[test]
    fn fixed_point_is_the_rounded_formula() {
        for standard in ALL {
            for k in 0..(1_u32 << 24) / 97 {
                let [r, g, b, _] = (k * 97).to_le_bytes();
                let (fast, exact) = (standard.from_rgb([r, g, b]), plain(standard, [r, g, b]));
                for (fast, exact) in fast.into_iter().zip(exact) {
                    // Half a unit of rounding and a hundredth of fixed point; 255.5 saturates.
                    assert!(
                        (f64::from(fast) - exact.min(255.0)).abs() < 0.51,
                        "{standard:?} {r} {g} {b}: {fast} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn there_and_back_is_within_the_rounding() {
        // Half a unit in Y, U and V becomes at most 0.5 (1 + 2 (1 - K_b)) 255/219 and half a unit of rounding: below 3.
        for standard in ALL {
            for k in 0..(1_u32 << 24) / 1009 {
                let [r, g, b, _] = (k * 1009).to_le_bytes();
                let back = standard.to_rgb(standard.from_rgb([r, g, b]));
                assert!(
                    back.iter().zip([r, g, b]).all(|(x, y)| x.abs_diff(y) <= 3),
                    "{standard:?} {r} {g} {b}: {back:?}"
                );
            }
        }
    }
}
