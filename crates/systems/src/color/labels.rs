use wayfix_color_map::ColorId;
use wayfix_color_model::{PixelClassifier, YuvImage};
use wayfix_sensor_log::DecodedImage;

/// Number of labelled pixels of each map colour that were classified correctly.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ClassificationCounts {
    /// `(right, all)` of each colour, in the order of the map.
    pub by_color: Vec<(u64, u64)>,
}

impl ClassificationCounts {
    /// Share of all labelled pixels that were classified correctly; `None` without labelled pixels.
    pub fn rate(&self) -> Option<f64> {
        let (right, all) =
            self.by_color.iter().fold((0, 0), |sum, counts| (sum.0 + counts.0, sum.1 + counts.1));
        (all > 0).then(|| right as f64 / all as f64)
    }

    /// The same for one colour.
    pub fn rate_of(&self, color: ColorId) -> Option<f64> {
        let (right, all) = *self.by_color.get(usize::from(color.0))?;
        (all > 0).then(|| right as f64 / all as f64)
    }
}

/// Classifies every labelled pixel; background pixels do not count, as in [Schulz & Fox 2004, V.A, Table 1].
///
/// Returns `None` if labels and image differ in size.
pub fn tally(
    image: &YuvImage,
    labels: &DecodedImage,
    classifier: &PixelClassifier,
    n_colors: usize,
) -> Option<ClassificationCounts> {
    if (labels.width, labels.height) != (image.width(), image.height()) {
        return None;
    }
    let mut by_color = vec![(0, 0); n_colors];
    for (pixel, &label) in image.pixels().iter().zip(&labels.pixels) {
        let Some(truth) = label.checked_sub(1) else { continue };
        let Some(counts) = by_color.get_mut(usize::from(truth)) else { continue };
        counts.1 += 1;
        counts.0 += u64::from(classifier.classify(*pixel) == Some(ColorId(truth)));
    }
    Some(ClassificationCounts { by_color })
}

/// Mean rate of a colour over the images that show at least `min_pixels` of it.
pub fn rate_of<'a>(
    counts: impl IntoIterator<Item = &'a ClassificationCounts>,
    color: ColorId,
    min_pixels: u64,
) -> Vec<f64> {
    let shows = |counts: &&ClassificationCounts| {
        counts.by_color.get(usize::from(color.0)).is_some_and(|(_, all)| *all >= min_pixels)
    };
    counts.into_iter().filter(shows).filter_map(|counts| counts.rate_of(color)).collect()
}
