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

impl Graph {
    /// Takes variables back, by their numbers, with the residuals that name them; what earlier marginalizations say of them is marginalized.
    ///
    /// # Errors
    /// As [`marginalize`](Self::marginalize).
    pub fn remove_variables(&mut self, variables: &[usize]) -> Result<Marginalized, SmootherError> {
        let chosen = choose(self, variables)?;
        let priors = self.batches.iter().filter(|batch| batch.is_of_marginalization());
        let is_in_a_prior =
            priors.flat_map(|batch| batch.variables()).any(|named| named.iter().any(|index| chosen[*index]));
        let own = self.batches.iter_mut().filter(|batch| !batch.is_of_marginalization());
        let n_residuals: usize = own.map(|batch| batch.remove_chosen(&chosen)).sum();
        self.forget();
        if is_in_a_prior {
            return self.marginalize(variables);
        }
        let n_variables = discard(self, &chosen);
        Ok(Marginalized { n_variables, n_residuals, neighbours: Vec::new() })
    }

    /// Drops variables, by their numbers ([`VariableId::index`](crate::VariableId::index)), and keeps what their residuals say about the others.
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
        let chosen = choose(self, variables)?;
        let (dropped, neighbours) = split(self, &chosen);
        let all: Vec<usize> = dropped.iter().chain(&neighbours).copied().collect();
        let mut quadratic = DenseQuadratic::zeros(&all, &self.dims);
        for batch in &self.batches {
            batch.linearize_chosen(&self.values, &chosen, &mut quadratic);
        }
        if !quadratic.constant.is_finite() || quadratic.hessian.iter().any(|entry| !entry.is_finite()) {
            return Err(self.locate_not_finite(&self.values));
        }
        let diagonal = quadratic.hessian.diagonal();
        let (smallest, largest) = (diagonal.min(), diagonal.max());
        let n_dropped = dropped.iter().map(|variable| self.dims[*variable]).sum();
        let rest =
            quadratic.without_first(n_dropped).ok_or(SmootherError::IllConditioned { smallest, largest })?;

        let n_residuals = self.batches.iter_mut().map(|batch| batch.remove_chosen(&chosen)).sum();
        let n_variables = discard(self, &chosen);
        if !neighbours.is_empty() {
            let points = neighbours.iter().map(|variable| self.values.linear_point(*variable)).collect();
            let DenseQuadratic { hessian, gradient, constant, .. } = rest;
            self.add_prior(LinearPrior {
                variables: neighbours.clone(),
                points,
                hessian,
                gradient,
                constant,
            });
        }
        Ok(Marginalized { n_variables, n_residuals, neighbours })
    }
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
    graph.forget();
    for variable in (0..chosen.len()).filter(|index| chosen[*index]) {
        graph.values.remove(variable);
        graph.fixed[variable] = true; // no rows in the system
    }
    chosen.iter().filter(|chosen| **chosen).count()
}
