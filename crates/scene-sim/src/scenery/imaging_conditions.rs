use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::RgbPicture;
use crate::random::deviate::quick_normal;
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::{SimulationError, check};

/// Appearance of a scene on a later visit: another camera, another light, and another position.
///
/// The steps, in order: a shift of some pixels; light that falls off from the middle, with a colour cast; exposure; a power and an S-shaped
/// response; a black and a white level; and noise that grows with brightness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagingConditions {
    /// Camera shift to the right and down, px; fractions interpolate. Default (3.4, −2.6).
    pub shift_px: (f64, f64),
    /// Factors of red, green and blue. Default a lamp a little warmer than daylight: 1.05, 1, 0.92.
    pub cast: [f64; 3],
    /// Share of the light that is lost in the corners, growing with the square of the distance. Default 0.08.
    pub falloff: f64,
    /// Factor of the light on the sensor. Default 0.9.
    pub exposure: f64,
    /// Exponent of the light on the sensor. Default 1.
    pub gamma: f64,
    /// Steepness of the response at half its range: a logistic curve, nearly straight below 1. Default 3.
    pub steepness: f64,
    /// Grey levels of black and of white. Default 22 and 212.
    pub levels: (f64, f64),
    /// Standard deviation of the noise of a white pixel, in grey levels; black has half of it. Default 3.
    pub noise: f64,
}

impl Default for ImagingConditions {
    fn default() -> Self {
        Self {
            shift_px: (3.4, -2.6),
            cast: [1.05, 1.0, 0.92],
            falloff: 0.08,
            exposure: 0.9,
            gamma: 1.0,
            steepness: 3.0,
            levels: (22.0, 212.0),
            noise: 3.0,
        }
    }
}

impl ImagingConditions {
    /// Gain 0.7, offset 20 grey levels, gamma 1.3 and noise, equal everywhere and in all three colours, with a camera shift of (4, 3) pixels.
    ///
    /// The steepness is so small that the response is linear to 1e-8 of its range.
    pub fn dimmed() -> Self {
        Self {
            shift_px: (4.0, 3.0),
            cast: [1.0; 3],
            falloff: 0.0,
            exposure: 1.0,
            gamma: 1.3,
            steepness: 1e-3,
            levels: (20.0, 198.5),
            ..Self::default()
        }
    }

    /// The picture of `scene` on this visit. Beyond the edge the last pixel repeats.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] if a number is not finite or has the wrong sign, or if the image has another number of bytes than
    /// its size requires.
    pub fn picture_of(&self, scene: &RgbPicture, seed: u64) -> Result<RgbPicture, SimulationError> {
        self.check()?;
        let n_bytes = scene.width.saturating_mul(scene.height).saturating_mul(3);
        if scene.rgb.len() != n_bytes {
            let (what, value) = ("bytes of the picture", scene.rgb.len() as f64);
            return Err(SimulationError::Parameter { what, value, must: "3 · width · height" });
        }
        let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(seed));
        let rng = streams.of(RandomStreamPurpose::Pixels);
        let mut rgb = Vec::with_capacity(n_bytes);
        for y in 0..scene.height {
            for x in 0..scene.width {
                let seen = interpolated(scene, x as f64 + self.shift_px.0, y as f64 + self.shift_px.1);
                let light = self.light(scene, x, y);
                for (value, cast) in seen.into_iter().zip(self.cast) {
                    let response = self.response(libm::pow(value * cast * light, self.gamma));
                    let sigma = self.noise * (0.5 + 0.5 * response);
                    let (black, white) = self.levels;
                    let level = black + (white - black) * response + sigma * quick_normal(rng);
                    rgb.push(level.round().clamp(0.0, 255.0) as u8);
                }
            }
        }
        Ok(RgbPicture { rgb, ..*scene })
    }

    fn light(&self, scene: &RgbPicture, x: usize, y: usize) -> f64 {
        let off = |at: usize, len: usize| (2.0 * at as f64 + 1.0) / len as f64 - 1.0;
        let (u, v) = (off(x, scene.width), off(y, scene.height));
        self.exposure * (1.0 - self.falloff * 0.5 * (u * u + v * v))
    }

    /// From [0, 1] to [0, 1]; more light than 1 saturates.
    fn response(&self, light: f64) -> f64 {
        let logistic = |value: f64| 1.0 / (1.0 + libm::exp(-self.steepness * (value - 0.5)));
        let (dark, bright) = (logistic(0.0), logistic(1.0));
        ((logistic(light.min(1.0)) - dark) / (bright - dark)).clamp(0.0, 1.0)
    }

    fn check(&self) -> Result<(), SimulationError> {
        check::finite("shift to the right", self.shift_px.0)?;
        check::finite("shift down", self.shift_px.1)?;
        self.cast.into_iter().try_for_each(|factor| check::positive("cast of colour", factor))?;
        check::share("falloff", self.falloff)?;
        check::positive("exposure", self.exposure)?;
        check::positive("gamma", self.gamma)?;
        check::positive("steepness", self.steepness)?;
        check::not_negative("black level", self.levels.0)?;
        check::above("white level", self.levels.1, self.levels.0, "finite and above the black level")?;
        check::not_negative("noise", self.noise)
    }
}

/// The colour between four pixels, in [0, 1].
fn interpolated(scene: &RgbPicture, x: f64, y: f64) -> [f64; 3] {
    let (x, y) = (x.clamp(0.0, (scene.width - 1) as f64), y.clamp(0.0, (scene.height - 1) as f64));
    let (left, top) = (x.floor(), y.floor());
    let (u, v) = (x - left, y - top);
    let value = |dx: usize, dy: usize, c: usize| {
        let column = (left as usize + dx).min(scene.width - 1);
        let row = (top as usize + dy).min(scene.height - 1);
        f64::from(scene.rgb[3 * (row * scene.width + column) + c]) / 255.0
    };
    [0, 1, 2].map(|c| {
        let upper = value(0, 0, c) * (1.0 - u) + value(1, 0, c) * u;
        let lower = value(0, 1, c) * (1.0 - u) + value(1, 1, c) * u;
        upper * (1.0 - v) + lower * v
    })
}
