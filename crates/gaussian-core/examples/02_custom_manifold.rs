//! Gaussians over a type of your own: a wind vane, which is an angle, on a mast, which is a height.
//!
//! `cargo run -p wayfix-gaussian-core --example 02_custom_manifold`

use nalgebra::{Const, Vector2};
use wayfix_estimation_traits::{Manifold, laws, wrap_angle};
use wayfix_gaussian_core::{Gaussian, GaussianMixture, moment_matched};

/// 1. The state: where the wind comes from, rad, and how high the vane is, m.
#[derive(Clone, Copy, Debug)]
struct Vane {
    from: f64,
    height: f64,
}

/// 2. How far two of them are apart, and how one is moved. That is all a Gaussian needs.
impl Manifold for Vane {
    type Scalar = f64;
    type Dim = Const<2>;
    fn dim(&self) -> Const<2> {
        Const
    }
    fn retract(&self, delta: &Vector2<f64>) -> Self {
        Self { from: wrap_angle(self.from + delta.x), height: self.height + delta.y }
    }
    fn local(&self, other: &Self) -> Vector2<f64> {
        Vector2::new(wrap_angle(other.from - self.from), other.height - self.height)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 3. The laws, checked on states of ours, both sides of the wrap among them.
    let vanes = [(0.0, 2.0), (3.1, 10.0), (-3.1, 0.5)].map(|(from, height)| Vane { from, height });
    laws::manifold(&vanes)?;

    // 4. Two opinions that meet across the wrap: 178° and -179° make 179.5°, not 0°.
    let one =
        Gaussian::from_sigmas(Vane { from: 178_f64.to_radians(), height: 10.0 }, &Vector2::new(0.02, 0.5))?;
    let two =
        Gaussian::from_sigmas(Vane { from: -179_f64.to_radians(), height: 10.4 }, &Vector2::new(0.02, 0.5))?;
    let both = one.product(&two)?;
    println!("wind from {:.1}°, {:.1} m", both.mean().from.to_degrees(), both.mean().height);
    assert!((both.mean().from.to_degrees() - 179.5).abs() < 0.01);

    // 5. Everything else works too: a mixture, and the one Gaussian that is most like it.
    let mixture = GaussianMixture::from_weights(vec![(0.7, one), (0.3, two)])?;
    let summary = moment_matched(&mixture.weights(), mixture.components())?;
    println!("in one: from {:.1}°", summary.mean().from.to_degrees());
    assert!((summary.mean().from.to_degrees() - 178.9).abs() < 0.01); // 178° + 0.3 · 3°
    Ok(())
}
