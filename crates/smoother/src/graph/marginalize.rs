use super::{
    block_jacobian::BlockJacobian,
    dense_quadratic::DenseQuadratic,
    factor_graph::Graph,
    keys::Keys,
    linear_point::{LinearPoint, RelativePoint},
    linear_prior::LinearPrior,
    values::Values,
};
use crate::{Residual, SmootherError, Variable, VariableId, VariableTuple};

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

impl Graph {
    /// Takes variables back, by their numbers, with the residuals that name them; what earlier marginalizations say of them is marginalized.
    ///
    /// # Errors
    /// As [`marginalize`](Self::marginalize).
    pub fn remove_variables(&mut self, variables: &[usize]) -> Result<Marginalized, SmootherError> {
        remove(self, variables)
    }

    /// Drops variables, by their numbers ([`VariableId::index`]), and keeps what their residuals say about the others.
    ///
    /// The residuals that name them are replaced by a quadratic in the other variables, about the present values: the Schur complement of the
    /// dropped ones. Where these residuals are linear, nothing is lost; else their linearization, and the weight of their kernels, is final.
    /// [Sibley et al. 2010, section 3.2; Dong-Si and Mourikis 2011]
    ///
    /// ```
    /// use nalgebra::{Matrix1, Vector1};
    /// use wayfix_smoother::{Graph, Params};
    /// # use wayfix_smoother::Residual;
    /// # struct Step(f64);
    /// # impl Residual for Step {
    /// #     type Dim = nalgebra::Const<1>;
    /// #     type Variables = (Vector1<f64>, Vector1<f64>);
    /// #     fn value(&self, (a, b): (&Vector1<f64>, &Vector1<f64>)) -> Vector1<f64> { b - a - Vector1::new(self.0) }
    /// # }
    /// let mut graph = Graph::new();
    /// let [a, b, c] = [0.0, 0.9, 2.2].map(|x| graph.add_variable(Vector1::new(x)));
    /// graph.fix(a)?;
    /// graph.add(Step(1.0), (a, b), Matrix1::new(4.0))?; // the residual b - a - 1
    /// graph.add(Step(1.0), (b, c), Matrix1::new(4.0))?;
    /// let dropped = graph.marginalize(&[a.index(), b.index()])?;
    /// assert_eq!((dropped.n_residuals, dropped.neighbours), (2, vec![c.index()]));
    /// graph.optimize(&Params::default())?;
    /// assert!((graph.value(c)?.x - 2.0).abs() < 1e-9 && graph.value(b).is_err());
    /// # Ok::<(), wayfix_smoother::SmootherError>(())
    /// ```
    ///
    /// # Errors
    /// * [`SmootherError::UnknownId`] for a number of no variable.
    /// * [`SmootherError::IllConditioned`] when the others do not determine them.
    /// * [`SmootherError::NotFinite`].
    ///
    /// The graph stays as it was.
    pub fn marginalize(&mut self, variables: &[usize]) -> Result<Marginalized, SmootherError> {
        marginalize(self, variables, None, Values::linear_point)
    }

    /// As [`marginalize`](Self::marginalize), with the kept variables of one type in coordinates relative to a base: landmarks in the frame of a pose.
    ///
    /// Coordinates that no motion of the whole map changes make the quadratic hold for every such motion. In others, each new linearization
    /// would add information about it that nobody measured. [Huai and Huang 2018]
    ///
    /// `coordinates` is a residual between base and variable whose value, up to a constant, is the coordinates. They are not used with a fixed base.
    ///
    /// # Errors
    /// As [`marginalize`](Self::marginalize), and [`SmootherError::UnknownId`] for a base that is dropped.
    pub fn marginalize_relative<R, B, X>(
        &mut self,
        variables: &[usize],
        coordinates: &R,
        base: VariableId<B>,
    ) -> Result<Marginalized, SmootherError>
    where
        R: Residual<Variables = (B, X)> + Clone,
        (B, X): VariableTuple<R::Dim>,
        B: Variable,
        X: Variable,
    {
        self.value(base)?;
        if variables.contains(&base.index) {
            return Err(SmootherError::UnknownId);
        }
        if self.fixed[base.index] {
            return self.marginalize(variables); // nothing moves as a whole
        }
        let point_of = |values: &Values, index: usize| match values.slot_of::<X>(index) {
            Some(slot) if index != base.index => {
                let keys = Keys { slots: [base.slot, slot, 0, 0], indices: [base.index, index, 0, 0] };
                Box::new(RelativePoint::new(coordinates.clone(), keys, values)) as Box<dyn LinearPoint>
            }
            _ => values.linear_point(index),
        };
        marginalize(self, variables, Some(base.index), point_of)
    }
}

/// `base` has to be among the variables that are kept; `point_of` tells from where the difference of a kept variable counts.
fn marginalize(
    graph: &mut Graph,
    variables: &[usize],
    base: Option<usize>,
    point_of: impl Fn(&Values, usize) -> Box<dyn LinearPoint>,
) -> Result<Marginalized, SmootherError> {
    let chosen = choose(graph, variables)?;
    let (dropped, neighbours) = split(graph, &chosen, base);
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

    let points: Vec<_> = neighbours.iter().map(|variable| point_of(&graph.values, *variable)).collect();
    let (_, jacobian) = BlockJacobian::of(&neighbours, &points, &graph.values);
    let to_tangent = jacobian.inverse().ok_or(SmootherError::IllConditioned { smallest, largest })?;
    let hessian = to_tangent.congruence(&rest.hessian);
    let gradient = to_tangent.transpose_multiply(&rest.gradient);
    if hessian.iter().chain(&gradient).any(|entry| !entry.is_finite()) {
        return Err(SmootherError::NotFinite {
            what: "the coordinates of a marginalization",
            residual: None,
        });
    }

    let n_residuals = graph.batches.iter_mut().map(|batch| batch.remove_chosen(&chosen)).sum();
    let n_variables = discard(graph, &chosen);
    if !neighbours.is_empty() {
        let variables = neighbours.clone();
        graph.add_prior(LinearPrior { variables, points, hessian, gradient, constant: rest.constant });
    }
    Ok(Marginalized { n_variables, n_residuals, neighbours })
}

fn remove(graph: &mut Graph, variables: &[usize]) -> Result<Marginalized, SmootherError> {
    let chosen = choose(graph, variables)?;
    let priors = graph.batches.iter().filter(|batch| batch.is_of_marginalization());
    let is_in_a_prior =
        priors.flat_map(|batch| batch.variables()).any(|named| named.iter().any(|index| chosen[*index]));
    let own = graph.batches.iter_mut().filter(|batch| !batch.is_of_marginalization());
    let n_residuals: usize = own.map(|batch| batch.remove_chosen(&chosen)).sum();
    graph.structure = None;
    if is_in_a_prior {
        return marginalize(graph, variables, None, Values::linear_point);
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
fn split(graph: &Graph, chosen: &[bool], base: Option<usize>) -> (Vec<usize>, Vec<usize>) {
    let mut is_neighbour = vec![false; chosen.len()];
    for named in graph.batches.iter().flat_map(|batch| batch.variables()) {
        if named.iter().any(|variable| chosen[*variable]) {
            named.iter().for_each(|variable| is_neighbour[*variable] = true);
        }
    }
    base.into_iter().for_each(|base| is_neighbour[base] = true);
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
