use std::{fmt, marker::PhantomData};

use nalgebra::{Const, DefaultAllocator, Dim, OVector, allocator::Allocator};
use wayfix_estimation_traits::Manifold;

/// What can be estimated: every [`Manifold`] over `f64`. Implemented for all of them, never by hand.
pub trait Variable: Manifold<Scalar = f64> + Send + 'static {
    /// Dimension of the tangent space at this value.
    fn tangent_dim(&self) -> usize;
    /// $`x ⊞ δ`$ with $`δ`$ from a slice of [`tangent_dim`](Self::tangent_dim) numbers.
    fn retract_slice(&self, delta: &[f64]) -> Self;
    /// $`x ⊟ x_0`$ with $`x`$ this value, and its derivative by $`x`$ in columns.
    #[doc(hidden)]
    fn local_from(&self, origin: &Self) -> (Vec<f64>, Vec<f64>);
}

/// Step of central differences of $`⊟`$: $`ε^{1/3}`$.
const LOCAL_STEP: f64 = 6e-6;

impl<X> Variable for X
where
    X: Manifold<Scalar = f64> + Send + 'static,
    DefaultAllocator: Allocator<X::Dim>,
{
    fn tangent_dim(&self) -> usize {
        self.dim().value()
    }
    fn retract_slice(&self, delta: &[f64]) -> Self {
        self.retract(&OVector::<f64, X::Dim>::from_column_slice_generic(self.dim(), Const::<1>, delta))
    }
    fn local_from(&self, origin: &Self) -> (Vec<f64>, Vec<f64>) {
        let n = self.tangent_dim();
        let delta = origin.local(self).as_slice().to_vec();
        if delta.iter().all(|entry| *entry == 0.0) {
            let identity = (0..n * n).map(|entry| if entry % (n + 1) == 0 { 1.0 } else { 0.0 });
            return (delta, identity.collect());
        }
        let mut jacobian = Vec::with_capacity(n * n);
        let mut step = vec![0.0; n];
        for k in 0..n {
            step[k] = LOCAL_STEP;
            let plus = origin.local(&self.retract_slice(&step));
            step[k] = -LOCAL_STEP;
            let minus = origin.local(&self.retract_slice(&step));
            step[k] = 0.0;
            jacobian.extend((plus - minus).iter().map(|difference| difference / (2.0 * LOCAL_STEP)));
        }
        (delta, jacobian)
    }
}

/// A variable of a [`Graph`](crate::Graph), typed by what it holds.
pub struct VariableId<X> {
    /// Number among all variables of the graph.
    pub(crate) index: usize,
    /// Number among the variables of this type.
    pub(crate) slot: usize,
    /// Unique among all graphs: numbers of removed variables are used again.
    pub(crate) serial: u64,
    pub(crate) marker: PhantomData<fn() -> X>,
}

impl<X> VariableId<X> {
    /// Number of the variable in the order of adding, from 0: errors and covariances use it.
    ///
    /// A variable that is added after another was removed takes the number of that one.
    pub fn index(self) -> usize {
        self.index
    }
}

impl<X> Clone for VariableId<X> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<X> Copy for VariableId<X> {}
impl<X> PartialEq for VariableId<X> {
    fn eq(&self, other: &Self) -> bool {
        self.serial == other.serial
    }
}
impl<X> Eq for VariableId<X> {}
impl<X> fmt::Debug for VariableId<X> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "variable {}", self.index)
    }
}
