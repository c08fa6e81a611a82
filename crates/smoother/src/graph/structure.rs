use std::sync::Arc;

use super::{factor_graph::Graph, values::Values};
use crate::{
    SmootherError,
    linear::{
        block_address::BlockAddress,
        cholesky::{Cholesky, NotPositive},
        normal_equations::NormalEquations,
        pattern::Pattern,
    },
};

/// What depends on which variable meets which, and on no value.
pub(crate) struct Structure {
    /// First row of each variable in the system; `None` for fixed ones.
    pub(crate) offsets: Vec<Option<usize>>,
    dims: Vec<usize>,
    /// Blocks of the residuals of each batch.
    blocks: Vec<Vec<BlockAddress>>,
    pub(crate) equations: NormalEquations,
    pub(crate) cholesky: Cholesky,
    /// Damping of the present factor; `None` when there is none.
    factored: Option<f64>,
}

impl Structure {
    pub(crate) fn new(graph: &Graph) -> Result<Self, SmootherError> {
        let free: Vec<usize> = (0..graph.dims.len()).filter(|index| !graph.fixed[*index]).collect();
        let mut block_of = vec![None; graph.dims.len()];
        for (block, index) in free.iter().enumerate() {
            block_of[*index] = Some(block);
        }
        without_residual(graph, &free)?;
        let mut pairs = Vec::new();
        for_each_pair(graph, |_, a, b| {
            if let (Some(a), Some(b)) = (block_of[a], block_of[b])
                && a != b
            {
                pairs.push((a, b));
            }
        });
        let dims: Vec<usize> = free.iter().map(|index| graph.dims[*index]).collect();
        let pattern = Arc::new(Pattern::new(&dims, &pairs)?);
        let cholesky = Cholesky::new(&pattern)?;
        let mut blocks = vec![Vec::new(); graph.batches.len()];
        for_each_pair(graph, |batch, a, b| {
            let address = block_of[a].zip(block_of[b]).and_then(|(a, b)| pattern.address(a, b));
            blocks[batch].push(address.unwrap_or(BlockAddress::NOWHERE));
        });
        let offsets = block_of.iter().map(|block| block.map(|block| pattern.offset(block))).collect();
        Ok(Self {
            offsets,
            dims: graph.dims.clone(),
            blocks,
            equations: NormalEquations::zeros(pattern),
            cholesky,
            factored: None,
        })
    }

    /// Sums the normal equations at `values`; the cost.
    pub(crate) fn linearize(
        &mut self,
        graph: &Graph,
        values: &Values,
        mu: f64,
    ) -> Result<f64, SmootherError> {
        self.equations.clear();
        self.factored = None;
        let mut cost = 0.0;
        for (batch, blocks) in graph.batches.iter().zip(&self.blocks) {
            cost += batch.linearize(values, mu, blocks, &self.offsets, &mut self.equations);
        }
        if cost.is_finite() && self.equations.is_finite() {
            Ok(cost)
        } else {
            Err(graph.locate_not_finite(values))
        }
    }

    /// Number of rows of a variable that is not fixed.
    pub(crate) fn dim(&self, variable: usize) -> usize {
        self.dims[variable]
    }

    /// Factorizes $`H + λ D`$, unless that is the present factor.
    pub(crate) fn factorize(&mut self, lambda: f64) -> Result<(), NotPositive> {
        if self.factored == Some(lambda) {
            return Ok(());
        }
        self.factored = None;
        if lambda == 0.0 {
            self.cholesky.factorize(self.equations.entries())?;
        } else {
            let mut damped = self.equations.entries().to_vec();
            for (column, scale) in self.scale().iter().enumerate() {
                damped[self.equations.pattern().diagonal_entry(column)] += lambda * scale;
            }
            self.cholesky.factorize(&damped)?;
        }
        self.factored = Some(lambda);
        Ok(())
    }

    /// $`-(H + λ D)^{-1} g`$ with the present factor.
    pub(crate) fn solve(&self) -> Result<Vec<f64>, SmootherError> {
        let mut step: Vec<f64> = self.equations.gradient().iter().map(|entry| -entry).collect();
        self.cholesky.solve_in_place(&mut step)?;
        Ok(step)
    }

    /// $`D`$: the diagonal of $`H`$, and 1 where that is 0.
    pub(crate) fn scale(&self) -> Vec<f64> {
        self.equations.diagonal().iter().map(|entry| if *entry > 0.0 { *entry } else { 1.0 }).collect()
    }

    pub(crate) fn ill_conditioned(&self) -> SmootherError {
        let diagonal = self.equations.diagonal();
        let (smallest, largest) =
            diagonal.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), d| (low.min(*d), high.max(*d)));
        SmootherError::IllConditioned { smallest, largest }
    }
}

/// Every pair of variables of every residual, in the order in which Jacobians are multiplied.
fn for_each_pair(graph: &Graph, mut each: impl FnMut(usize, usize, usize)) {
    for (number, batch) in graph.batches.iter().enumerate() {
        for variables in batch.variables() {
            for (place, a) in variables.iter().enumerate() {
                for b in &variables[place..] {
                    each(number, *a, *b);
                }
            }
        }
    }
}

fn without_residual(graph: &Graph, free: &[usize]) -> Result<(), SmootherError> {
    let mut has_residual = vec![false; graph.dims.len()];
    for_each_pair(graph, |_, a, _| has_residual[a] = true);
    let variables: Vec<usize> = free.iter().copied().filter(|index| !has_residual[*index]).collect();
    if variables.is_empty() { Ok(()) } else { Err(SmootherError::WithoutResidual { variables }) }
}
