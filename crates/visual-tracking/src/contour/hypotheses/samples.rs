use rand::Rng;
use wayfix_particle::{ParticleSet, SystematicResampler};

use super::super::ColorContourTrackerParams;
use crate::{ColorDistributionState, ColorDynamics, PrincipalColors, TrackingError};

/// The samples $`\mathbf s_{t-1}^{(n)}`$ with their weights, and the colours measured in the last image. [Andrade-Cetto 2005, Figs. 10–11]
#[derive(Clone, Debug)]
pub(in crate::contour) struct Samples {
    particles: ParticleSet<ColorDistributionState>,
    measured: ColorDistributionState,
    n_drifts: usize,
}

/// Number of images without a measurement after which the samples stop spreading; otherwise any object of the right shape would match.
const MAX_DRIFTS: usize = 5;

/// Weight of the newest change of colours in the measured velocity.
const VELOCITY_GAIN: f64 = 0.5;

impl Samples {
    /// All at rest.
    pub(in crate::contour) fn at_start(
        colors: &PrincipalColors,
        n_samples: usize,
    ) -> Result<Self, TrackingError> {
        let measured = ColorDistributionState::at_rest(colors);
        Ok(Self { particles: ParticleSet::new(vec![measured; n_samples])?, measured, n_drifts: 0 })
    }

    /// Draws samples by weight and propagates them: hypotheses of equal weight about the next image.
    ///
    /// A share of them starts from the measured colours; its first two are the prediction of the dynamics and no change at all.
    pub(in crate::contour) fn predicted<R: Rng + ?Sized>(
        &self,
        dynamics: &ColorDynamics,
        params: &ColorContourTrackerParams,
        rng: &mut R,
    ) -> Result<Vec<ColorDistributionState>, TrackingError> {
        let mut particles = self.particles.clone();
        particles.resample(&SystematicResampler, params.n_samples, rng)?;
        let n_anchored = (params.share_from_last_measurement * params.n_samples as f64).round() as usize;
        particles.states_mut().iter_mut().take(n_anchored).for_each(|state| *state = self.measured);
        particles.propagate(|state, rng| *state = dynamics.propagate(state, rng), rng);
        let mut states = particles.states().to_vec();
        let still = ColorDistributionState { velocity: nalgebra::SVector::zeros(), ..self.measured };
        for (state, certain) in
            states.iter_mut().take(n_anchored).zip([dynamics.expected(&self.measured), still])
        {
            *state = certain;
        }
        Ok(states)
    }

    /// Propagates the samples over an image without a measurement: they spread.
    pub(in crate::contour) fn drift<R: Rng + ?Sized>(&mut self, dynamics: &ColorDynamics, rng: &mut R) {
        if self.n_drifts < MAX_DRIFTS {
            self.n_drifts += 1;
            self.particles.propagate(|state, rng| *state = dynamics.propagate(state, rng), rng);
        }
    }

    /// The samples after weighing.
    pub(in crate::contour) fn weighed(
        &self,
        states: Vec<ColorDistributionState>,
        log_weights: Vec<f64>,
    ) -> Result<Self, TrackingError> {
        let particles = ParticleSet::from_log_weights(states, log_weights)?;
        Ok(Self { particles, measured: self.measured, n_drifts: 0 })
    }

    /// Makes the colours of the last image the reference of all angles.
    pub(in crate::contour) fn measure(&mut self, before: &PrincipalColors, now: &PrincipalColors) {
        let angles = now.angles_since(before);
        let mut change =
            ColorDistributionState::at_rest(now).value - ColorDistributionState::at_rest(before).value;
        change.fixed_rows_mut::<2>(6).copy_from_slice(&angles);
        let velocity = self.measured.velocity + (change - self.measured.velocity) * VELOCITY_GAIN;
        self.measured = ColorDistributionState { velocity, ..ColorDistributionState::at_rest(now) };
        self.particles.states_mut().iter_mut().for_each(|state| *state = state.seen_from(angles));
    }
}
