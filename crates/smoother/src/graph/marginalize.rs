use super::{dense_quadratic::DenseQuadratic, factor_graph::Graph, linear_prior::LinearPrior};
use crate::SmootherError;

/// What a marginalization dropped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marginalized {
    /// Variables that are gone.
    pub n_variables: usize,
    /// Residuals that named them: linearized for good.
    pub n_residuals: usize,
    /// Numbers of the variables that share what was known of the dropped ones, in ascending order.
    pub neighbours: Vec<usize>,
}

pub(super) fn marginalize(graph: &mut Graph, variables: &[usize]) -> Result<Marginalized, SmootherError> {
    let chosen = choose(graph, variables)?;
    let (dropped, neighbours) = split(graph, &chosen);
    let all: Vec<usize> = dropped.iter().chain(&neighbours).copied().collect();
    let mut quadratic = DenseQuadratic::zeros(&all, &graph.dims);
    for batch in &graph.batches {
        batch.linearize_chosen(&graph.values, &chosen, &mut quadratic);
    }
    if !quadratic.constant.is_finite() || quadratic.hessian.iter().any(|entry| !entry.is_finite()) {
        return Err(graph.locate_not_finite(&graph.values));
    }
    let diagonal = quadratic.hessian.diagonal();
    let (smallest, largest) = (diagonal.min(), diagonal.max());
    let n_dropped = dropped.iter().map(|variable| graph.dims[*variable]).sum();
    let rest =
        quadratic.without_first(n_dropped).ok_or(SmootherError::IllConditioned { smallest, largest })?;

    let n_residuals = graph.batches.iter_mut().map(|batch| batch.remove_chosen(&chosen)).sum();
    let n_variables = discard(graph, &chosen);
    if !neighbours.is_empty() {
        let points = neighbours.iter().map(|variable| graph.values.linear_point(*variable)).collect();
        let DenseQuadratic { hessian, gradient, constant, .. } = rest;
        graph.add_prior(LinearPrior { variables: neighbours.clone(), points, hessian, gradient, constant });
    }
    Ok(Marginalized { n_variables, n_residuals, neighbours })
}

pub(super) fn remove(graph: &mut Graph, variables: &[usize]) -> Result<Marginalized, SmootherError> {
    let chosen = choose(graph, variables)?;
    let priors = graph.batches.iter().filter(|batch| batch.is_of_marginalization());
    let is_in_a_prior =
        priors.flat_map(|batch| batch.variables()).any(|named| named.iter().any(|index| chosen[*index]));
    let own = graph.batches.iter_mut().filter(|batch| !batch.is_of_marginalization());
    let n_residuals: usize = own.map(|batch| batch.remove_chosen(&chosen)).sum();
    graph.structure = None;
    if is_in_a_prior {
        return marginalize(graph, variables);
    }
    let n_variables = discard(graph, &chosen);
    Ok(Marginalized { n_variables, n_residuals, neighbours: Vec::new() })
}

fn choose(graph: &Graph, variables: &[usize]) -> Result<Vec<bool>, SmootherError> {
    let mut chosen = vec![false; graph.dims.len()];
    for variable in variables {
        if !graph.values.is_present(*variable) {
            return Err(SmootherError::UnknownId);
        }
        chosen[*variable] = true;
    }
    Ok(chosen)
}

/// The chosen variables that are not fixed, and the others that residuals of chosen ones name.
fn split(graph: &Graph, chosen: &[bool]) -> (Vec<usize>, Vec<usize>) {
    let mut is_neighbour = vec![false; chosen.len()];
    for named in graph.batches.iter().flat_map(|batch| batch.variables()) {
        if named.iter().any(|variable| chosen[*variable]) {
            named.iter().for_each(|variable| is_neighbour[*variable] = true);
        }
    }
    let of = |wanted: bool| {
        (0..chosen.len())
            .filter(|index| is_neighbour[*index] && chosen[*index] == wanted && !graph.fixed[*index])
            .collect()
    };
    (of(true), of(false))
}

/// Removes the chosen variables; how many.
fn discard(graph: &mut Graph, chosen: &[bool]) -> usize {
    graph.structure = None;
    for variable in (0..chosen.len()).filter(|index| chosen[*index]) {
        graph.values.remove(variable);
        graph.fixed[variable] = true; // no rows in the system
    }
    chosen.iter().filter(|chosen| **chosen).count()
}
