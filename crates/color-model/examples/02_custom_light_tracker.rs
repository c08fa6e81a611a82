//! A tracker of your own: the mean of the last images, colour by colour. It is simple, and it knows nothing of what it has not seen.
//!
//! `cargo run -p wayfix-color-model --example 02_custom_light_tracker`

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
use wayfix_color_model::{
    ColorDensity, ColorLocalizer, ColorMeans, ColorModelError, LightingFilter, LightingFilterParams,
    LightingTracker, LocalizerParams, OdometryStep, StartPosePrior, YuvImage,
};
use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
use wayfix_gaussian_core::Gaussian;

/// Size of an image, pixels.
const WIDTH: usize = 160;
const HEIGHT: usize = 120;

/// Forgets exponentially, every colour for itself.
#[derive(Clone)]
struct RunningMean {
    colors: Vec<ColorDensity>,
}

impl LightingTracker for RunningMean {
    fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        // The law: without images, colours become less certain.
        for color in &mut self.colors {
            color.covariance += Matrix3::identity() * 25.0 * seconds;
        }
        Ok(())
    }

    fn update(&mut self, means: &ColorMeans) -> Result<(), ColorModelError> {
        for (color, mean) in means.seen() {
            let density = &mut self.colors[usize::from(color.0)];
            density.mean += (mean - density.mean) * 0.3;
            density.covariance = Matrix3::identity() * 25.0;
        }
        Ok(())
    }

    fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError> {
        Ok(self.colors.clone())
    }
}

/// Ten images of a light that grows; the second colour is in sight in the last one only. How far off is it before that?
fn surprise(tracker: &mut impl LightingTracker) -> Result<f64, ColorModelError> {
    for k in 0..10 {
        tracker.predict(1.0)?;
        let brightness = 100.0 + 5.0 * f64::from(k);
        tracker.update(&ColorMeans::new([(Some(Vector3::new(brightness, 128.0, 128.0)), 500), (None, 0)]))?;
    }
    Ok((tracker.colors()?[1].mean.x - 145.0).abs())
}

/// A robot drives over a green carpet while the light grows: the localizer follows it with a tracker that it has never seen.
fn localized(light: RunningMean) -> Result<f64, Box<dyn std::error::Error>> {
    let vertices = [(-2.0, -1.5), (2.0, -1.5), (2.0, 1.5), (-2.0, 1.5)].map(|(x, y)| Vector3::new(x, y, 0.0));
    let carpet = ColoredShape::Polygon { color: ColorId(0), vertices: vertices.to_vec() };
    let map = Arc::new(ColorMap::new(vec!["green".into()], vec![carpet])?);
    let camera = PinholeCamera::from_field_of_view(WIDTH as u32, HEIGHT as u32, 1.0, 0.8)?;
    let start = StartPosePrior::Near(Gaussian::from_sigmas(Pose2::identity(), &Vector3::new(0.1, 0.1, 0.1))?);
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    let params = LocalizerParams { max_particles: 200, ..LocalizerParams::default() };
    let mut localizer = ColorLocalizer::new(map, camera, light, &start, params, &mut rng)?;
    let mount = Pose3 { translation: Vector3::new(0.0, 0.0, 0.2), ..Pose3::identity() };
    for k in 0..10_u8 {
        let forward = OdometryStep { increment: Some(Pose2::new(0.01, 0.0, 0.0)), seconds: 0.1 };
        localizer.predict(&forward, &mut rng)?;
        // The lower half of the image is carpet.
        let mean = |at| if at < WIDTH * HEIGHT / 2 { [20, 128, 128] } else { [100 + 2 * k, 128, 128] };
        let mut noisy = |channel: u8| channel + rng.random_range(0..13) - 6;
        let pixels = (0..WIDTH * HEIGHT).map(|at| mean(at).map(&mut noisy));
        localizer.update(&YuvImage::new(WIDTH as u32, HEIGHT as u32, pixels.collect())?, &mount, &mut rng)?;
    }
    Ok(localizer.light().colors()?[0].mean.x)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let density =
        ColorDensity { mean: Vector3::new(100.0, 128.0, 128.0), covariance: Matrix3::identity() * 900.0 };
    let known = ColorDensity { covariance: Matrix3::identity() * 25.0, ..density };
    let learned = localized(RunningMean { colors: vec![known] })?;
    println!("in the localizer the carpet has a brightness of {learned:.0}, from 100 to 118");
    assert!(learned > 105.0); // a mean lags behind

    let own = surprise(&mut RunningMean { colors: vec![density; 2] })?;

    let mut covariance = DMatrix::from_diagonal_element(6, 6, 900.0);
    (covariance[(0, 3)], covariance[(3, 0)]) = (855.0, 855.0);
    let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0, 100.0, 128.0, 128.0]), covariance)?;
    let ours = surprise(&mut LightingFilter::new(prior, LightingFilterParams::default())?)?;

    println!("unseen colour off by {own:.0} with a running mean, {ours:.0} with a joint filter");
    assert!(ours < 0.7 * own);
    Ok(())
}
