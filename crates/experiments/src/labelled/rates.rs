use anyhow::Result;
use wayfix_color_map::ColorId;
use wayfix_color_model::{ColorDensity, PixelClassifier};
use wayfix_systems::color::ClassificationCounts;

use super::{known_pose::AdaptedLight, place::Place};

/// Classifies the labelled pixels of a place by the densities of one light, or of several after each other: the most probable colour in any of them.
pub(super) fn count(
    place: &Place,
    lights: &[&[ColorDensity]],
    n_colors: usize,
) -> Result<ClassificationCounts> {
    let classifier = PixelClassifier::new(lights.iter().copied().flatten().copied())?;
    let mut by_color = vec![(0, 0); n_colors];
    for (pixel, label) in place.image.pixels().iter().zip(&place.labels) {
        let Some(truth) = usize::from(*label).checked_sub(1) else { continue };
        let color = classifier.classify(*pixel).map(|ColorId(color)| usize::from(color) % n_colors);
        by_color[truth].1 += 1;
        by_color[truth].0 += u64::from(color == Some(truth));
    }
    Ok(ClassificationCounts { by_color })
}

impl AdaptedLight {
    /// The lights that the image shows.
    pub(super) fn lights(&self) -> Vec<&[ColorDensity]> {
        std::iter::once(self.sun.as_slice()).chain(self.shade.as_deref()).collect()
    }
}
