use nalgebra::{DMatrix, Vector3};
use wayfix_gaussian_core::{HierarchicalGaussianParams, InverseWishart};

use super::{
    LightingPriorError,
    error::{check_correlation, check_positive},
};

/// Parameters of learning priors.
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_color_model::{ColorMeans, LightingPriorError, PriorLearningParams, TrainingVenue, learn_grouped_priors};
/// let images = |y| vec![ColorMeans::new([(Some(Vector3::new(y, 110.0, 100.0)), 500)])];
/// let venue = |y| TrainingVenue { images: images(y), ..TrainingVenue::default() };
/// let learn = |params: &_| learn_grouped_priors(&["green".into()], &[venue(60.0), venue(90.0)], &[0, 0], params);
/// let params = PriorLearningParams::default();
/// assert_eq!(learn(&params), Err(LightingPriorError::UnknownScatter)); // one image per venue
/// let given = PriorLearningParams { mean_color_variance: Some(Vector3::repeat(4.0)), ..params };
/// assert!((learn(&given)?.members()[0].mean()[0] - 75.0).abs() < 1e-6);
/// # Ok::<(), LightingPriorError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PriorLearningParams {
    /// Standard deviation of a colour between venues before any is seen, (Y, U, V): the mode of the hyperprior. Default 30, 10, 10.
    pub prior_color_sigmas: Vector3<f64>,
    /// Correlation of two colours between venues before any is seen, in Y as in U and V: one light falls on all of them. Default 0.9.
    pub prior_color_correlation: f64,
    /// Weight of the hyperprior, in venues. Default 3.
    pub n_pseudo_venues: f64,
    /// Variance of an image's mean of a colour about its venue's, (Y, U, V). Default none: pooled over the training images.
    pub mean_color_variance: Option<Vector3<f64>>,
    /// Variance of a pixel about the mean of its colour, if no venue recorded it. Default 144, 36, 36.
    pub pixel_color_variance: Vector3<f64>,
    /// Number of starts of k-means; the best result counts. Default 20.
    pub n_restarts: usize,
    /// Tolerance of EM: see [`HierarchicalGaussianParams`]. Default 1e-6 nats, or 10 000 iterations.
    pub tolerance: f64,
    /// See `tolerance`.
    pub max_iterations: usize,
}

impl Default for PriorLearningParams {
    fn default() -> Self {
        Self {
            prior_color_sigmas: Vector3::new(30.0, 10.0, 10.0),
            prior_color_correlation: 0.9,
            n_pseudo_venues: 3.0,
            mean_color_variance: None,
            pixel_color_variance: Vector3::new(144.0, 36.0, 36.0),
            n_restarts: 20,
            tolerance: 1e-6,
            max_iterations: 10_000,
        }
    }
}

impl PriorLearningParams {
    pub(super) fn check(&self) -> Result<(), LightingPriorError> {
        let noise =
            self.mean_color_variance.iter().flat_map(|noise| noise.iter()).chain(&self.pixel_color_variance);
        noise.into_iter().try_for_each(|variance| check_positive("variance of the noise", *variance))?;
        self.prior_color_sigmas.iter().try_for_each(|sigma| check_positive("sigma of a colour", *sigma))?;
        check_correlation("correlation of colours", self.prior_color_correlation)?;
        check_positive("number of pseudo-venues", self.n_pseudo_venues)?;
        check_positive("number of restarts", self.n_restarts as f64)
    }

    /// The hyperprior for `n_colors` colours, and the stopping criterion.
    pub(super) fn hierarchical(
        &self,
        n_colors: usize,
    ) -> Result<HierarchicalGaussianParams, LightingPriorError> {
        let mode = DMatrix::from_fn(3 * n_colors, 3 * n_colors, |i, j| {
            let correlation = match (i == j, i % 3 == j % 3) {
                (true, _) => 1.0,
                (false, true) => self.prior_color_correlation,
                (false, false) => 0.0,
            };
            correlation * self.prior_color_sigmas[i % 3] * self.prior_color_sigmas[j % 3]
        });
        Ok(HierarchicalGaussianParams {
            covariance_prior: Some(InverseWishart::from_mode(&mode, self.n_pseudo_venues)?),
            mean_prior: None,
            tolerance: self.tolerance,
            max_iterations: self.max_iterations,
        })
    }
}
