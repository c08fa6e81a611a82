use nalgebra::{DefaultAllocator, Dim};
use rand::Rng;

use super::{
    LawViolation,
    check::{rounding, within},
};
use crate::{Manifold, MotionModel, SampleMotion, StateAlloc, Tangent, TangentMatrix, to_f64};

/// Standard errors that an average may be off. One in 1.7 million averages of a correct model is further out; a suite of 27 entries (a spatial pose)
/// raises a false alarm once in 60 000 seeds.
const STANDARD_ERRORS: f64 = 5.0;

/// Samples of `sampler` have the mean and covariance that `model` says, and the same generator gives the same sample.
///
/// Standard errors of `n` normal samples: $`\sqrt{Q_{ii}/n}`$ of a mean, $`\sqrt{(Q_{ii} Q_{jj} + Q_{ij}^2)/n}`$ of a covariance; each may be off by five.
/// The bend of a nonlinear sampler adds an error of the order of $`Q`$: choose noise small enough to stay below, and `n` some 10 000.
///
/// # Errors
/// The first moment that is off.
pub fn sample_motion<S, M, R>(
    sampler: &S,
    model: &M,
    states_and_controls: &[(M::State, &M::Control)],
    n: usize,
    rng: &mut R,
) -> Result<(), LawViolation>
where
    M: MotionModel,
    S: SampleMotion<State = M::State, Control = M::Control>,
    R: Rng + Clone,
    DefaultAllocator: StateAlloc<<M::State as Manifold>::Dim>,
{
    for (index, (state, control)) in states_and_controls.iter().enumerate() {
        let draw = sampler.sampler::<R>(control);
        let centre = model.propagate(state, control);
        let (first, second) = (draw(state, &mut rng.clone()), draw(state, &mut rng.clone()));
        let difference = to_f64((centre.local(&first) - centre.local(&second)).norm());
        within("the same generator gives the same sample", difference, 0.0, || format!("at {index}"))?;
        let deviations: Vec<_> = (0..n).map(|_| centre.local(&draw(state, rng))).collect();
        moments_agree::<M::State>(&deviations, &model.noise(state, control), index)?;
    }
    Ok(())
}

fn moments_agree<X: Manifold>(
    deviations: &[Tangent<X>],
    noise: &TangentMatrix<X>,
    index: usize,
) -> Result<(), LawViolation>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    let n = deviations.len() as f64;
    let average = |term: &dyn Fn(&Tangent<X>) -> f64| deviations.iter().map(term).sum::<f64>() / n;
    let q = |i: usize, j: usize| to_f64(noise[(i, j)]);
    let dim = noise.shape_generic().0.value();
    let slack = rounding::<X::Scalar>(1.0);
    for i in 0..dim {
        let mean = average(&|d| to_f64(d[i]));
        let bound = STANDARD_ERRORS * (q(i, i) / n).sqrt() + slack;
        within("samples have the model's mean", mean.abs(), bound, || format!("at {index}, axis {i}"))?;
        for j in 0..=i {
            let product = average(&|d| to_f64(d[i]) * to_f64(d[j]));
            let bound = STANDARD_ERRORS * ((q(i, i) * q(j, j) + q(i, j).powi(2)) / n).sqrt() + slack;
            let case = || format!("at {index}, axes {i} and {j}");
            within("samples have the model's covariance", (product - q(i, j)).abs(), bound, case)?;
        }
    }
    Ok(())
}
