use std::hash::{Hash, Hasher};

/// A colour space of the user's own, as [`ColorSpace::Custom`](crate::ColorSpace::Custom). Two spaces with the same axis names are equal.
///
/// ```
/// use wayfix_visual_tracking::{ColorQuantizer, ColorSpace, CustomColorSpace};
/// const RED_SHARE: CustomColorSpace = CustomColorSpace {
///     axis_names: ["R / (R + G + B)", "unused", "R + G + B"],
///     convert: |rgb| {
///         let [r, g, b] = rgb.map(f64::from);
///         [r / (r + g + b).max(1.0), 0.0, (r + g + b) / 765.0]
///     },
///     circular_axis: None,
///     scales_with_light: false,
/// };
/// let quantizer = ColorQuantizer::new(ColorSpace::Custom(RED_SHARE), [8, 1, 4])?;
/// assert_eq!(quantizer.bin_of_pixel([200, 0, 0]), quantizer.bin_of_pixel([255, 0, 0]));
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CustomColorSpace {
    /// The names of the axes.
    pub axis_names: [&'static str; 3],
    /// The coordinates of an 8-bit colour, each scaled to [0, 1].
    pub convert: fn([u8; 3]) -> [f64; 3],
    /// The axis whose 0 and 1 are the same, if there is one.
    pub circular_axis: Option<usize>,
    /// Whether stronger light scales the coordinates from those of black.
    pub scales_with_light: bool,
}

impl PartialEq for CustomColorSpace {
    fn eq(&self, other: &Self) -> bool {
        self.axis_names == other.axis_names
    }
}

impl Eq for CustomColorSpace {}

impl Hash for CustomColorSpace {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.axis_names.hash(state);
    }
}
