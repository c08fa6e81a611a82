use std::any::Any;

use nalgebra::{DMatrix, DVector};

use super::{
    batch::AnyBatch,
    dense_quadratic::DenseQuadratic,
    values::{LinearPoint, Values},
};
use crate::{
    Kernel, SmootherError,
    linear::{block_address::BlockAddress, normal_equations::NormalEquations},
};

/// What a marginalization leaves: $`δ^T H δ + 2 g^T δ + c`$ with $`δ = x ⊟ x_0`$ over some variables.
pub(crate) struct LinearPrior {
    pub(super) variables: Vec<usize>,
    pub(super) points: Vec<Box<dyn LinearPoint>>,
    pub(super) hessian: DMatrix<f64>,
    pub(super) gradient: DVector<f64>,
    pub(super) constant: f64,
}

/// All of them, with their numbers.
#[derive(Default)]
pub(crate) struct LinearPriors(Vec<(usize, LinearPrior)>);

impl LinearPriors {
    pub(super) fn push(&mut self, prior: LinearPrior, index: usize) {
        self.0.push((index, prior));
    }
}

/// A [`LinearPrior`] at some values.
struct AtValues {
    /// $`∂δ_k / ∂x_k`$ and first coordinate of each variable.
    jacobians: Vec<(usize, DMatrix<f64>)>,
    /// $`H δ + g`$
    slope: DVector<f64>,
    cost: f64,
}

impl LinearPrior {
    fn at(&self, values: &Values) -> AtValues {
        let (mut delta, mut jacobians) = (Vec::with_capacity(self.gradient.len()), Vec::new());
        for point in &self.points {
            let (local, jacobian) = point.local(values);
            jacobians.push((delta.len(), jacobian));
            delta.extend(local);
        }
        let delta = DVector::from_vec(delta);
        let curved = &self.hessian * &delta;
        let cost = delta.dot(&curved) + 2.0 * self.gradient.dot(&delta) + self.constant;
        AtValues { jacobians, slope: curved + &self.gradient, cost }
    }

    fn is_chosen(&self, chosen: &[bool]) -> bool {
        self.variables.iter().any(|variable| chosen[*variable])
    }
}

impl AnyBatch for LinearPriors {
    fn as_any(&self) -> &dyn Any {
        self
    }
    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
    fn len(&self) -> usize {
        self.0.len()
    }
    fn variables(&self) -> Box<dyn Iterator<Item = &[usize]> + '_> {
        Box::new(self.0.iter().map(|(_, prior)| prior.variables.as_slice()))
    }
    fn set_kernel(&mut self, _: usize, _: Kernel) -> bool {
        false
    }
    fn is_of_marginalization(&self) -> bool {
        true
    }
    fn cost(&self, values: &Values, _: f64) -> f64 {
        self.0.iter().map(|(_, prior)| prior.at(values).cost).sum()
    }
    fn largest_graduated(&self, _: &Values) -> f64 {
        0.0
    }

    fn linearize(
        &self,
        values: &Values,
        _: f64,
        blocks: &[BlockAddress],
        offsets: &[Option<usize>],
        equations: &mut NormalEquations,
    ) -> f64 {
        let (mut cost, mut blocks) = (0.0, blocks.iter());
        for (_, prior) in &self.0 {
            let at = prior.at(values);
            cost += at.cost;
            for (place, (row, by_a)) in at.jacobians.iter().enumerate() {
                let n = by_a.ncols();
                for (column, by_b) in &at.jacobians[place..] {
                    let Some(block) = blocks.next() else { continue };
                    let right = prior.hessian.view((*row, *column), (n, by_b.ncols())) * by_b;
                    let shape = (n, n, by_b.ncols());
                    block.add_product(by_a.as_slice(), right.as_slice(), shape, equations.entries_mut());
                }
                if let Some(offset) = offsets[prior.variables[place]] {
                    let slope = by_a.transpose() * at.slope.rows(*row, n);
                    for (k, entry) in slope.iter().enumerate() {
                        equations.gradient_mut()[offset + k] += entry;
                    }
                }
            }
        }
        cost
    }

    fn check(&self, values: &Values) -> Result<(), SmootherError> {
        for (index, prior) in &self.0 {
            if !prior.at(values).cost.is_finite() {
                let what = "what a marginalization left";
                return Err(SmootherError::NotFinite { what, residual: Some(*index) });
            }
        }
        Ok(())
    }

    fn squared_norms(&self, values: &Values, into: &mut Vec<(usize, f64)>) {
        into.extend(self.0.iter().map(|(index, prior)| (*index, prior.at(values).cost)));
    }

    fn linearize_chosen(&self, values: &Values, chosen: &[bool], dense: &mut DenseQuadratic) {
        for (_, prior) in self.0.iter().filter(|(_, prior)| prior.is_chosen(chosen)) {
            let at = prior.at(values);
            dense.constant += at.cost;
            for ((row, by_a), a) in at.jacobians.iter().zip(&prior.variables) {
                let n = by_a.ncols();
                dense.add_slope(*a, by_a.transpose() * at.slope.rows(*row, n));
                for ((column, by_b), b) in at.jacobians.iter().zip(&prior.variables) {
                    let block = prior.hessian.view((*row, *column), (n, by_b.ncols()));
                    dense.add_block(*a, *b, by_a.transpose() * block * by_b);
                }
            }
        }
    }

    fn remove_chosen(&mut self, chosen: &[bool]) -> usize {
        let before = self.0.len();
        self.0.retain(|(_, prior)| !prior.is_chosen(chosen));
        before - self.0.len()
    }
    fn remove(&mut self, _: usize) -> bool {
        false
    }
}
