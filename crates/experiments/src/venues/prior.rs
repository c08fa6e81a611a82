use anyhow::{Context, Result};
use nalgebra::{DVector, Matrix3, Vector3};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_model::{LightingPriors, PriorLearningParams, learn_priors};
use wayfix_gaussian_core::Gaussian;

use super::venue::Venue;

/// Index of the carpet among the colours.
pub(super) const CARPET: usize = 0;
/// Index of the ball.
pub(super) const BALL: usize = 1;

/// Prior for a new venue from other venues: colour means and pixel scatter.
pub(super) struct TrainingStatistics {
    pub(super) priors: LightingPriors,
    /// Covariance of a pixel about its image's mean, carpet and ball each their own.
    pub(super) pixels: [Matrix3<f64>; 2],
}

impl TrainingStatistics {
    /// Learned with the default parameters; every image has equal weight for the pixel scatter.
    pub(super) fn of(venues: &[&Venue]) -> Result<Self> {
        let mut covariances = [Vec::new(), Vec::new()];
        for venue in venues {
            for (all, some) in covariances.iter_mut().zip(venue.pixel_covariances()) {
                all.extend(some);
            }
        }
        let pixels = covariances.map(|list| list.iter().sum::<Matrix3<f64>>() / list.len() as f64);
        let training: Vec<_> = venues.iter().map(|venue| venue.training()).collect();
        // With one kind of light, k-means has no random choice that affects the result.
        let params = PriorLearningParams {
            pixel_color_variance: (0.5 * (pixels[CARPET] + pixels[BALL])).diagonal(),
            ..PriorLearningParams::default()
        };
        let colors = ["carpet".to_owned(), "ball".to_owned()];
        let priors = learn_priors(&colors, &training, 1, &params, &mut ChaCha8Rng::seed_from_u64(0))
            .context("nothing can be learned from the other venues")?;
        Ok(Self { priors, pixels })
    }

    /// The Gaussian over carpet and ball.
    pub(super) fn joint(&self) -> &Gaussian<DVector<f64>> {
        &self.priors.members()[0]
    }

    /// Variance of an image's mean of a colour, as a matrix.
    pub(super) fn mean_color_variance(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal(&self.priors.mean_color_variance())
    }
}

/// Mean and covariance of one colour in a Gaussian over all.
pub(super) fn block(
    mean: &DVector<f64>,
    covariance: &nalgebra::DMatrix<f64>,
    color: usize,
) -> (Vector3<f64>, Matrix3<f64>) {
    let at = 3 * color;
    (mean.fixed_rows::<3>(at).into_owned(), covariance.fixed_view::<3, 3>(at, at).into_owned())
}
