//! How the features of every state answer to shifts and to light, by finite differences.

use nalgebra::{DMatrix, DVector};

use crate::{
    CondensationError, GlobalDescriptor, LightChange, N_DISTURBANCES, StateDescriptorTable, ViewSource,
};

/// Pixels of a shift for the derivative.
const SHIFT: i32 = 4;
/// Factor of the gain, which goes down so that nothing white is clipped.
const DIM: f64 = 0.8;
/// Grey levels of the offset, on top of the dimmed scene.
const LIFT: f64 = 25.0;
/// Factor of gamma.
const BEND: f64 = 1.1;
/// Shifts on which the linear answer is tried: the longest that the method is meant for, all around.
const TRIALS: [(i32, i32); 8] = [(5, 0), (4, 4), (0, 5), (-4, 4), (-5, 0), (-4, -4), (0, -5), (4, -4)];

/// The linear answer, and what it misses.
pub(super) struct Response {
    /// $`A_s`$, a column a coordinate of the disturbance.
    pub(super) sensitivities: Vec<DMatrix<f64>>,
    /// What is left when the answer is subtracted: one list over the states a trial.
    pub(super) residuals: Vec<Vec<DVector<f64>>>,
}

impl Response {
    pub(super) fn measure(
        source: &dyn ViewSource,
        feature: &dyn GlobalDescriptor,
        light: &LightChange,
        features: &StateDescriptorTable,
    ) -> Result<Self, CondensationError> {
        let shifted = |dx, dy| source.features(feature, (dx, dy), light);
        let relit = |light: LightChange| source.features(feature, (0, 0), &light);
        let (right, left) = (shifted(SHIFT, 0)?, shifted(-SHIFT, 0)?);
        let (down, up) = (shifted(0, SHIFT)?, shifted(0, -SHIFT)?);
        let dim = LightChange { gain: light.gain * DIM, ..*light };
        let dimmed = relit(dim)?;
        let lifted = relit(LightChange { offset: light.offset + LIFT, ..dim })?;
        let bent = relit(LightChange { gamma: light.gamma * BEND, ..*light })?;
        let unbent = relit(LightChange { gamma: light.gamma / BEND, ..*light })?;

        let sensitivity = |state: usize| {
            let moved = |shift| source.displacement(state, shift);
            let columns = [
                (&right, &left, moved((SHIFT, 0)).0 - moved((-SHIFT, 0)).0),
                (&down, &up, moved((0, SHIFT)).1 - moved((0, -SHIFT)).1),
                (features, &dimmed, light.gain * (1.0 - DIM)),
                (&lifted, &dimmed, LIFT),
                (&bent, &unbent, 2.0 * BEND.ln()),
            ];
            let mut answer = DMatrix::zeros(features.n_components(), N_DISTURBANCES);
            for (j, (plus, minus, change)) in columns.into_iter().enumerate() {
                // A scene as wide as its view leaves no room to shift: then nothing is learned of shifts.
                if change > 0.0 {
                    answer.set_column(j, &(difference(plus, minus, state) / change));
                }
            }
            answer
        };
        let sensitivities: Vec<_> = (0..source.n_states()).map(sensitivity).collect();
        let residuals = TRIALS.into_iter().map(|shift| {
            let table = shifted(shift.0, shift.1)?;
            let residual = |(state, answer): (usize, &DMatrix<f64>)| {
                let (dx, dy) = source.displacement(state, shift);
                difference(&table, features, state) - answer.column(0) * dx - answer.column(1) * dy
            };
            Ok(sensitivities.iter().enumerate().map(residual).collect())
        });
        let residuals = residuals.collect::<Result<_, CondensationError>>()?;
        Ok(Self { sensitivities, residuals })
    }
}

fn difference(plus: &StateDescriptorTable, minus: &StateDescriptorTable, state: usize) -> DVector<f64> {
    DVector::from_row_slice(plus.row(state)) - DVector::from_row_slice(minus.row(state))
}
