use crate::film::sine_sum::SineSum;
use crate::random::{RandomStreamPurpose, RandomStreams};
use crate::scenery::canvas::Color;
use crate::scenery::noise::Noise;

const SUN: Color = [1.0, 0.93, 0.82];
const SKY: Color = [0.20, 0.24, 0.30];
/// Width of the patches of shade, and how fast they pass.
const SHADE_PX: f64 = 130.0;
const SHADE_PX_S: f64 = 45.0;
/// Share of the sunlight blocked by leaves.
const SHADE: f64 = 0.6;

/// Outdoor light: a sun of varying strength and colour, moving patches of shade, and the sky.
pub(super) struct Daylight {
    strength: SineSum,
    warmth: SineSum,
    leaves: Noise,
}

impl Daylight {
    pub(super) fn new(streams: &mut RandomStreams) -> Self {
        let rng = streams.of(RandomStreamPurpose::Light);
        Self { strength: SineSum::new(6.0, rng), warmth: SineSum::new(9.0, rng), leaves: Noise::new(rng) }
    }

    /// The light everywhere in the picture at one moment.
    pub(super) fn at(&self, seconds: f64) -> impl Fn(f64, f64) -> Color + '_ {
        let (strength, warmth) = (self.strength.between(0.65, 1.15, seconds), 0.12 * self.warmth.at(seconds));
        let sun = [SUN[0] * (1.0 + warmth), SUN[1], SUN[2] * (1.0 - warmth)];
        move |x, y| {
            let leaf = self.leaves.at((x - SHADE_PX_S * seconds) / SHADE_PX, y / SHADE_PX);
            let shade = (3.5 * (leaf - 0.5)).clamp(0.0, 1.0);
            let share = strength * (1.0 - SHADE * shade);
            [0, 1, 2].map(|c| sun[c] * share + SKY[c])
        }
    }
}
