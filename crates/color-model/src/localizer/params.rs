use wayfix_integrity::RelocalizationParams;

use super::{CameraPoseNoise, OdometryNoise};
use crate::{ColorModelError, PixelLikelihoodParams, ViewOcclusionModel};

/// Parameters of [`ColorLocalizer`](crate::ColorLocalizer).
///
/// ```
/// use wayfix_color_model::LocalizerParams;
/// let published = LocalizerParams::as_published();
/// assert!(published.relocalization.is_off() && published.search.samples_per_place == 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LocalizerParams {
    /// The pixel likelihood.
    pub pixels: PixelLikelihoodParams,
    /// Noise of the odometry.
    pub odometry: OdometryNoise,
    /// Noise of the camera's pose on the body.
    pub camera_pose_noise: CameraPoseNoise,
    /// Global search at the start and for relocalization.
    pub search: GlobalSearchParams,
    /// The change test between the present pose and the places that a search finds; off with `false_alarms_per_km` 0.
    pub relocalization: RelocalizationParams,
    /// Largest number of particles of a place; the smallest is half of it. Default 1000.
    pub max_particles: usize,
    /// Smallest share of the effective particles that a frame leaves; its likelihood is tempered for that. 0 never tempers. Default 0.2:
    /// of 1000 particles, 200 count, six along each of the three dimensions of a pose.
    pub tempering_min_ess_share: f64,
    /// Smallest number of pixels from which the mean of a colour is taken. Default 30: its standard error is a fifth of the σ of a pixel.
    pub min_pixels: u64,
    /// How often and for how long an object hides the whole view.
    pub occlusion: ViewOcclusionModel,
    /// Index of a colour in the map whose means the lighting filter ignores: its estimate then comes from the other colours. Default none.
    pub withheld_color: Option<usize>,
}

/// Parameters of the global search.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use rand::SeedableRng;
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
/// # use wayfix_color_model::{ColorLocalizer, ColorModelError, GlobalSearchParams, LocalizerParams, StartPosePrior};
/// # use wayfix_color_model::{LightingFilter, LightingFilterParams};
/// # use wayfix_gaussian_core::Gaussian;
/// # let vertices = [(-2.0, -1.5), (2.0, -1.5), (2.0, 1.5), (-2.0, 1.5)].map(|(x, y)| Vector3::new(1000.0 * x, 1000.0 * y, 0.0)).to_vec();
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![ColoredShape::Polygon { color: ColorId(0), vertices }])?);
/// # let prior = Gaussian::new(DVector::from_vec(vec![70.0, 120.0, 110.0]), DMatrix::identity(3, 3) * 400.0)?;
/// # let light = LightingFilter::new(prior, LightingFilterParams::default())?;
/// # let camera = PinholeCamera::from_field_of_view(32, 24, 1.0, 0.8)?;
/// # let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let mut localizer = |samples_per_place| {
///     let search = GlobalSearchParams { samples_per_place, ..GlobalSearchParams::default() };
///     let params = LocalizerParams { search, ..LocalizerParams::default() };
///     ColorLocalizer::new(map.clone(), camera, light.clone(), &StartPosePrior::Anywhere, params, &mut rng)
/// };
/// assert!(matches!(localizer(1.0), Err(ColorModelError::MapTooLarge { .. }))); // a field of 4 m × 3 m in millimetres
/// assert!(localizer(0.0).is_ok()); // without a search there is no limit
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct GlobalSearchParams {
    /// Number of frames that are kept for a search. Searches run after 1, 4, 16, … frames and after this number; the best place becomes the present one. Later
    /// searches propose alternatives. Default 16: at ten images a second, what a robot sees while it turns by a quarter of a circle.
    pub n_buffered_frames: usize,
    /// Number of trajectories drawn for each cell of the map, 0.3 m × 0.3 m × the angle of two tiles, at most 0.3 rad, or for each peak of the likelihood near a known start; 0 never searches. Default 1.
    pub samples_per_place: f64,
    /// Number of trajectories that are refined at first; a quarter of them is kept after each of three rounds. Default 800: a dozen is left.
    pub n_refined_trajectories: usize,
    /// Number of moves of each in the first round; it is doubled in each of the next, which take half the time of the one before. Default 10,
    /// chosen.
    pub n_first_round_moves: u32,
    /// Time between searches after the start, s. Default 3: a robot that was moved is found within seconds. A search of a field of 5 m × 4 m
    /// takes about as long on two cores.
    pub search_interval: f64,
}

