use nalgebra::{DefaultAllocator, OMatrix, OVector};
use wayfix_estimation_traits::{LieGroup, StateAlloc};

use crate::{Residual, Variable};

/// What is known of a pose beforehand, or measured of it absolutely: $`r = \log(z^{-1} x)`$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior<G> {
    mean: G,
    inverse: G,
}

impl<G: LieGroup> Prior<G> {
    /// The pose is about `mean`.
    pub fn new(mean: G) -> Self {
        Self { inverse: mean.inverse(), mean }
    }
    /// The expected pose.
    pub fn mean(&self) -> &G {
        &self.mean
    }
}

impl<G: LieGroup<Scalar = f64> + Variable> Residual for Prior<G>
where
    DefaultAllocator: StateAlloc<G::Dim>,
    OMatrix<f64, G::Dim, G::Dim>: Send,
{
    type Dim = G::Dim;
    type Variables = (G,);

    fn value(&self, (pose,): (&G,)) -> OVector<f64, G::Dim> {
        self.inverse.compose(pose).log()
    }
    fn jacobians(&self, (pose,): (&G,)) -> (OMatrix<f64, G::Dim, G::Dim>,) {
        (self.inverse.compose(pose).log_jacobian(),)
    }
}
