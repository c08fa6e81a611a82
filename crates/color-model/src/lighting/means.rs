use nalgebra::Vector3;
use wayfix_color_map::ColorId;

use super::filter::check_value;
use crate::ColorModelError;

/// Measurement of the light from one image: the mean YUV of every map colour in it, $`\bar v`$ of [Schulz & Fox 2004, Eq. 3]; colours
/// not in the image are missing.
/// ```
/// use nalgebra::Vector3;
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::ColorMeans;
/// let means = ColorMeans::new([(Some(Vector3::new(90.0, 110.0, 105.0)), 4000), (None, 0)]);
/// assert_eq!(means.seen().count(), 1);
/// assert_eq!(means.without(ColorId(0)).seen().count(), 0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColorMeans {
    colors: Vec<(Option<Vector3<f64>>, u64)>,
}

impl ColorMeans {
    /// Mean and number of pixels of each colour, in the order of the map.
    pub fn new(colors: impl IntoIterator<Item = (Option<Vector3<f64>>, u64)>) -> Self {
        Self { colors: colors.into_iter().collect() }
    }

    /// Number of colours, seen or not.
    pub fn n_colors(&self) -> usize {
        self.colors.len()
    }

    /// The mean of a colour, if it was seen.
    pub fn mean(&self, color: ColorId) -> Option<Vector3<f64>> {
        self.colors.get(color.index()).and_then(|(mean, _)| *mean)
    }

    /// Number of seen pixels of a colour.
    pub fn n_pixels(&self, color: ColorId) -> u64 {
        self.colors.get(color.index()).map_or(0, |(_, n)| *n)
    }

    /// The seen colours with their means.
    pub fn seen(&self) -> impl Iterator<Item = (ColorId, Vector3<f64>)> {
        let seen =
            |(at, (mean, _)): (usize, &(Option<Vector3<f64>>, u64))| Some((ColorId(at as u8), (*mean)?));
        self.colors.iter().enumerate().filter_map(seen)
    }

    /// The same as if `color` had not been seen.
    pub fn without(&self, color: ColorId) -> Self {
        let mut without = self.clone();
        if let Some(seen) = without.colors.get_mut(color.index()) {
            *seen = (None, 0);
        }
        without
    }

    pub(super) fn check(&self, n_colors: usize) -> Result<(), ColorModelError> {
        let (expected, got) = (n_colors, self.n_colors());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "colours of an image", expected, got });
        }
        let mut means = self.colors.iter().filter_map(|(mean, _)| *mean);
        means.try_for_each(|mean| mean.iter().try_for_each(|value| check_value("mean of a colour", *value)))
    }
}
