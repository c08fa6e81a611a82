use std::f64::consts::TAU;

use super::CustomColorSpace;

/// Three coordinates of a colour, each scaled to $`[0, 1]`$ over all 8-bit colours.
///
/// ```
/// use wayfix_visual_tracking::ColorSpace;
/// // Highlights move a colour along (1, 1, 1), to which the first two opponent axes are blind.
/// let [dull, shiny] = [[90, 40, 10], [130, 80, 50]].map(|rgb| ColorSpace::Opponent.convert(rgb));
/// assert_eq!(dull[..2], shiny[..2]);
/// // Shading scales a colour, to which hue and saturation are blind.
/// let [lit, shaded] = [[200, 100, 40], [100, 50, 20]].map(|rgb| ColorSpace::Hsi.convert(rgb));
/// assert!((lit[0] - shaded[0]).abs() < 1e-12 && (lit[1] - shaded[1]).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum ColorSpace {
    /// $`(R, G, B) / 255`$.
    Rgb,
    /// $`(R, G, B) / (R + G + B)`$; black is grey. The third follows from the first two, so one bin is enough for it.
    NormalizedRgb,
    /// Hue, saturation, intensity: $`H = \operatorname{atan2}(\sqrt 3 (G - B), 2R - G - B) / 2π`$ in $`[0, 1)`$, 0 for grey,
    /// $`S = 1 - 3 \min(R, G, B) / (R + G + B)`$, $`I = (R + G + B) / 765`$. [Gonzalez & Woods, Sec. 6.2]
    Hsi,
    /// Luma and colour differences: $`Y = 0.299 R + 0.587 G + 0.114 B`$, $`U ∝ B - Y`$, $`V ∝ R - Y`$, the last two with 0.5 for grey.
    /// [ITU-R BT.601]
    Yuv,
    /// $`(B - G, G - R, R + G + B)`$, the first two with 0.5 for grey. [Andrade-Cetto 2005, Sec. 3.2]
    #[default]
    Opponent,
    /// A space of the user's own.
    #[cfg_attr(feature = "serde", serde(skip))]
    Custom(CustomColorSpace),
}

/// Thousandths of red, green and blue in luma. [ITU-R BT.601]
const LUMA: [f64; 3] = [299.0, 587.0, 114.0];

impl ColorSpace {
    /// The spaces of this crate.
    pub const ALL: [Self; 5] = [Self::Rgb, Self::NormalizedRgb, Self::Hsi, Self::Yuv, Self::Opponent];

    /// The coordinates of an 8-bit colour.
    #[inline]
    pub fn convert(self, [r, g, b]: [u8; 3]) -> [f64; 3] {
        let [ri, gi, bi] = [i32::from(r), i32::from(g), i32::from(b)];
        match self {
            Self::Rgb => [r, g, b].map(|value| f64::from(value) / 255.0),
            Self::NormalizedRgb => match ri + gi + bi {
                0 => [1.0 / 3.0; 3],
                sum => [r, g, b].map(|value| f64::from(value) / f64::from(sum)),
            },
            Self::Hsi => {
                let sum = ri + gi + bi;
                [hue(gi - bi, 2 * ri - gi - bi), saturation(sum, ri.min(gi).min(bi)), brightness(sum)]
            }
            Self::Yuv => {
                let [red, green, blue] = [r, g, b].map(f64::from);
                // Thousandths of integers below 2^24 are exact in every order of summation.
                let luma = LUMA[0] * red + LUMA[1] * green + LUMA[2] * blue;
                let difference = |value: f64, share: f64| {
                    let range = (1e3 - share) * 255.0;
                    (1e3 * value - luma + range) / (2.0 * range)
                };
                [luma / 255e3, difference(blue, LUMA[2]), difference(red, LUMA[0])]
            }
            Self::Opponent => [signed(bi - gi), signed(gi - ri), brightness(ri + gi + bi)],
            Self::Custom(space) => (space.convert)([r, g, b]),
        }
    }

