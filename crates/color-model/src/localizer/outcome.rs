use super::PoseEstimate;

/// Result of one frame.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use rand::SeedableRng;
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
/// # use wayfix_color_model::{ColorLocalizer, GlobalSearchParams, LocalizationStatus, LocalizerParams, StartPosePrior, YuvImage};
/// # use wayfix_color_model::{LightingFilter, LightingFilterParams};
/// # use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
/// # use wayfix_gaussian_core::Gaussian;
/// # let vertices = [(-2.0, -1.5), (2.0, -1.5), (2.0, 1.5), (-2.0, 1.5)].map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![ColoredShape::Polygon { color: ColorId(0), vertices }])?);
/// # let prior = Gaussian::new(DVector::from_vec(vec![70.0, 120.0, 110.0]), DMatrix::identity(3, 3) * 400.0)?;
/// # let light = LightingFilter::new(prior, LightingFilterParams::default())?;
/// # let camera = PinholeCamera::from_field_of_view(32, 24, 1.0, 0.8)?;
/// # let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// # let start = StartPosePrior::Near(Gaussian::from_sigmas(Pose2::identity(), &Vector3::new(0.1, 0.1, 0.1))?);
/// # let pixels = (0..32 * 24).map(|at| if at < 32 * 12 { [20, 128, 128] } else { [90, 120, 110] }).collect();
/// # let image = YuvImage::new(32, 24, pixels)?;
/// # let mount = Pose3 { translation: Vector3::new(0.0, 0.0, 0.2), ..Pose3::identity() };
/// let search = GlobalSearchParams { samples_per_place: 0.0, ..GlobalSearchParams::default() };
/// let params = LocalizerParams { search, ..LocalizerParams::default() };
/// let mut localizer = ColorLocalizer::new(map, camera, light, &start, params, &mut rng)?;
/// let outcome = localizer.update(&image, &mount, &mut rng)?;
/// assert!(outcome.effective_particles > 199.9); // the frame is tempered to leave a fifth of 1000
/// assert_eq!((outcome.n_hypotheses, outcome.alternative_probability), (1, 0.0)); // no search, no alternatives
/// assert_eq!(outcome.status, LocalizationStatus::Ambiguous); // the first of 16 frames
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FrameOutcome {
    /// Pose of the body after the frame.
    pub estimate: PoseEstimate,
    /// Quality of the estimate.
    pub status: LocalizationStatus,
    /// Effective number of particles after weighing.
    pub effective_particles: f64,
    /// Exponent of the likelihood, at most 1: below 1 while the particles are too far apart for the likelihood of the frame.
    pub tempering: f64,
    /// Number of particles at the estimate.
    pub n_particles: usize,
    /// Probability that the robot is at one of the alternative places.
    pub alternative_probability: f64,
    /// Number of places that are tracked: the estimate and its alternatives.
    pub n_hypotheses: usize,
    /// Probability of each light.
    pub light_probabilities: Vec<f64>,
}

/// Quality of a pose estimate.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use rand::SeedableRng;
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
/// # use wayfix_color_model::{ColorLocalizer, LightingFilter, LightingFilterParams, LocalizerParams, LocalizationStatus, StartPosePrior, YuvImage};
/// # use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
/// # use wayfix_gaussian_core::Gaussian;
/// # let vertices = [(-2.0, -1.5), (2.0, -1.5), (2.0, 1.5), (-2.0, 1.5)].map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![ColoredShape::Polygon { color: ColorId(0), vertices }])?);
/// # let prior = Gaussian::new(DVector::from_vec(vec![70.0, 120.0, 110.0]), DMatrix::identity(3, 3) * 400.0)?;
/// # let light = LightingFilter::new(prior, LightingFilterParams::default())?;
/// # let camera = PinholeCamera::from_field_of_view(32, 24, 1.0, 0.8)?;
/// # let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// # let start = StartPosePrior::Near(Gaussian::from_sigmas(Pose2::identity(), &Vector3::new(0.1, 0.1, 0.1))?);
/// # let mount = Pose3 { translation: Vector3::new(0.0, 0.0, 0.2), ..Pose3::identity() };
/// let params = LocalizerParams { max_particles: 100, ..LocalizerParams::as_published() };
/// let mut localizer = ColorLocalizer::new(map, camera, light, &start, params, &mut rng)?;
/// let dark = YuvImage::new(32, 24, vec![[20, 128, 128]; 32 * 24])?; // does not show the map
/// let mut statuses = Vec::new();
/// for _ in 0..16 {
///     statuses.push(localizer.update(&dark, &mount, &mut rng)?.status);
/// }
/// assert_eq!((statuses[14], statuses[15]), (LocalizationStatus::Ambiguous, LocalizationStatus::Lost));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalizationStatus {
    /// One place has more than 95 % of the probability, and the cluster of its particles is narrower than a place. A second search, if searches are on, found it again and
    /// was certain of it.
    Tracking,
    /// Several places, one that is wider, one of which no search was certain, or fewer frames than a search keeps.
    Ambiguous,
    /// The last frames together do not support the map at the estimate over the background with 95 % probability. Do not use the pose.
    Lost,
}
