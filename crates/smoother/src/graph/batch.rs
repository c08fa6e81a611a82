use std::any::Any;

use super::{keys::Keys, values::Values};
use crate::{
    Information, Kernel, Residual, SmootherError, VariableTuple,
    linear::{block_address::BlockAddress, normal_equations::NormalEquations},
};

/// All residuals of a type.
pub(crate) struct Batch<R: Residual> {
    residuals: Vec<R>,
    keys: Vec<Keys>,
    information: Vec<Information<R>>,
    kernels: Vec<Kernel>,
    /// Numbers among all residuals.
    indices: Vec<usize>,
}

/// A batch whose type is forgotten.
pub(crate) trait AnyBatch: Send {
    fn as_any_mut(&mut self) -> &mut dyn Any;
    fn len(&self) -> usize;
    /// Numbers of the variables of each residual.
    fn variables(&self) -> Box<dyn Iterator<Item = &[usize]> + '_>;
    fn set_kernel(&mut self, slot: usize, kernel: Kernel);
    /// $`\sum ρ(r^T Ω r)`$
    fn cost(&self, values: &Values, mu: f64) -> f64;
    /// The largest squared norm in units of $`c^2`$ among those with a Geman–McClure kernel.
    fn largest_graduated(&self, values: &Values) -> f64;
    /// Adds the residuals to the normal equations; the cost.
    fn linearize(
        &self,
        values: &Values,
        mu: f64,
        blocks: &[BlockAddress],
        offsets: &[Option<usize>],
        equations: &mut NormalEquations,
    ) -> f64;
    /// Checks shapes, and that everything is a finite number.
    fn check(&self, values: &Values) -> Result<(), SmootherError>;
    /// Squared norms by number of the residual.
    fn squared_norms(&self, values: &Values, into: &mut [f64]);
}

impl<R: Residual> Default for Batch<R> {
    fn default() -> Self {
        Self {
            residuals: Vec::new(),
            keys: Vec::new(),
            information: Vec::new(),
            kernels: Vec::new(),
            indices: Vec::new(),
        }
    }
}

impl<R: Residual> Batch<R> {
    pub(crate) fn push(&mut self, residual: R, keys: Keys, information: Information<R>, index: usize) {
        self.residuals.push(residual);
        self.keys.push(keys);
        self.information.push(information);
        self.kernels.push(Kernel::Squared);
        self.indices.push(index);
    }

    pub(crate) fn append(&mut self, mut other: Self) {
        self.residuals.append(&mut other.residuals);
        self.keys.append(&mut other.keys);
        self.information.append(&mut other.information);
        self.kernels.append(&mut other.kernels);
        self.indices.append(&mut other.indices);
    }

    pub(crate) fn set_information(
        &mut self,
        slot: usize,
        information: Information<R>,
    ) -> Result<(), SmootherError> {
        let place = self.information.get_mut(slot).ok_or(SmootherError::UnknownId)?;
        let n_entries = |matrix| R::Variables::information_entries(matrix).len();
        let (expected, got) = (n_entries(place), n_entries(&information));
        if expected != got {
            let (expected, got) = ((expected, 1), (got, 1));
            return Err(SmootherError::Shape { what: "the information", residual: self.indices[slot], expected, got });
        }
        *place = information;
        Ok(())
    }

    fn value(
        &self,
        slot: usize,
        columns: <R::Variables as VariableTuple<R::Dim>>::Columns<'_>,
    ) -> crate::Value<R> {
        self.residuals[slot].value(R::Variables::at(columns, &self.keys[slot]))
    }

    fn norm(&self, slot: usize, columns: <R::Variables as VariableTuple<R::Dim>>::Columns<'_>) -> f64 {
        R::Variables::squared_norm(&self.value(slot, columns), &self.information[slot])
    }
}

