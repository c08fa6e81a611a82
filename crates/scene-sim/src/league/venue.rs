use nalgebra::Vector3;
use rand::Rng;

use super::{
    CameraParams, HallBackdrop, Lamp, LampLight, LightField, LinearRgb, N_COLORS, SunThroughWindows,
    black_body,
};
use crate::SimulationError;
use crate::random::deviate::{below, chance, normal, uniform};

/// Reflectances of the map colours, in their order, before a venue's own pots of paint.
const PAINTS: [[f64; 3]; N_COLORS] =
    [[0.045, 0.20, 0.075], [0.80, 0.80, 0.77], [0.78, 0.58, 0.045], [0.14, 0.45, 0.67], [0.80, 0.25, 0.45]];
/// The colour temperatures a camera's fixed white balances are made for, kelvin.
const WHITE_BALANCES_K: [f64; 3] = [2800.0, 4300.0, 5600.0];

/// A place with a field: its paints, its lamps, and how the camera was set for it.
#[derive(Clone, Debug, PartialEq)]
pub struct LeagueVenue {
    /// Diffuse reflectance of each map colour.
    pub paints: [LinearRgb; N_COLORS],
    /// Everyday light.
    pub bright: LampLight,
    /// All lamps off but one.
    pub dark: LampLight,
    /// Everyday light, and the sun in at the windows.
    pub sunny: SunThroughWindows,
    /// Surroundings of the field.
    pub hall: HallBackdrop,
    /// The camera; set for the everyday light and never changed.
    pub camera: CameraParams,
}

/// The light of a venue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LampSetting {
    /// Everyday light.
    Bright,
    /// All lamps off but one.
    Dark,
    /// Everyday light, and the sun in at the windows.
    Sunny,
}

impl LeagueVenue {
    /// Draws a random venue.
    ///
    /// Four or six panels (2700 to 6500 K, every one a little different, somewhat green or magenta together) hang 2.4 to 3.4 m high in two
    /// rows; a paint differs by about 4 % as a whole (the carpet by 12 %) and 5 % in each primary. The camera has one of three fixed white
    /// balances, mostly the nearest, else the next; a gain that puts white at 0.65 to 1.1 of full scale on average over the field; and
    /// filters of low saturation, as in the robots of that time.
    ///
    /// ```
    /// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    /// use wayfix_scene_sim::league::LeagueVenue;
    /// let venue = LeagueVenue::draw(&mut ChaCha8Rng::seed_from_u64(1))?;
    /// assert!([4, 6].contains(&venue.bright.lamps.len()) && venue.dark.lamps.len() == 1);
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the errors of the camera; none occur for its valid constants.
    pub fn draw<R: Rng + ?Sized>(rng: &mut R) -> Result<Self, SimulationError> {
        let paints = paints(rng);
        let kelvin = uniform(2700.0, 6500.0, rng);
        let lamps = lamps(kelvin, rng);
        let window = black_body(uniform(3000.0, 7500.0, rng)) * uniform(0.01, 0.035, rng);
        let around = uniform(0.25, 0.45, rng);
        let left_on = below(lamps.len(), rng);
        let dark = lighting(vec![lamps[left_on]], &paints, around, window);
        let bright = lighting(lamps, &paints, around, window);
        let camera = camera(kelvin, &paints, &bright, rng)?;
        let hall = HallBackdrop {
            half_length_m: uniform(3.2, 5.5, rng),
            half_width_m: uniform(2.3, 4.5, rng),
            crowd: uniform(0.3, 0.8, rng),
            seed: rng.next_u64(),
        };
        let sunny = SunThroughWindows::draw(&bright, paints[0], &hall, rng);
        Ok(Self { paints, bright, dark, sunny, hall, camera })
    }

    /// The light, of lamps and sun.
    pub fn light(&self, lighting: LampSetting) -> &dyn LightField {
        match lighting {
            LampSetting::Bright => &self.bright,
            LampSetting::Dark => &self.dark,
            LampSetting::Sunny => &self.sunny,
        }
    }

    /// Sets the camera's gain for the sun, as it was for the everyday light: white keeps its level, on average over the field.
    pub fn expose_for_sun(&mut self) {
        self.camera.gain *= mean_irradiance(&self.bright).y / self.sunny.mean_irradiance().y;
    }
}

