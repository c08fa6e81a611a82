use std::any::Any;

use nalgebra::{DMatrix, DVector};

use super::{
    batch::AnyBatch, block_jacobian::BlockJacobian, dense_quadratic::DenseQuadratic,
    linear_point::LinearPoint, values::Values,
};
use crate::{
    Kernel, SmootherError,
    linear::{block_address::BlockAddress, normal_equations::NormalEquations},
};

/// What a marginalization leaves: $`δ^T H δ + 2 g^T δ + c`$ with differences $`δ`$ of some variables from linear points.
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

/// A [`LinearPrior`] in the tangent spaces at some values.
struct AtValues {
    /// First coordinate of each variable, with their number.
    places: Vec<(usize, usize)>,
    /// $`J^T H J`$
    hessian: DMatrix<f64>,
    /// $`J^T (H δ + g)`$
    slope: DVector<f64>,
    cost: f64,
}

impl LinearPrior {
    fn at(&self, values: &Values) -> AtValues {
        let (delta, jacobian) = BlockJacobian::of(&self.variables, &self.points, values);
        let curved = &self.hessian * &delta;
        let cost = delta.dot(&curved) + 2.0 * self.gradient.dot(&delta) + self.constant;
        let slope = jacobian.transpose_multiply(&(curved + &self.gradient));
        AtValues { hessian: jacobian.congruence(&self.hessian), places: jacobian.places, slope, cost }
    }

    fn cost(&self, values: &Values) -> f64 {
        let (delta, _) = BlockJacobian::of(&self.variables, &self.points, values);
        delta.dot(&(&self.hessian * &delta)) + 2.0 * self.gradient.dot(&delta) + self.constant
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
        self.0.iter().map(|(_, prior)| prior.cost(values)).sum()
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
            for (place, (row, n)) in at.places.iter().copied().enumerate() {
                for (column, width) in at.places[place..].iter().copied() {
                    let Some(block) = blocks.next() else { continue };
                    block.add(at.hessian.view((row, column), (n, width)), equations.entries_mut());
                }
                if let Some(offset) = offsets[prior.variables[place]] {
                    for k in 0..n {
                        equations.gradient_mut()[offset + k] += at.slope[row + k];
                    }
                }
            }
        }
        cost
    }

    fn check(&self, values: &Values) -> Result<(), SmootherError> {
        for (index, prior) in &self.0 {
            if !prior.cost(values).is_finite() {
                let what = "what a marginalization left";
                return Err(SmootherError::NotFinite { what, residual: Some(*index) });
            }
        }
        Ok(())
    }

    fn squared_norms(&self, values: &Values, into: &mut Vec<(usize, f64)>) {
        into.extend(self.0.iter().map(|(index, prior)| (*index, prior.cost(values))));
    }

    fn linearize_chosen(&self, values: &Values, chosen: &[bool], dense: &mut DenseQuadratic) {
        for (_, prior) in self.0.iter().filter(|(_, prior)| prior.is_chosen(chosen)) {
            let at = prior.at(values);
            dense.constant += at.cost;
            for ((row, n), a) in at.places.iter().copied().zip(&prior.variables) {
                dense.add_slope(*a, at.slope.rows(row, n).into_owned());
                for ((column, width), b) in at.places.iter().copied().zip(&prior.variables) {
                    dense.add_block(*a, *b, at.hessian.view((row, column), (n, width)).into_owned());
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