impl<R: Residual> AnyBatch for Batch<R> {
    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
    fn len(&self) -> usize {
        self.residuals.len()
    }
    fn variables(&self) -> Box<dyn Iterator<Item = &[usize]> + '_> {
        Box::new(self.keys.iter().map(|keys| &keys.indices[..R::Variables::ARITY]))
    }
    fn set_kernel(&mut self, slot: usize, kernel: Kernel) {
        self.kernels[slot] = kernel;
    }

    fn cost(&self, values: &Values, mu: f64) -> f64 {
        let columns = R::Variables::columns(values);
        let costs =
            (0..self.len()).map(|slot| self.kernels[slot].cost_and_weight(self.norm(slot, columns), mu).0);
        costs.sum()
    }

    fn largest_graduated(&self, values: &Values) -> f64 {
        let columns = R::Variables::columns(values);
        let graduated = (0..self.len()).filter_map(|slot| match self.kernels[slot] {
            Kernel::GemanMcClure { c } => Some(self.norm(slot, columns) / (c * c)),
            _ => None,
        });
        graduated.fold(0.0, f64::max)
    }

    fn linearize(
        &self,
        values: &Values,
        mu: f64,
        blocks: &[BlockAddress],
        offsets: &[Option<usize>],
        equations: &mut NormalEquations,
    ) -> f64 {
        let columns = R::Variables::columns(values);
        let (arity, mut cost) = (R::Variables::ARITY, 0.0);
        let n_pairs = arity * (arity + 1) / 2;
        for slot in 0..self.len() {
            let at = R::Variables::at(columns, &self.keys[slot]);
            let value = self.residuals[slot].value(at);
            let jacobians = self.residuals[slot].jacobians(at);
            let information = &self.information[slot];
            let norm = R::Variables::squared_norm(&value, information);
            let (robust, weight) = self.kernels[slot].cost_and_weight(norm, mu);
            cost += robust;
            R::Variables::accumulate(
                &value,
                &jacobians,
                information,
                weight,
                &blocks[slot * n_pairs..(slot + 1) * n_pairs],
                &self.keys[slot].indices.map(|index| offsets[index]),
                equations,
            );
        }
        cost
    }

    fn check(&self, values: &Values) -> Result<(), SmootherError> {
        let columns = R::Variables::columns(values);
        for (slot, residual) in self.indices.iter().enumerate() {
            let at = R::Variables::at(columns, &self.keys[slot]);
            let (value, jacobians) = (self.residuals[slot].value(at), self.residuals[slot].jacobians(at));
            let value = R::Variables::value_rows(&value);
            let n_rows = value.len();
            let n_information = R::Variables::information_entries(&self.information[slot]).len();
            let shape = |what, got, expected| {
                let error = SmootherError::Shape { what, residual: *residual, expected, got };
                if got == expected { Ok(()) } else { Err(error) }
            };
            let expected_rows = (n_information as f64).sqrt() as usize;
            shape("the value", (n_rows, 1), (expected_rows, 1))?;
            let not_finite = |what| SmootherError::NotFinite { what, residual: Some(*residual) };
            if !value.iter().all(|entry| entry.is_finite()) {
                return Err(not_finite("the value"));
            }
            let dims = R::Variables::tangent_dims(at);
            for ((entries, rows, columns), dim) in R::Variables::jacobian_entries(&jacobians).iter().zip(dims)
            {
                shape("a Jacobian", (*rows, *columns), (n_rows, dim))?;
                if !entries.iter().all(|entry| entry.is_finite()) {
                    return Err(not_finite("a Jacobian"));
                }
            }
            if !self.norm(slot, columns).is_finite() {
                return Err(not_finite("the squared norm"));
            }
        }
        Ok(())
    }

    fn squared_norms(&self, values: &Values, into: &mut [f64]) {
        let columns = R::Variables::columns(values);
        for (slot, index) in self.indices.iter().enumerate() {
            into[*index] = self.norm(slot, columns);
        }
    }
}