    /// Whether 0 and 1 of an axis are the same, as they are for the hue.
    pub(crate) fn is_circular(self, axis: usize) -> bool {
        match self {
            Self::Hsi => axis == 0,
            Self::Custom(space) => space.circular_axis == Some(axis),
            _ => false,
        }
    }

    /// Whether stronger light scales the coordinates of a colour from those of black.
    pub fn scales_with_light(self) -> bool {
        match self {
            Self::Rgb | Self::Yuv | Self::Opponent => true,
            Self::NormalizedRgb | Self::Hsi => false,
            Self::Custom(space) => space.scales_with_light,
        }
    }

    /// The names of the axes.
    pub fn axis_names(self) -> [&'static str; 3] {
        match self {
            Self::Rgb => ["R", "G", "B"],
            Self::NormalizedRgb => ["r", "g", "b"],
            Self::Hsi => ["H", "S", "I"],
            Self::Yuv => ["Y", "U", "V"],
            Self::Opponent => ["B − G", "G − R", "R + G + B"],
            Self::Custom(space) => space.axis_names,
        }
    }
}

/// A difference of two channels.
#[inline]
pub(super) fn signed(difference: i32) -> f64 {
    f64::from(difference + 255) / 510.0
}

/// A sum of all channels.
#[inline]
pub(super) fn brightness(sum: i32) -> f64 {
    f64::from(sum) / 765.0
}

/// The hue from $`G - B`$ and $`2R - G - B`$; the angle of the colour round the grey axis.
pub(super) fn hue(green_blue: i32, red_rest: i32) -> f64 {
    let turns = (3f64.sqrt() * f64::from(green_blue)).atan2(f64::from(red_rest)) / TAU;
    if turns < 0.0 { turns + 1.0 } else { turns }
}

#[inline]
pub(super) fn saturation(sum: i32, least: i32) -> f64 {
    if sum == 0 { 0.0 } else { f64::from(sum - 3 * least) / f64::from(sum) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    fn corners() -> impl Iterator<Item = [u8; 3]> {
        (0..8_u8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|bit| 255 * bit))
    }

    #[test]
    fn every_axis_is_filled_from_0_to_1() {
        for space in ColorSpace::ALL {
            for axis in 0..3 {
                let values = || corners().map(|rgb| space.convert(rgb)[axis]);
                let (low, high) = (values().fold(1.0, f64::min), values().fold(0.0, f64::max));
                // The last corner of the hue before a whole turn is magenta.
                let top = if space.is_circular(axis) { 5.0 / 6.0 } else { 1.0 };
                assert!(
                    low == 0.0 && abs_diff_eq!(high, top, epsilon = 1e-15),
                    "{space:?} {axis}: {low} to {high}"
                );
            }
        }
    }

    #[test]
    fn hues_of_the_pure_colours_are_sixths_of_a_turn() {
        let pure = [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];
        for (k, rgb) in pure.into_iter().enumerate() {
            let [hue, saturation, _] = ColorSpace::Hsi.convert(rgb);
            assert_abs_diff_eq!(hue, k as f64 / 6.0, epsilon = 1e-15);
            assert_eq!(saturation, 1.0);
        }
        assert_eq!(ColorSpace::Hsi.convert([0; 3]), [0.0; 3]);
    }

    #[test]
    fn grey_is_where_the_documentation_says() {
        for value in 0..=255 {
            for space in [ColorSpace::Yuv, ColorSpace::Opponent] {
                let color = space.convert([value; 3]);
                let (neutral, bright) = match space {
                    ColorSpace::Yuv => ([color[1], color[2]], color[0]),
                    _ => ([color[0], color[1]], color[2]),
                };
                assert_eq!(neutral, [0.5; 2]);
                assert_abs_diff_eq!(bright, f64::from(value) / 255.0, epsilon = 1e-15);
            }
            assert_eq!(ColorSpace::NormalizedRgb.convert([value; 3]), [1.0 / 3.0; 3]);
        }
    }
}
