use nalgebra::Vector3;

/// Linear red, green and blue: radiance, irradiance, reflectance or gain, depending on the context.
pub type LinearRgb = Vector3<f64>;

/// Light on surfaces. Implement it for custom light (`examples/03_custom_light.rs`).
///
/// **Laws**: results are finite and not negative, and depend only on the arguments.
pub trait LightField {
    /// Irradiance of a surface at `point` (metres) that faces along the unit vector `normal`; 1 is the everyday light of a venue.
    fn irradiance(&self, point: &Vector3<f64>, normal: &Vector3<f64>) -> LinearRgb;
}

/// A panel on the ceiling that shines downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Position, m.
    pub position: Vector3<f64>,
    /// Irradiance 1 m straight below it.
    pub strength: LinearRgb,
}

/// Lamps and ambient light.
///
/// A lamp gives $`E = I \cos θ_o \cos θ_i / d^2`$ (a downward Lambert emitter and a Lambert surface); there are no shadows.
/// ```
/// use wayfix_estimation_traits::nalgebra::Vector3;
/// use wayfix_scene_sim::league::{Lamp, LampLight, LightField, LinearRgb};
/// let lamp = Lamp { position: Vector3::new(0.0, 0.0, 2.0), strength: LinearRgb::repeat(4.0) };
/// let light = LampLight { lamps: vec![lamp], ambient: LinearRgb::zeros(), bounce: LinearRgb::zeros() };
/// let below = light.irradiance(&Vector3::zeros(), &Vector3::z());
/// let aside = light.irradiance(&Vector3::new(2.0, 0.0, 0.0), &Vector3::z());
/// assert!((below.x - 1.0).abs() < 1e-15 && (aside.x - 0.25).abs() < 1e-15); // cos⁴ 45°
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct LampLight {
    /// The lamps.
    pub lamps: Vec<Lamp>,
    /// Ambient irradiance from above.
    pub ambient: LinearRgb,
    /// Irradiance from below, reflected by the carpet.
    pub bounce: LinearRgb,
}

impl LightField for LampLight {
    fn irradiance(&self, point: &Vector3<f64>, normal: &Vector3<f64>) -> LinearRgb {
        let up = 0.5 + 0.5 * normal.z;
        let around = self.ambient * up + self.bounce * (1.0 - up);
        self.lamps.iter().fold(around, |sum, lamp| sum + lamp.irradiance(point, normal))
    }
}

impl Lamp {
    fn irradiance(&self, point: &Vector3<f64>, normal: &Vector3<f64>) -> LinearRgb {
        let to_lamp = self.position - point;
        let facing = normal.dot(&to_lamp);
        if facing <= 0.0 || to_lamp.z <= 0.0 {
            return LinearRgb::zeros();
        }
        let squared = to_lamp.norm_squared();
        self.strength * (to_lamp.z * facing / (squared * squared))
    }
}
