use rand::Rng;

use super::light::LightKind;
use crate::random::deviate::{below, chance, normal, uniform};
use crate::random::{GaussMarkovProcess, RandomStreamPurpose, RandomStreams};
use crate::{SimulationError, check};

/// Ambient light, so that nothing is completely black.
const STRAY: [f32; 3] = [0.12; 3];

/// Parameters of the change of light during a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientLightParams {
    /// Standard deviation of the logarithm of the daylight: clouds. Default 0.35.
    pub daylight_log_sigma: f64,
    /// Correlation time of the daylight, seconds. Default 600.
    pub daylight_correlation_s: f64,
    /// Standard deviation of the logarithm of each group of lamps from one drive to the next: some fail, some are new. Default 0.1.
    pub lamp_log_sigma_between_drives: f64,
    /// Mean time between two changes by people who switch lamps and draw curtains, s; `None` for no changes. Default `None`.
    pub mean_lamp_switching_s: Option<f64>,
}

impl Default for AmbientLightParams {
    fn default() -> Self {
        Self {
            daylight_log_sigma: 0.35,
            daylight_correlation_s: 600.0,
            lamp_log_sigma_between_drives: 0.1,
            mean_lamp_switching_s: None,
        }
    }
}

impl AmbientLightParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Returns an error with the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), SimulationError> {
        check::not_negative("σ of the daylight", self.daylight_log_sigma)?;
        check::positive("correlation time of the daylight (s)", self.daylight_correlation_s)?;
        check::not_negative("σ of the lamps", self.lamp_log_sigma_between_drives)?;
        check::positive("time between switchings (s)", self.mean_lamp_switching_s.unwrap_or(1.0))
    }
}

/// Lamps, curtains and daylight of a moment.
#[derive(Clone, Debug)]
pub(super) struct AmbientLight {
    params: AmbientLightParams,
    /// Light from everywhere.
    pub(super) stray: [f32; 3],
    /// Share of its full light that each group of lamps gives.
    lamps: Vec<f64>,
    /// Which share of its window each curtain leaves open.
    pub(super) curtains: Vec<f64>,
    /// Brightness of the day, 1 for a typical day.
    pub(super) daylight: f64,
    clouds: GaussMarkovProcess,
}

impl AmbientLight {
    pub(super) fn new(
        params: AmbientLightParams,
        n_lamps: usize,
        n_curtains: usize,
        streams: &mut RandomStreams,
    ) -> Self {
        let rng = streams.of(RandomStreamPurpose::Lamps);
        let lamps = (0..n_lamps).map(|_| libm::exp(params.lamp_log_sigma_between_drives * normal(rng)));
        let clouds = GaussMarkovProcess::new(params.daylight_correlation_s);
        let mut ambient_light =
            Self { params, lamps: lamps.collect(), clouds, ..Self::nominal(0, n_curtains) };
        ambient_light.advance(1.0, streams);
        ambient_light
    }

    /// As the day usually is, every lamp lit and every curtain open.
    pub(super) fn nominal(n_lamps: usize, n_curtains: usize) -> Self {
        Self {
            params: AmbientLightParams::default(),
            stray: STRAY,
            lamps: vec![1.0; n_lamps],
            curtains: vec![1.0; n_curtains],
            daylight: 1.0,
            clouds: GaussMarkovProcess::new(1.0),
        }
    }

    /// Lets time pass.
    pub(super) fn advance(&mut self, seconds: f64, streams: &mut RandomStreams) {
        let clouds = self.clouds.advance(seconds, streams.of(RandomStreamPurpose::Daylight));
        self.daylight = libm::exp(self.params.daylight_log_sigma * clouds);
        let rng = streams.of(RandomStreamPurpose::Switching);
        let share =
            self.params.mean_lamp_switching_s.map_or(0.0, |mean_s| 1.0 - libm::exp(-seconds / mean_s));
        if chance(share, rng) {
            self.switch(rng);
        }
    }

    /// Switches one group of lamps or draws one curtain.
    fn switch<R: Rng + ?Sized>(&mut self, rng: &mut R) {
        let which = below(self.lamps.len() + self.curtains.len(), rng);
        let open = uniform(-0.3, 1.3, rng).clamp(0.0, 1.0);
        match which.checked_sub(self.lamps.len()) {
            Some(curtain) => self.curtains.iter_mut().skip(curtain).take(1).for_each(|share| *share = open),
            None => self.lamps[which] = if self.lamps[which] > 0.0 { 0.0 } else { 1.0 },
        }
    }

    pub(super) fn level(&self, kind: LightKind) -> f64 {
        match kind {
            LightKind::Lamps(number) => self.lamps[number],
            LightKind::Window(number) => self.daylight * (0.04 + 0.96 * self.curtains[number]),
            LightKind::Skylight => self.daylight,
        }
    }
}
