/// Where belief goes in one step: $`\hat b(s') = \sum_s p(s' \mid s)\, b(s)`$. [Kasprzak & Szynkiewicz, Eqs. 3–4]
///
/// Linear, so it carries any quantity that goes with the state, not belief alone. **Laws**: what comes out has the sum of what
/// went in; nonnegative stays nonnegative.
pub trait TransitionModel {
    /// Number of states.
    fn n_states(&self) -> usize;

    /// Writes what becomes of `belief` into `predicted`. Both have [`n_states`](Self::n_states) elements.
    fn predict(&self, belief: &[f64], predicted: &mut [f64]);
}

impl<T: TransitionModel + ?Sized> TransitionModel for &T {
    fn n_states(&self) -> usize {
        (**self).n_states()
    }

    fn predict(&self, belief: &[f64], predicted: &mut [f64]) {
        (**self).predict(belief, predicted);
    }
}