impl Default for GlobalSearchParams {
    fn default() -> Self {
        Self {
            n_buffered_frames: 16,
            samples_per_place: 1.0,
            n_refined_trajectories: 800,
            n_first_round_moves: 10,
            search_interval: 3.0,
        }
    }
}

impl GlobalSearchParams {
    /// Whether a search runs after so many frames, at the start.
    pub(crate) fn is_start_search(&self, n_frames: usize) -> bool {
        let is_power_of_four = n_frames.is_power_of_two() && n_frames.ilog2().is_multiple_of(2);
        n_frames == self.n_buffered_frames || (is_power_of_four && n_frames < self.n_buffered_frames)
    }
}

impl Default for LocalizerParams {
    fn default() -> Self {
        Self {
            pixels: PixelLikelihoodParams::default(),
            odometry: OdometryNoise::default(),
            camera_pose_noise: CameraPoseNoise::default(),
            search: GlobalSearchParams::default(),
            relocalization: RelocalizationParams::default(),
            max_particles: 1000,
            tempering_min_ess_share: 0.2,
            min_pixels: 30,
            occlusion: ViewOcclusionModel::default(),
            withheld_color: None,
        }
    }
}

impl LocalizerParams {
    /// The method of [Schulz & Fox 2004, IV] alone: the pixel product [Schulz & Fox 2004, Eq. 16], particles from the start distribution, no
    /// search, no tempering, no hidden
    /// frames.
    pub fn as_published() -> Self {
        Self {
            pixels: PixelLikelihoodParams::as_published(),
            search: GlobalSearchParams { samples_per_place: 0.0, ..GlobalSearchParams::default() },
            relocalization: RelocalizationParams::off(),
            tempering_min_ess_share: 0.0,
            occlusion: ViewOcclusionModel { mean_time_hidden: 0.0, ..ViewOcclusionModel::default() },
            ..Self::default()
        }
    }

    pub(crate) fn check(&self) -> Result<(), ColorModelError> {
        self.pixels.check()?;
        self.relocalization.validate()?;
        let CameraPoseNoise { rotation_sigma, height_sigma, correlation_time } = self.camera_pose_noise;
        let camera = [
            ("camera rotation sigma", rotation_sigma),
            ("camera height sigma", height_sigma),
            ("correlation time", correlation_time),
        ];
        let not_negative = self
            .odometry
            .values()
            .into_iter()
            .chain(camera)
            .chain([("search interval", self.search.search_interval)])
            .chain([("samples per place", self.search.samples_per_place)]);
        for (what, value) in not_negative {
            check(what, value, 0.0, f64::MAX)?;
        }
        check("number of frames", self.search.n_buffered_frames as f64, 1.0, f64::MAX)?;
        check("number of refined trajectories", self.search.n_refined_trajectories as f64, 1.0, f64::MAX)?;
        check("number of moves", f64::from(self.search.n_first_round_moves), 0.0, f64::from(u16::MAX))?;
        check("largest number of particles", self.max_particles as f64, 1.0, f64::MAX)?;
        check(
            "smallest share of effective particles after tempering",
            self.tempering_min_ess_share,
            0.0,
            1.0,
        )?;
        check("mean time of a free view (s)", self.occlusion.mean_time_free, f64::MIN_POSITIVE, f64::MAX)?;
        check("mean time of a hidden view (s)", self.occlusion.mean_time_hidden, 0.0, f64::MAX)
    }
}

fn check(what: &'static str, value: f64, least: f64, most: f64) -> Result<(), ColorModelError> {
    if value >= least && value <= most { Ok(()) } else { Err(ColorModelError::OutOfRange { what, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn searches_at_the_start_end_with_a_full_buffer() {
        let searches = |n_buffered_frames: usize| -> Vec<usize> {
            let params = GlobalSearchParams { n_buffered_frames, ..GlobalSearchParams::default() };
            (1..100).filter(|n| params.is_start_search(*n)).collect()
        };
        assert_eq!(searches(16), [1, 4, 16]);
        assert_eq!(searches(10), [1, 4, 10]);
        assert_eq!(searches(1), [1]);
    }
}
