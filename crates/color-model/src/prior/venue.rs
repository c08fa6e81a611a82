use nalgebra::Vector3;

use super::LightingPriorError;
use crate::ColorMeans;

/// One environment under one light: the mean colours of each image of it, labels being known. $`\bar t_{1:k}`$ of [Schulz & Fox 2004, III.B]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrainingVenue {
    /// Name for messages.
    pub name: String,
    /// An entry per image.
    pub images: Vec<ColorMeans>,
    /// Scatter of pixels about the mean of their colour in their image, if recorded.
    pub pixels: Option<PooledPixelVariance>,
}

/// Variance of the pixels of one colour in one image, pooled over colours and images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PooledPixelVariance {
    /// Of Y, U and V.
    pub variances: Vector3<f64>,
    /// Number of pixels minus number of means.
    pub degrees_of_freedom: f64,
}

impl TrainingVenue {
    /// The mean Y of each colour over the images that show it.
    pub(super) fn brightness(&self, n_colors: usize) -> Vec<Option<f64>> {
        let mut sums = vec![(0.0, 0_u32); n_colors];
        for (color, mean) in self.images.iter().flat_map(ColorMeans::seen) {
            let sum = &mut sums[usize::from(color.0)];
            *sum = (sum.0 + mean.x, sum.1 + 1);
        }
        sums.into_iter().map(|(sum, n)| (n > 0).then(|| sum / f64::from(n))).collect()
    }

    pub(super) fn check(&self, n_colors: usize) -> Result<(), LightingPriorError> {
        for image in &self.images {
            if image.n_colors() != n_colors {
                let what = "colours of a training image";
                return Err(LightingPriorError::Dimension {
                    what,
                    expected: n_colors,
                    got: image.n_colors(),
                });
            }
            let bad =
                image.seen().flat_map(|(_, mean)| [mean.x, mean.y, mean.z]).find(|value| !value.is_finite());
            if let Some(value) = bad {
                return Err(LightingPriorError::OutOfRange { what: "mean of a colour", value });
            }
        }
        if self.images.iter().all(|image| image.seen().next().is_none()) {
            return Err(LightingPriorError::Blank { name: self.name.clone() });
        }
        if let Some(PooledPixelVariance { variances, degrees_of_freedom }) = &self.pixels {
            let numbers = variances.iter().chain([degrees_of_freedom]);
            if let Some(&value) = numbers.clone().find(|value| !(**value >= 0.0 && value.is_finite())) {
                return Err(LightingPriorError::OutOfRange { what: "spread of pixels", value });
            }
        }
        Ok(())
    }
}
