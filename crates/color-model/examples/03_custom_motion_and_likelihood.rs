//! A motion model and a likelihood of your own in the localizer: wheels that never slip sideways, and a likelihood that trusts each image half as much.
//!
//! `cargo run -p wayfix-color-model --example 03_custom_motion_and_likelihood`

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3};
use rand::{Rng, RngExt, SeedableRng};
use rand_distr::StandardNormal;
use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
use wayfix_color_model::{
    ColorLocalizer, ColorLocalizerModels, ColorModelError, GlobalSearchParams, LightingFilter,
    LightingFilterParams, LightingTracker, LikelihoodFrameInput, LikelihoodModel, LocalizerParams,
    OdometryModel, OdometryStep, PixelLikelihoodParams, PixelSums, PredictedMapView, StartPosePrior,
    YuvImage,
};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2, Pose3, SampleMotion};
use wayfix_gaussian_core::Gaussian;

/// Size of an image, pixels.
const WIDTH: usize = 160;
const HEIGHT: usize = 120;

/// Wheels that slip along and about, and never sideways.
#[derive(Clone, Copy)]
struct Wheels {
    /// Standard deviation as a share of the motion.
    relative_sigma: f64,
}

impl SampleMotion for Wheels {
    type State = Pose2<f64>;
    type Control = OdometryStep;

    fn sampler<R: Rng + ?Sized>(&self, step: &OdometryStep) -> impl Fn(&Pose2<f64>, &mut R) -> Pose2<f64> {
        let increment = step.increment.unwrap_or_else(Pose2::identity);
        let (along, about) = self.sigmas(step);
        move |pose, rng| {
            let mut deviate = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
            pose.compose(&increment).retract(&Vector3::new(deviate(along), 0.0, deviate(about)))
        }
    }
}

impl OdometryModel for Wheels {
    fn sigmas(&self, step: &OdometryStep) -> (f64, f64) {
        let moved = step.increment.unwrap_or_else(Pose2::identity);
        let distance = moved.translation.norm();
        (self.relative_sigma * distance, self.relative_sigma * distance.hypot(moved.heading()))
    }
}

/// The square root of another likelihood.
struct HalfTrusted<L>(L);

impl<L: LikelihoodModel> LikelihoodModel for HalfTrusted<L> {
    type Frame = L::Frame;
    type Scratch = L::Scratch;

    fn frame(&self, input: &LikelihoodFrameInput<'_>) -> Result<L::Frame, ColorModelError> {
        self.0.frame(input)
    }

    fn scratch(&self, frame: &L::Frame) -> L::Scratch {
        self.0.scratch(frame)
    }

    fn log_likelihoods<T: LightingTracker>(
        &self,
        frame: &L::Frame,
        scratch: &mut L::Scratch,
        view: &PredictedMapView<'_>,
        light: &T,
        log_likelihoods: &mut [f64],
        shown: &mut [PixelSums],
    ) {
        self.0.log_likelihoods(frame, scratch, view, light, log_likelihoods, shown);
        log_likelihoods.iter_mut().for_each(|log| *log *= 0.5);
    }
}

/// A robot drives towards the far edge of a green carpet. How sure is it of the distance, m?
fn sigma_along<L: LikelihoodModel>(likelihood: L) -> Result<f64, Box<dyn std::error::Error>> {
    let vertices = [(-2.0, -1.5), (2.0, -1.5), (2.0, 1.5), (-2.0, 1.5)].map(|(x, y)| Vector3::new(x, y, 0.0));
    let carpet = ColoredShape::Polygon { color: ColorId(0), vertices: vertices.to_vec() };
    let map = Arc::new(ColorMap::new(vec!["green".into()], vec![carpet])?);
    let camera = PinholeCamera::from_field_of_view(WIDTH as u32, HEIGHT as u32, 1.0, 0.8)?;
    let prior = Gaussian::new(
        DVector::from_vec(vec![100.0, 128.0, 128.0]),
        DMatrix::from_diagonal_element(3, 3, 25.0),
    )?;
    let light = LightingFilter::new(prior, LightingFilterParams::default())?;
    let models = ColorLocalizerModels { light, odometry: Wheels { relative_sigma: 0.1 }, likelihood };
    let start = StartPosePrior::Near(Gaussian::from_sigmas(Pose2::identity(), &Vector3::new(0.1, 0.1, 0.1))?);
    // The particles alone: a search weighs places by the pixel likelihood.
    let search = GlobalSearchParams { samples_per_place: 0.0, ..GlobalSearchParams::default() };
    let params = LocalizerParams { max_particles: 200, search, ..LocalizerParams::default() };
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    let mut localizer = ColorLocalizer::with_models(map, camera, models, &start, params, &mut rng)?;
    let mount = Pose3 { translation: Vector3::new(0.0, 0.0, 0.2), ..Pose3::identity() };
    let mut sigma = f64::NAN;
    for _ in 0..10 {
        let forward = OdometryStep { increment: Some(Pose2::new(0.01, 0.0, 0.0)), seconds: 0.1 };
        localizer.predict(&forward, &mut rng)?;
        // The carpet ends below the horizon, which is in the middle.
        let mean = |at| if at < WIDTH * (HEIGHT / 2 + 14) { [20, 128, 128] } else { [100, 128, 128] };
        let mut noisy = |channel: u8| channel + rng.random_range(0..13) - 6;
        let pixels = (0..WIDTH * HEIGHT).map(|at| mean(at).map(&mut noisy));
        let image = YuvImage::new(WIDTH as u32, HEIGHT as u32, pixels.collect())?;
        let outcome = localizer.update(&image, &mount, &mut rng)?;
        sigma = outcome.estimate.pose.covariance()[(0, 0)].sqrt();
    }
    Ok(sigma)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pixels = PixelLikelihoodParams::default();
    let (trusted, half_trusted) = (sigma_along(pixels)?, sigma_along(HalfTrusted(pixels))?);
    println!(
        "the edge of the carpet is known to {trusted:.4} m, and to {half_trusted:.4} m if images are half trusted"
    );
    assert!(trusted > 0.0 && half_trusted > trusted);
    Ok(())
}
