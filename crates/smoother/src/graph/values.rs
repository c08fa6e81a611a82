use std::{any::Any, marker::PhantomData};

use crate::{Variable, VariableId};

/// The values of all variables: one column for each type.
#[derive(Default)]
pub struct Values {
    columns: Vec<Box<dyn Column>>,
    n_variables: usize,
}

trait Column: Any + Send {
    fn copy(&self) -> Box<dyn Column>;
    /// Sets every value to that of `from`, moved along its part of `step`.
    fn retract_from(&mut self, from: &dyn Column, offsets: &[Option<usize>], step: &[f64]);
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

#[derive(Clone)]
struct TypedColumn<X> {
    values: Vec<X>,
    /// Number of each value among all variables.
    indices: Vec<usize>,
}

impl<X: Variable> Column for TypedColumn<X> {
    fn copy(&self) -> Box<dyn Column> {
        Box::new(self.clone())
    }
    fn retract_from(&mut self, from: &dyn Column, offsets: &[Option<usize>], step: &[f64]) {
        let Some(from) = from.as_any().downcast_ref::<Self>() else { return };
        for ((to, from), index) in self.values.iter_mut().zip(&from.values).zip(&self.indices) {
            *to = match offsets[*index] {
                Some(offset) => from.retract_slice(&step[offset..offset + from.tangent_dim()]),
                None => from.clone(),
            };
        }
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}

impl Clone for Values {
    fn clone(&self) -> Self {
        Self { columns: self.columns.iter().map(|c| c.copy()).collect(), n_variables: self.n_variables }
    }
}

impl Values {
    pub(crate) fn push<X: Variable>(&mut self, value: X) -> VariableId<X> {
        let index = self.n_variables;
        self.n_variables += 1;
        if self.typed::<X>().is_none() {
            self.columns.push(Box::new(TypedColumn::<X> { values: Vec::new(), indices: Vec::new() }));
        }
        let mut slot = 0;
        if let Some(column) = self.typed_mut::<X>() {
            slot = column.values.len();
            column.values.push(value);
            column.indices.push(index);
        }
        VariableId { index, slot, marker: PhantomData }
    }

    /// All values of a type, by slot.
    pub(crate) fn column<X: Variable>(&self) -> &[X] {
        self.typed::<X>().map_or(&[], |column| &column.values)
    }

    pub(crate) fn get<X: Variable>(&self, id: VariableId<X>) -> Option<&X> {
        let column = self.typed::<X>()?;
        (column.indices.get(id.slot) == Some(&id.index)).then(|| &column.values[id.slot])
    }

    pub(crate) fn get_mut<X: Variable>(&mut self, id: VariableId<X>) -> Option<&mut X> {
        let column = self.typed_mut::<X>()?;
        (column.indices.get(id.slot) == Some(&id.index)).then(|| &mut column.values[id.slot])
    }

    /// Every value of `from`, moved along its part of `step`; those without an offset stay.
    pub(crate) fn retract_from(&mut self, from: &Self, offsets: &[Option<usize>], step: &[f64]) {
        for (to, from) in self.columns.iter_mut().zip(&from.columns) {
            to.retract_from(from.as_ref(), offsets, step);
        }
    }

    fn typed<X: Variable>(&self) -> Option<&TypedColumn<X>> {
        self.columns.iter().find_map(|column| column.as_any().downcast_ref())
    }

    fn typed_mut<X: Variable>(&mut self) -> Option<&mut TypedColumn<X>> {
        self.columns.iter_mut().find_map(|column| column.as_any_mut().downcast_mut())
    }
}
