use nalgebra::DMatrix;

use super::{keys::Keys, values::Values};
use crate::{Residual, Variable, VariableTuple};

/// Where a variable was, and how far it is from there now.
pub(crate) trait LinearPoint: Send {
    /// The difference, which is zero at the point.
    fn local(&self, values: &Values) -> Local;
}

/// A difference with its derivatives.
pub(crate) struct Local {
    pub(crate) delta: Vec<f64>,
    /// Numbers of variables, that of the point itself last, with the derivatives by them.
    pub(crate) jacobians: Vec<(usize, DMatrix<f64>)>,
}

/// $`x ⊟ x_0`$
pub(crate) struct AbsolutePoint<X> {
    pub(crate) slot: usize,
    pub(crate) index: usize,
    pub(crate) value: X,
}

impl<X: Variable> LinearPoint for AbsolutePoint<X> {
    fn local(&self, values: &Values) -> Local {
        let now = &values.column::<X>()[self.slot];
        let (delta, jacobian) = now.local_from(&self.value);
        let jacobian = DMatrix::from_vec(now.tangent_dim(), now.tangent_dim(), jacobian);
        Local { delta, jacobians: vec![(self.index, jacobian)] }
    }
}

/// $`r(b, x) - r(b_0, x_0)`$ with a base $`b`$: coordinates of $`x`$ that are those of a residual.
pub(crate) struct RelativePoint<R> {
    coordinates: R,
    /// Base and variable.
    keys: Keys,
    origin: Vec<f64>,
}

impl<R: Residual> RelativePoint<R> {
    /// The present point.
    pub(crate) fn new(coordinates: R, keys: Keys, values: &Values) -> Self {
        let at = R::Variables::at(R::Variables::columns(values), &keys);
        let origin = R::Variables::value_rows(&coordinates.value(at)).to_vec();
        Self { coordinates, keys, origin }
    }
}

impl<R: Residual> LinearPoint for RelativePoint<R> {
    fn local(&self, values: &Values) -> Local {
        let at = R::Variables::at(R::Variables::columns(values), &self.keys);
        let value = self.coordinates.value(at);
        let delta = R::Variables::value_rows(&value).iter().zip(&self.origin).map(|(x, x0)| x - x0).collect();
        let jacobians = self.coordinates.jacobians(at);
        let entries = R::Variables::jacobian_entries(&jacobians).into_iter();
        let matrices =
            entries.map(|(entries, rows, columns)| DMatrix::from_column_slice(rows, columns, entries));
        Local { delta, jacobians: self.keys.indices.into_iter().zip(matrices).collect() }
    }
}
