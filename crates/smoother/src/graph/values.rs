use std::{
    any::Any,
    marker::PhantomData,
    sync::atomic::{AtomicU64, Ordering},
};

use nalgebra::DMatrix;

use crate::{Variable, VariableId};

/// Serial number of the next variable of any graph: an identifier of another graph is not one of this. Nothing is computed from it.
static NEXT_SERIAL: AtomicU64 = AtomicU64::new(0);

/// The values of all variables: one column for each type.
#[derive(Default)]
pub struct Values {
    columns: Vec<Box<dyn Column>>,
    /// Column and slot of each variable.
    places: Vec<(usize, usize)>,
}

trait Column: Any + Send {
    fn copy(&self) -> Box<dyn Column>;
    /// Sets every value to that of `from`, moved along its part of `step`.
    fn retract_from(&mut self, from: &dyn Column, offsets: &[Option<usize>], step: &[f64]);
    /// The present value, to linearize about.
    fn linear_point(&self, slot: usize) -> Box<dyn LinearPoint>;
    fn remove(&mut self, slot: usize);
    fn is_present(&self, slot: usize) -> bool;
    fn n_present(&self) -> usize;
    fn as_any(&self) -> &dyn Any;
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

/// A value that a variable had, and how far the variable is from it now.
pub(crate) trait LinearPoint: Send {
    /// $`x ⊟ x_0`$, and its derivative by $`x`$ in columns.
    fn local(&self, values: &Values) -> (Vec<f64>, DMatrix<f64>);
}

struct TypedLinearPoint<X> {
    slot: usize,
    value: X,
}

impl<X: Variable> LinearPoint for TypedLinearPoint<X> {
    fn local(&self, values: &Values) -> (Vec<f64>, DMatrix<f64>) {
        let now = &values.column::<X>()[self.slot];
        let (delta, jacobian) = now.local_from(&self.value);
        (delta, DMatrix::from_vec(now.tangent_dim(), now.tangent_dim(), jacobian))
    }
}

#[derive(Clone)]
struct TypedColumn<X> {
    values: Vec<X>,
    /// Number of each value among all variables.
    indices: Vec<usize>,
    /// Serial number of each variable; `None` for a removed one.
    serials: Vec<Option<u64>>,
    /// Slots of removed variables.
    free: Vec<usize>,
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
    fn linear_point(&self, slot: usize) -> Box<dyn LinearPoint> {
        Box::new(TypedLinearPoint { slot, value: self.values[slot].clone() })
    }
    fn remove(&mut self, slot: usize) {
        self.serials[slot] = None;
        self.free.push(slot);
    }
    fn is_present(&self, slot: usize) -> bool {
        self.serials[slot].is_some()
    }
    fn n_present(&self) -> usize {
        self.values.len() - self.free.len()
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
        let columns = self.columns.iter().map(|c| c.copy()).collect();
        Self { columns, places: self.places.clone() }
    }
}

impl Values {
    /// Adds a variable. The number of a removed one of this type is used again.
    pub(crate) fn push<X: Variable>(&mut self, value: X) -> VariableId<X> {
        let serial = NEXT_SERIAL.fetch_add(1, Ordering::Relaxed);
        let next = self.places.len();
        let found = self.columns.iter().position(|column| column.as_any().is::<TypedColumn<X>>());
        let column = found.unwrap_or_else(|| {
            self.columns.push(Box::new(TypedColumn::<X> {
                values: Vec::new(),
                indices: Vec::new(),
                serials: Vec::new(),
                free: Vec::new(),
            }));
            self.columns.len() - 1
        });
        let (mut index, mut slot) = (next, 0);
        if let Some(typed) = self.columns[column].as_any_mut().downcast_mut::<TypedColumn<X>>() {
            if let Some(free) = typed.free.pop() {
                (index, slot) = (typed.indices[free], free);
                typed.values[slot] = value;
                typed.serials[slot] = Some(serial);
            } else {
                slot = typed.values.len();
                typed.values.push(value);
                typed.indices.push(index);
                typed.serials.push(Some(serial));
                self.places.push((column, slot));
            }
        }
        VariableId { index, slot, serial, marker: PhantomData }
    }

    pub(crate) fn n_present(&self) -> usize {
        self.columns.iter().map(|column| column.n_present()).sum()
    }

    /// Whether a number is that of a variable that is there.
    pub(crate) fn is_present(&self, index: usize) -> bool {
        self.places.get(index).is_some_and(|(column, slot)| self.columns[*column].is_present(*slot))
    }

    pub(crate) fn remove(&mut self, index: usize) {
        let (column, slot) = self.places[index];
        self.columns[column].remove(slot);
    }

    pub(crate) fn linear_point(&self, index: usize) -> Box<dyn LinearPoint> {
        let (column, slot) = self.places[index];
        self.columns[column].linear_point(slot)
    }

    /// All values of a type, by slot.
    pub(crate) fn column<X: Variable>(&self) -> &[X] {
        self.typed::<X>().map_or(&[], |column| &column.values)
    }

    pub(crate) fn get<X: Variable>(&self, id: VariableId<X>) -> Option<&X> {
        let column = self.typed::<X>()?;
        (column.serials.get(id.slot) == Some(&Some(id.serial))).then(|| &column.values[id.slot])
    }

    pub(crate) fn get_mut<X: Variable>(&mut self, id: VariableId<X>) -> Option<&mut X> {
        let column = self.typed_mut::<X>()?;
        (column.serials.get(id.slot) == Some(&Some(id.serial))).then(|| &mut column.values[id.slot])
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
