//! A tracker of your own: the mean of the last images, colour by colour. It is simple, and it knows nothing of what it has not seen.
//!
//! `cargo run -p wayfix-color-model --example 02_custom_light_tracker`

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use wayfix_color_model::{
    ColorDensity, ColorMeans, ColorModelError, LightingFilter, LightingFilterParams, LightingTracker,
};
use wayfix_gaussian_core::Gaussian;

/// Forgets exponentially, every colour for itself.
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
            density.covariance = Matrix3::identity() * 150.0;
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let density =
        ColorDensity { mean: Vector3::new(100.0, 128.0, 128.0), covariance: Matrix3::identity() * 900.0 };
    let own = surprise(&mut RunningMean { colors: vec![density; 2] })?;

    let mut covariance = DMatrix::from_diagonal_element(6, 6, 900.0);
    (covariance[(0, 3)], covariance[(3, 0)]) = (855.0, 855.0);
    let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0, 100.0, 128.0, 128.0]), covariance)?;
    let ours = surprise(&mut LightingFilter::new(prior, LightingFilterParams::default())?)?;

    println!("unseen colour off by {own:.0} with a running mean, {ours:.0} with a joint filter");
    assert!(ours < 0.7 * own);
    Ok(())
}
