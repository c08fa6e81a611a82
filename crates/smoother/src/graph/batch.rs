use std::any::Any;

use nalgebra::{DMatrix, DVector};

use super::{dense_quadratic::DenseQuadratic, keys::Keys, values::Values};
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
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
    fn len(&self) -> usize;
    /// Numbers of the variables of each residual.
    fn variables(&self) -> Box<dyn Iterator<Item = &[usize]> + '_>;
    /// Whether there is a residual of this number; it has the kernel then.
    fn set_kernel(&mut self, index: usize, kernel: Kernel) -> bool;
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
    /// Numbers of the residuals with their squared norms.
    fn squared_norms(&self, values: &Values, into: &mut Vec<(usize, f64)>);
    /// Adds the residuals that name a chosen variable to a dense quadratic.
    fn linearize_chosen(&self, values: &Values, chosen: &[bool], dense: &mut DenseQuadratic);
    /// Removes the residuals that name a chosen variable; how many.
    fn remove_chosen(&mut self, chosen: &[bool]) -> usize;
    /// Removes the residual of this number; whether there was one.
    fn remove(&mut self, index: usize) -> bool;
    /// Whether these are what earlier marginalizations left.
    fn is_of_marginalization(&self) -> bool {
        false
    }
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
        index: usize,
        information: Information<R>,
    ) -> Result<(), SmootherError> {
        let slot = self.slot(index).ok_or(SmootherError::UnknownId)?;
        let n_entries = |matrix| R::Variables::information_entries(matrix).len();
        let (expected, got) = ((n_entries(&self.information[slot]), 1), (n_entries(&information), 1));
        if expected != got {
            return Err(SmootherError::Shape { what: "the information", residual: index, expected, got });
        }
        self.information[slot] = information;
        Ok(())
    }

    /// Numbers, residuals, numbers of their variables, and information.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (usize, &R, &[usize], &Information<R>)> {
        self.indices.iter().enumerate().map(|(slot, index)| {
            let named = &self.keys[slot].indices[..R::Variables::ARITY];
            (*index, &self.residuals[slot], named, &self.information[slot])
        })
    }

    /// Numbers grow from slot to slot.
    fn slot(&self, index: usize) -> Option<usize> {
        self.indices.binary_search(&index).ok()
    }

    fn keep(&mut self, is_kept: &[bool]) {
        fn kept<T>(all: &mut Vec<T>, is_kept: &[bool]) {
            let mut is_kept = is_kept.iter();
            all.retain(|_| is_kept.next().is_none_or(|kept| *kept));
        }
        kept(&mut self.residuals, is_kept);
        kept(&mut self.keys, is_kept);
        kept(&mut self.information, is_kept);
        kept(&mut self.kernels, is_kept);
        kept(&mut self.indices, is_kept);
    }

    fn is_chosen(&self, slot: usize, chosen: &[bool]) -> bool {
        self.keys[slot].indices[..R::Variables::ARITY].iter().any(|variable| chosen[*variable])
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
    fn as_any(&self) -> &dyn Any {
        self
    }
    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
    fn len(&self) -> usize {
        self.residuals.len()
    }
    fn variables(&self) -> Box<dyn Iterator<Item = &[usize]> + '_> {
        Box::new(self.keys.iter().map(|keys| &keys.indices[..R::Variables::ARITY]))
    }
    fn set_kernel(&mut self, index: usize, kernel: Kernel) -> bool {
        let slot = self.slot(index);
        if let Some(slot) = slot {
            self.kernels[slot] = kernel;
        }
        slot.is_some()
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

    fn squared_norms(&self, values: &Values, into: &mut Vec<(usize, f64)>) {
        let columns = R::Variables::columns(values);
        into.extend(self.indices.iter().enumerate().map(|(slot, index)| (*index, self.norm(slot, columns))));
    }

    fn linearize_chosen(&self, values: &Values, chosen: &[bool], dense: &mut DenseQuadratic) {
        let columns = R::Variables::columns(values);
        for slot in (0..self.len()).filter(|slot| self.is_chosen(*slot, chosen)) {
            let at = R::Variables::at(columns, &self.keys[slot]);
            let (value, jacobians) = (self.residuals[slot].value(at), self.residuals[slot].jacobians(at));
            let norm = R::Variables::squared_norm(&value, &self.information[slot]);
            let (cost, weight) = self.kernels[slot].cost_and_weight(norm, 1.0);
            let rows = DVector::from_column_slice(R::Variables::value_rows(&value));
            let entries = R::Variables::information_entries(&self.information[slot]);
            let information = DMatrix::from_column_slice(rows.len(), rows.len(), entries) * weight;
            let jacobians: Vec<_> = R::Variables::jacobian_entries(&jacobians)
                .into_iter()
                .map(|(entries, n_rows, n_columns)| DMatrix::from_column_slice(n_rows, n_columns, entries))
                .collect();
            let variables = &self.keys[slot].indices[..R::Variables::ARITY];
            dense.add(variables, &jacobians, &information, &rows, cost);
        }
    }

    fn remove_chosen(&mut self, chosen: &[bool]) -> usize {
        let is_kept: Vec<bool> = (0..self.len()).map(|slot| !self.is_chosen(slot, chosen)).collect();
        self.keep(&is_kept);
        is_kept.iter().filter(|kept| !**kept).count()
    }

    fn remove(&mut self, index: usize) -> bool {
        let slot = self.slot(index);
        if let Some(slot) = slot {
            let is_kept: Vec<bool> = (0..self.len()).map(|other| other != slot).collect();
            self.keep(&is_kept);
        }
        slot.is_some()
    }
}
