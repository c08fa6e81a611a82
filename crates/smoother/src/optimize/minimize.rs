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
const NOTHING_TO_GAIN: f64 = 1e-12;

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
        let (accepted, predicted) = loop {
            // Solve.
            let Some(step) = damping.step(structure)? else { break (None, 0.0) };
            // Retract.
            candidate.retract_from(&values, &structure.offsets, &step.delta);
            // Judge.
            let new_cost = graph.cost_at(&candidate, mu);
            if damping.judge(cost, new_cost, &step, structure) {
                break (Some(new_cost), step.predicted);
            }
            if step.predicted <= NOTHING_TO_GAIN + params.relative_decrease * cost {
                break (None, step.predicted);
            }
        };
        let Some(new_cost) = accepted else {
            stop = if predicted <= NOTHING_TO_GAIN + params.relative_decrease * cost {
                Stop::Converged
            } else {
                Stop::NoDecrease
            };
            break;
        };
        if !new_cost.is_finite() {
            return Err(SmootherError::Diverged { iteration: iterations });
        }
        std::mem::swap(&mut values, &mut candidate);
        cost = new_cost;
        if predicted <= NOTHING_TO_GAIN + params.relative_decrease * cost {
            stop = Stop::Converged;
            break;
        }
    }
    graph.values = values;
    Ok(Summary { start_cost, cost, iterations, stop })
}
