use nalgebra::Vector3;
use rand::{Rng, RngExt, distr::Distribution};
use wayfix_color_map::ColorMap;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use crate::{ColorModelError, localizer::estimate::PLACE_RADIUS};

/// Prior of the start pose.
/// ```
/// # use std::sync::Arc;
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use rand::SeedableRng;
/// # use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
/// # use wayfix_color_model::{ColorLocalizer, LightingFilter, LightingFilterParams, LocalizerParams, StartPosePrior};
/// # use wayfix_estimation_traits::{LieGroup, Pose2};
/// # use wayfix_gaussian_core::Gaussian;
/// # let vertices = [(-2.0, -1.5), (2.0, -1.5), (2.0, 1.5), (-2.0, 1.5)].map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
/// # let map = Arc::new(ColorMap::new(vec!["green".into()], vec![ColoredShape::Polygon { color: ColorId(0), vertices }])?);
/// # let prior = Gaussian::new(DVector::from_vec(vec![70.0, 120.0, 110.0]), DMatrix::identity(3, 3) * 400.0)?;
/// # let light = LightingFilter::new(prior, LightingFilterParams::default())?;
/// # let camera = PinholeCamera::from_field_of_view(32, 24, 1.0, 0.8)?;
/// # let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let mut farthest = |start: StartPosePrior| {
///     let localizer = ColorLocalizer::new(map.clone(), camera, light.clone(), &start, LocalizerParams::default(), &mut rng)?;
///     Ok::<_, wayfix_color_model::ColorModelError>(localizer.poses().map(|(pose, _)| pose.translation.norm()).fold(0.0, f64::max))
/// };
/// let near = Gaussian::from_sigmas(Pose2::identity(), &Vector3::new(0.1, 0.1, 0.1))?;
/// assert!(farthest(StartPosePrior::Near(near))? < 0.6); // six standard deviations
/// let corner = 2.0_f64.hypot(1.5); // of a field of 4 m × 3 m
/// assert!((0.9 * corner..corner).contains(&farthest(StartPosePrior::Anywhere)?));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum StartPosePrior {
    /// Normally distributed.
    Near(Gaussian<Pose2<f64>>),
    /// Uniform over the map, with any heading.
    Anywhere,
}

/// A rectangle of the ground, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Area {
    min: [f64; 2],
    max: [f64; 2],
}

impl Area {
    /// The ground below a map.
    pub(crate) fn of(map: &ColorMap) -> Result<Self, ColorModelError> {
        let extent = map.extent().ok_or(ColorModelError::EmptyMap)?;
        Ok(Self { min: [extent.min.x, extent.min.y], max: [extent.max.x, extent.max.y] })
    }

    /// Moves the pose to the nearest one inside: boards stop a robot at the border.
    pub(crate) fn clamp(&self, pose: &mut Pose2<f64>) {
        for axis in 0..2 {
            pose.translation[axis] = pose.translation[axis].clamp(self.min[axis], self.max[axis]);
        }
    }

    /// Whether a pose is inside.
    pub(crate) fn contains(&self, pose: &Pose2<f64>) -> bool {
        (0..2).all(|axis| (self.min[axis]..=self.max[axis]).contains(&pose.translation[axis]))
    }

    /// Lengths along x and y, m.
    pub(crate) fn size(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.max[axis] - self.min[axis])
    }

    /// Number of distinguishable places: of cells of the size of a place.
    pub(crate) fn n_places(&self) -> usize {
        let [width, depth] = self.size();
        ((width * depth * std::f64::consts::TAU / PLACE_RADIUS.powi(3)) as usize).max(1)
    }

    /// Number of cells of at most this size along x, y (m) and the heading (rad).
    pub(crate) fn cells(&self, size: &Vector3<f64>) -> [usize; 3] {
        let [width, depth] = self.size();
        let sides = [width / size.x, depth / size.y, std::f64::consts::TAU / size.z];
        sides.map(|n| (n.ceil() as usize).max(1))
    }

    /// A pose of a cell.
    pub(crate) fn draw_in<R: Rng + ?Sized>(
        &self,
        cell: usize,
        [n_x, n_y, n_headings]: [usize; 3],
        rng: &mut R,
    ) -> Pose2<f64> {
        let mut share = |at: usize, n: usize| (at as f64 + rng.random::<f64>()) / n as f64;
        let shares = [
            share(cell % n_x, n_x),
            share(cell / n_x % n_y, n_y),
            share(cell / (n_x * n_y) % n_headings, n_headings),
        ];
        let along = |axis: usize| self.min[axis] + shares[axis] * (self.max[axis] - self.min[axis]);
        Pose2::new(along(0), along(1), (shares[2] - 0.5) * std::f64::consts::TAU)
    }

    pub(crate) fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> Pose2<f64> {
        let mut between =
            |axis: usize| self.min[axis] + rng.random::<f64>() * (self.max[axis] - self.min[axis]);
        let (x, y) = (between(0), between(1));
        Pose2::new(x, y, (rng.random::<f64>() - 0.5) * std::f64::consts::TAU)
    }
}

impl StartPosePrior {
    /// A pose that the start allows.
    pub(crate) fn draw<R: Rng + ?Sized>(&self, area: &Area, rng: &mut R) -> Pose2<f64> {
        match self {
            Self::Near(about) => about.sampler().sample(rng),
            Self::Anywhere => area.sample(rng),
        }
    }

    /// Number of cells of at most this size in the area. Near a known start: within three standard deviations, and as wide as a peak of the likelihood, the size in heading.
    pub(crate) fn n_cells(&self, area: &Area, size: &Vector3<f64>) -> usize {
        let all = area.cells(size).iter().product();
        match self {
            Self::Near(about) => {
                let variances = about.covariance().diagonal();
                let sides = variances.map(|variance| (6.0 * variance.sqrt() / size.z).ceil());
                (sides.map(|n| n.max(1.0)).product() as usize).min(all)
            }
            Self::Anywhere => all,
        }
    }

    /// $`\ln p`$ of a pose, up to a constant.
    pub(crate) fn log_prior(&self, pose: &Pose2<f64>) -> f64 {
        match self {
            // An exact start has no density; it is drawn at its mean.
            Self::Near(about) => about.mahalanobis_squared(pose).map_or(0.0, |squared| -0.5 * squared),
            Self::Anywhere => 0.0,
        }
    }
}
