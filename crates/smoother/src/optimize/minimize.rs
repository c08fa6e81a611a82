use super::{
    damping::Damping,
    params::{Params, Stop, Summary},
};
use crate::{
    SmootherError,
    graph::{Graph, structure::Structure},
    unconstrained,
};

/// Below this predicted decrease of χ² nothing is left to gain: a millionth of a standard deviation, squared.
pub(crate) const NOTHING_TO_GAIN: f64 = 1e-12;

/// Minimizes the cost with graduation `mu` from the values of the graph, and stores the minimum there.
pub(super) fn minimize(
    graph: &mut Graph,
    structure: &mut Structure,
    params: &Params,
    mu: f64,
) -> Result<Summary, SmootherError> {
    let mut values = graph.values.clone();
    let mut candidate = values.clone();
    let mut damping = Damping::new(params.method);
    let mut cost = structure.linearize(graph, &values, mu)?;
    let start_cost = cost;
    let mut stop = Stop::IterationLimit;
    let mut iterations = 0;

    while iterations < params.max_iterations {
        iterations += 1;
        // Linearize.
        if iterations > 1 {
            cost = structure.linearize(graph, &values, mu)?;
        }
        if iterations == 1 {
            unconstrained::check(structure)?;
        }
        damping.relinearized();
        let nothing_to_gain = NOTHING_TO_GAIN + params.relative_decrease * cost;
        let mut is_small = false;
        let accepted = loop {
            // Solve.
            let Some(step) = damping.step(structure)? else { break None };
            is_small |= step.is_full && step.predicted <= nothing_to_gain;
            // Retract.
            candidate.retract_from(&values, &structure.offsets, &step.delta);
            // Judge.
            let new_cost = graph.cost_at(&candidate, mu);
            if damping.judge(cost, new_cost, &step, structure) {
                break Some(new_cost);
            }
            if is_small || step.predicted <= NOTHING_TO_GAIN {
                break None;
            }
        };
        if let Some(new_cost) = accepted {
            if !new_cost.is_finite() {
                return Err(SmootherError::Diverged { iteration: iterations });
            }
            std::mem::swap(&mut values, &mut candidate);
            cost = new_cost;
        }
        if is_small || accepted.is_none() {
            stop = if is_small { Stop::Converged } else { Stop::NoDecrease };
            break;
        }
    }
    graph.values = values;
    let factorization_flop = structure.cholesky.flop();
    Ok(Summary { start_cost, cost, iterations, stop, factorization_flop })
}
