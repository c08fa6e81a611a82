use nalgebra::{DefaultAllocator, OMatrix, OVector};
use wayfix_estimation_traits::{LieGroup, StateAlloc};

use crate::{Residual, Variable};

/// A measured motion between two poses: $`r = \log\big(z^{-1} x_1^{-1} x_2\big)`$.
///
/// The logarithm is that of the whole group, as GTSAM has it. Odometry, scan matches and loop closures are of this kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between<G> {
    measured: G,
    inverse: G,
}

impl<G: LieGroup> Between<G> {
    /// The second pose as seen from the first.
    pub fn new(measured: G) -> Self {
        Self { inverse: measured.inverse(), measured }
    }
    /// The second pose as seen from the first.
    pub fn measured(&self) -> &G {
        &self.measured
    }
}

impl<G: LieGroup<Scalar = f64> + Variable> Residual for Between<G>
where
    DefaultAllocator: StateAlloc<G::Dim>,
    OMatrix<f64, G::Dim, G::Dim>: Send,
{
    type Dim = G::Dim;
    type Variables = (G, G);

    fn value(&self, (first, second): (&G, &G)) -> OVector<f64, G::Dim> {
        self.inverse.compose(&first.inverse().compose(second)).log()
    }

    /// $`∂r/∂x_2 = J_r^{-1}(r)`$ and $`∂r/∂x_1 = -J_r^{-1}(r)\, \mathrm{Ad}_{x_2^{-1} x_1}`$. [Solà et al. 2018, Eqs. 79, 83]
    fn jacobians(
        &self,
        (first, second): (&G, &G),
    ) -> (OMatrix<f64, G::Dim, G::Dim>, OMatrix<f64, G::Dim, G::Dim>) {
        let relative = first.inverse().compose(second);
        let by_second = self.inverse.compose(&relative).log_jacobian();
        let by_first = -(&by_second * relative.inverse().adjoint());
        (by_first, by_second)
    }
}