fn paints<R: Rng + ?Sized>(rng: &mut R) -> [LinearRgb; N_COLORS] {
    let carpet = libm::exp(0.12 * normal(rng));
    let mut index = 0;
    PAINTS.map(|paint| {
        let whole = if index == 0 { carpet } else { libm::exp(0.04 * normal(rng)) };
        index += 1;
        LinearRgb::from(paint)
            .map(|r| (r * whole * libm::exp(0.05 * normal(rng)) + uniform(0.0, 0.02, rng)).min(0.9))
    })
}

fn lamps<R: Rng + ?Sized>(kelvin: f64, rng: &mut R) -> Vec<Lamp> {
    let per_row = 2 + below(2, rng);
    let (height, tint) = (uniform(2.4, 3.4, rng), libm::exp(0.04 * normal(rng)));
    let (spread, aside) = (uniform(1.0, 1.8, rng), uniform(0.65, 1.1, rng));
    let mut lamps = Vec::new();
    for row in [-1.0, 1.0] {
        for k in 0..per_row {
            let along = 2.0 * k as f64 / (per_row - 1) as f64 - 1.0;
            let color = black_body(kelvin * libm::exp(0.15 * normal(rng)))
                .component_mul(&LinearRgb::new(1.0, tint, 1.0));
            let position = Vector3::new(
                spread * along + 0.15 * normal(rng),
                row * aside + 0.1 * normal(rng),
                height + 0.05 * normal(rng),
            );
            lamps.push(Lamp { position, strength: color * libm::exp(0.12 * normal(rng)) });
        }
    }
    let mean = mean_luminance(&lamps);
    lamps.iter().map(|lamp| Lamp { strength: lamp.strength / mean, ..*lamp }).collect()
}

/// Luminance of the carpet's light, averaged over the field.
fn mean_luminance(lamps: &[Lamp]) -> f64 {
    let direct = mean_irradiance(&LampLight { lamps: lamps.to_vec(), ..LampLight::default() });
    0.2126 * direct.x + 0.7152 * direct.y + 0.0722 * direct.z
}

fn mean_irradiance(light: &LampLight) -> LinearRgb {
    let along = |half: f64| [-0.8, -0.4, 0.0, 0.4, 0.8].map(|share| share * half);
    let mut sum = LinearRgb::zeros();
    for x in along(2.1) {
        for y in along(1.35) {
            sum += light.irradiance(&Vector3::new(x, y, 0.0), &Vector3::z());
        }
    }
    sum / 25.0
}

/// Adds the light reflected by walls and ceiling (the share `around` of the direct light), that of the windows, and that reflected by the carpet.
fn lighting(lamps: Vec<Lamp>, paints: &[LinearRgb; N_COLORS], around: f64, window: LinearRgb) -> LampLight {
    let mut light = LampLight { lamps, ..LampLight::default() };
    let direct = mean_irradiance(&light);
    light.ambient = direct * around + window;
    let floor = paints[0] * 0.7 + LinearRgb::new(0.23, 0.21, 0.19) * 0.3;
    light.bounce = floor.component_mul(&(direct + light.ambient)) + (direct * around + window) * 0.5;
    light
}

/// A camera adjusted to the everyday light, as far as its few settings allow.
fn camera<R: Rng + ?Sized>(
    kelvin: f64,
    paints: &[LinearRgb; N_COLORS],
    bright: &LampLight,
    rng: &mut R,
) -> Result<CameraParams, SimulationError> {
    let off = |preset: f64| (1.0 / preset - 1.0 / kelvin).abs();
    let mut presets = WHITE_BALANCES_K;
    presets.sort_by(|a, b| off(*a).total_cmp(&off(*b)));
    let preset = presets[usize::from(chance(0.35, rng))];
    let illuminant = black_body(preset);
    let white_balance = illuminant.map(|channel| 1.0 / channel.max(0.15));
    let white = paints[1].component_mul(&mean_irradiance(bright)).component_mul(&white_balance);
    let level = uniform(0.65, 1.1, rng);
    let own = CameraParams::ers7()?;
    Ok(CameraParams {
        gain: level / white.y,
        white_balance,
        vignetting: own.vignetting * uniform(0.8, 1.2, rng),
        crosstalk: uniform(0.12, 0.17, rng),
        gamma: uniform(0.45, 0.6, rng),
        ..own
    })
}
