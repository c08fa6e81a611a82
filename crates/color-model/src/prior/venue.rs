use nalgebra::Vector3;

use super::LightingPriorError;
use crate::ColorMeans;

/// One environment under one light: the mean colours of each image of it, labels being known. $`\bar t_{1:k}`$ of [Schulz & Fox 2004, III.B]
/// ```
/// use wayfix_color_model::{ColorMeans, PriorLearningParams, TrainingVenue, learn_grouped_priors};
/// let unseen = ColorMeans::new([(None, 0)]);
/// let lab = TrainingVenue { name: "lab".into(), images: vec![unseen.clone(), unseen], pixels: None };
/// let error = learn_grouped_priors(&["green".into()], &[lab], &[0], &PriorLearningParams::default()).unwrap_err();
/// assert_eq!(error.to_string(), "no image of the venue lab shows a colour");
/// ```
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
/// ```
/// use nalgebra::Vector3;
/// use wayfix_color_model::{LabelledPixels, TrainingVenue};
/// let mut image = LabelledPixels::new(1);
/// [10.0, 14.0].iter().for_each(|y| image.add(1, &Vector3::new(*y, 128.0, 128.0)));
/// let pooled = TrainingVenue::from_labelled_pixels("lab", &[image.clone(), image], 2).pixels.unwrap();
/// assert_eq!(pooled.degrees_of_freedom, 2.0); // four pixels and two means
/// assert_eq!(pooled.variances.x, 8.0); // 4 · 2² / 2
/// ```
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
