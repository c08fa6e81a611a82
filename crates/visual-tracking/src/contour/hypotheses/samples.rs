use rand::Rng;
use wayfix_particle::{ParticleSet, Systematic};

use super::super::ContourTrackerParams;
use crate::{ColorDynamics, ColorState, PrincipalColors, TrackingError};

/// The samples $`\mathbf s_{t-1}^{(n)}`$ with their weights, and what the last picture showed of the colours.
#[derive(Clone, Debug)]
pub(in crate::contour) struct Samples {
    particles: ParticleSet<ColorState>,
    measured: ColorState,
    n_drifts: usize,
}

/// Pictures without a measurement after which the samples spread no more: with more, anything of the right shape would be the target.
const MAX_DRIFTS: usize = 5;

/// How much of the newest change of colours counts in their measured velocity.
const VELOCITY_GAIN: f64 = 0.5;

impl Samples {
    /// All at rest.
    pub(in crate::contour) fn at_start(
        colors: &PrincipalColors,
        n_samples: usize,
    ) -> Result<Self, TrackingError> {
        let measured = ColorState::at_rest(colors);
        Ok(Self { particles: ParticleSet::new(vec![measured; n_samples])?, measured, n_drifts: 0 })
    }

    /// Sampling by weight and propagation: the hypotheses about the next picture, of equal weight.
    ///
    /// A share of them starts from the measured colours; the first two of these are what the dynamics expect and no change at all.
    pub(in crate::contour) fn predicted<R: Rng + ?Sized>(
        &self,
        dynamics: &ColorDynamics,
        params: &ContourTrackerParams,
        rng: &mut R,
    ) -> Result<Vec<ColorState>, TrackingError> {
        let mut particles = self.particles.clone();
        particles.resample(&Systematic, params.n_samples, rng)?;
        let n_anchored = (params.anchored_share * params.n_samples as f64).round() as usize;
        particles.states_mut().iter_mut().take(n_anchored).for_each(|state| *state = self.measured);
        particles.propagate(|state, rng| *state = dynamics.propagate(state, rng), rng);
        let mut states = particles.states().to_vec();
        let still = ColorState { velocity: nalgebra::SVector::zeros(), ..self.measured };
        for (state, certain) in
            states.iter_mut().take(n_anchored).zip([dynamics.expected(&self.measured), still])
        {
            *state = certain;
        }
        Ok(states)
    }

    /// The samples one picture later, when there was nothing to weigh them by: they spread.
    pub(in crate::contour) fn drift<R: Rng + ?Sized>(&mut self, dynamics: &ColorDynamics, rng: &mut R) {
        if self.n_drifts < MAX_DRIFTS {
            self.n_drifts += 1;
            self.particles.propagate(|state, rng| *state = dynamics.propagate(state, rng), rng);
        }
    }

    /// The samples after weighing.
    pub(in crate::contour) fn weighed(
        &self,
        states: Vec<ColorState>,
        log_weights: Vec<f64>,
    ) -> Result<Self, TrackingError> {
        let particles = ParticleSet::from_log_weights(states, log_weights)?;
        Ok(Self { particles, measured: self.measured, n_drifts: 0 })
    }

    /// The colours of the last picture become what all angles are counted from.
    pub(in crate::contour) fn measure(&mut self, before: &PrincipalColors, now: &PrincipalColors) {
        let angles = now.angles_since(before);
        let mut change = ColorState::at_rest(now).value - ColorState::at_rest(before).value;
        change.fixed_rows_mut::<2>(6).copy_from_slice(&angles);
        let velocity = self.measured.velocity + (change - self.measured.velocity) * VELOCITY_GAIN;
        self.measured = ColorState { velocity, ..ColorState::at_rest(now) };
        self.particles.states_mut().iter_mut().for_each(|state| *state = state.seen_from(angles));
    }
}
