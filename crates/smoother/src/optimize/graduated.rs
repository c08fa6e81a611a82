use super::{
    minimize::minimize,
    params::{Params, Stop, Summary},
};
use crate::{
    SmootherError,
    graph::{Graph, known_minimum::KnownMinimum, structure::Structure},
};

/// Each stage divides μ by this. [Yang et al. 2020, Remark 5]
const STAGE: f64 = 1.4;

/// Minimizes the cost of a graph: in one stage, or in stages of graduated non-convexity.
///
/// The values are those of before if it fails.
pub(crate) fn run(graph: &mut Graph, params: &Params) -> Result<Summary, SmootherError> {
    params.validate()?;
    if let Some(summary) = at_minimum(graph, params) {
        return Ok(summary);
    }
    let mut structure = match graph.structure.take() {
        Some(structure) => structure,
        None => Structure::new(graph)?,
    };
    let before = params.graduated.then(|| graph.values.clone());
    let result = stages(graph, &mut structure, params);
    if let (Err(_), Some(before)) = (&result, before) {
        graph.values = before;
    }
    graph.structure = Some(structure);
    let minimum = result.as_ref().ok().filter(|summary| summary.stop == Stop::Converged);
    graph.minimum = minimum.map(|summary| KnownMinimum::new(summary.cost, params.relative_decrease));
    result
}

/// Nothing to do: the values are a minimum, as far as the parameters ask. Graduated stages look for another one.
fn at_minimum(graph: &Graph, params: &Params) -> Option<Summary> {
    let minimum = graph.minimum.as_ref()?;
    let is_enough = minimum.is_complete() && minimum.relative_decrease <= params.relative_decrease;
    let (cost, iterations, factorization_flop) = (minimum.cost, 0, 0.0);
    let summary = Summary { start_cost: cost, cost, iterations, stop: Stop::Converged, factorization_flop };
    (is_enough && !params.graduated).then_some(summary)
}

fn stages(graph: &mut Graph, structure: &mut Structure, params: &Params) -> Result<Summary, SmootherError> {
    let start_cost = graph.cost();
    let (mut iterations, mut is_cut) = (0, false);
    if params.graduated {
        let largest =
            graph.batches.iter().map(|batch| batch.largest_graduated(&graph.values)).fold(0.0, f64::max);
        let mut mu = 2.0 * largest; // convex at all residuals [Yang et al. 2020, Remark 5]
        // The last stage gets one iteration at least.
        while mu > 1.0 && mu.is_finite() && iterations + 1 < params.max_iterations {
            let stage = Params { max_iterations: 1, ..*params };
            iterations += minimize(graph, structure, &stage, mu)?.iterations;
            mu /= STAGE;
        }
        is_cut = mu > 1.0 && mu.is_finite();
    }
    let left = params.max_iterations.saturating_sub(iterations).max(1);
    let last = minimize(graph, structure, &Params { max_iterations: left, ..*params }, 1.0)?;
    let stop = if is_cut { Stop::IterationLimit } else { last.stop };
    Ok(Summary { start_cost, iterations: iterations + last.iterations, stop, ..last })
}
