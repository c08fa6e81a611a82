use nalgebra::{DMatrix, DefaultAllocator, Dim, OMatrix, OVector, allocator::Allocator};
use wayfix_estimation_traits::numerical_jacobian;

use crate::{
    Residual, Variable, VariableId,
    graph::{keys::Keys, values::Values},
    linear::{block_address::BlockAddress, normal_equations::NormalEquations},
};

/// One to four variables of a [`Residual`] with `D` rows. Implemented for tuples of [`Variable`]s, never by hand.
pub trait VariableTuple<D: Dim>: Sized + 'static {
    /// References to the variables.
    type Refs<'a>: Copy;
    /// Their identifiers.
    type Ids: Copy;
    /// A vector of `D` rows.
    type Value;
    /// One matrix of `D` rows for each variable.
    type Jacobians;
    /// A `D` × `D` matrix.
    type Information: Clone + Send;
    #[doc(hidden)]
    type Columns<'a>: Copy;
    #[doc(hidden)]
    const ARITY: usize;

    /// The Jacobians by central differences.
    fn differentiate<R: Residual<Dim = D, Variables = Self>>(
        residual: &R,
        at: Self::Refs<'_>,
    ) -> Self::Jacobians;

    /// `None` when a variable is not of this graph.
    #[doc(hidden)]
    fn keys(values: &Values, ids: Self::Ids) -> Option<Keys>;
    #[doc(hidden)]
    fn columns(values: &Values) -> Self::Columns<'_>;
    #[doc(hidden)]
    fn at<'a>(columns: Self::Columns<'a>, keys: &Keys) -> Self::Refs<'a>;
    #[doc(hidden)]
    fn tangent_dims(at: Self::Refs<'_>) -> Vec<usize>;
    #[doc(hidden)]
    fn value_rows(value: &Self::Value) -> &[f64];
    #[doc(hidden)]
    fn information_entries(information: &Self::Information) -> &[f64];
    #[doc(hidden)]
    fn information_matrix(information: &Self::Information) -> DMatrix<f64>;
    /// The entries of each Jacobian by columns, with the numbers of rows and columns.
    #[doc(hidden)]
    fn jacobian_entries(jacobians: &Self::Jacobians) -> Vec<(&[f64], usize, usize)>;
    /// $`r^T Ω r`$.
    #[doc(hidden)]
    fn squared_norm(value: &Self::Value, information: &Self::Information) -> f64;
    /// Adds $`w J^T Ω J`$ and $`w J^T Ω r`$ to the normal equations; shapes are checked by the caller.
    #[doc(hidden)]
    fn accumulate(
        value: &Self::Value,
        jacobians: &Self::Jacobians,
        information: &Self::Information,
        weight: f64,
        blocks: &[BlockAddress],
        offsets: &[Option<usize>],
        equations: &mut NormalEquations,
    );
}

/// `tuple!(arity; (Type name position), …; (row position, column position), …)` with every pair of positions once.
macro_rules! tuple {
    ($arity:literal; $(($X:ident $x:ident $i:tt)),+; $(($p:tt $q:tt)),+) => {
        impl<D: Dim, $($X: Variable),+> VariableTuple<D> for ($($X,)+)
        where
            DefaultAllocator: Allocator<D> + Allocator<D, D> $(+ Allocator<$X::Dim> + Allocator<D, $X::Dim>)+,
            OMatrix<f64, D, D>: Send,
        {
            type Refs<'a> = ($(&'a $X,)+);
            type Ids = ($(VariableId<$X>,)+);
            type Value = OVector<f64, D>;
            type Jacobians = ($(OMatrix<f64, D, $X::Dim>,)+);
            type Information = OMatrix<f64, D, D>;
            type Columns<'a> = ($(&'a [$X],)+);
            const ARITY: usize = $arity;

            fn differentiate<R: Residual<Dim = D, Variables = Self>>(
                residual: &R,
                at: Self::Refs<'_>,
            ) -> Self::Jacobians {
                ($({
                    let moved = |x: &$X| {
                        let mut at = at;
                        at.$i = x;
                        residual.value(at)
                    };
                    numerical_jacobian(moved, at.$i)
                },)+)
            }

            fn keys(values: &Values, ids: Self::Ids) -> Option<Keys> {
                let mut keys = Keys::default();
                $(
                    values.get(ids.$i)?;
                    keys.slots[$i] = ids.$i.slot;
                    keys.indices[$i] = ids.$i.index;
                )+
                Some(keys)
            }
            fn columns(values: &Values) -> Self::Columns<'_> {
                ($(values.column::<$X>(),)+)
            }
            fn at<'a>(columns: Self::Columns<'a>, keys: &Keys) -> Self::Refs<'a> {
                ($(&columns.$i[keys.slots[$i]],)+)
            }
            fn tangent_dims(at: Self::Refs<'_>) -> Vec<usize> {
                vec![$(at.$i.tangent_dim()),+]
            }
            fn value_rows(value: &Self::Value) -> &[f64] {
                value.as_slice()
            }
            fn information_entries(information: &Self::Information) -> &[f64] {
                information.as_slice()
            }
            fn information_matrix(information: &Self::Information) -> DMatrix<f64> {
                DMatrix::from_column_slice(information.nrows(), information.ncols(), information.as_slice())
            }
            fn jacobian_entries(jacobians: &Self::Jacobians) -> Vec<(&[f64], usize, usize)> {
                vec![$((jacobians.$i.as_slice(), jacobians.$i.nrows(), jacobians.$i.ncols())),+]
            }
            fn squared_norm(value: &Self::Value, information: &Self::Information) -> f64 {
                (information * value).dot(value)
            }
            #[inline]
            fn accumulate(
                value: &Self::Value,
                jacobians: &Self::Jacobians,
                information: &Self::Information,
                weight: f64,
                blocks: &[BlockAddress],
                offsets: &[Option<usize>],
                equations: &mut NormalEquations,
            ) {
                let weighted_information = information * weight;
                let weighted_value = &weighted_information * value;
                let weighted = ($(&weighted_information * &jacobians.$i,)+);
                let rows = value.shape_generic().0.value();
                let mut blocks = blocks.iter();
                $(if let Some(block) = blocks.next() {
                    let (left, right) = (jacobians.$p.as_slice(), weighted.$q.as_slice());
                    let shape = (rows, jacobians.$p.shape_generic().1.value(), weighted.$q.shape_generic().1.value());
                    block.add_product(left, right, shape, equations.entries_mut());
                })+
                $(if let Some(offset) = offsets[$i] {
                    for k in 0..jacobians.$i.shape_generic().1.value() {
                        equations.gradient_mut()[offset + k] += jacobians.$i.column(k).dot(&weighted_value);
                    }
                })+
            }
        }
    };
}

tuple!(1; (A a 0); (0 0));
tuple!(2; (A a 0), (B b 1); (0 0), (0 1), (1 1));
tuple!(3; (A a 0), (B b 1), (C c 2); (0 0), (0 1), (0 2), (1 1), (1 2), (2 2));
tuple!(4; (A a 0), (B b 1), (C c 2), (E e 3); (0 0), (0 1), (0 2), (0 3), (1 1), (1 2), (1 3), (2 2), (2 3), (3 3));
