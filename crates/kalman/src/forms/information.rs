use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, TangentMatrix, UpdateAlloc};
use wayfix_gaussian_core::{Gaussian, cholesky, symmetrize};

use crate::{
    Innovation, KalmanAlgorithm,
    algebra::transport::transport,
    check,
    error::Checked,
    linearize::{linearize_motion, linearize_sensor},
};

/// The information form: stores $`Λ = P^{-1}`$, so the information of measurements is additive.
///
/// Update: $`Λ = Λ + H^T R^{-1} H`$; predict: $`Λ = (F Λ^{-1} F^T + Q)^{-1}`$. [Thrun et al. 2005, Table 3.5]
/// Everything is solved with Cholesky factors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InformationFilterAlgorithm;

/// A mean and the inverse of its covariance.
#[derive(Clone, Debug, PartialEq)]
pub struct InformationBelief<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    mean: X,
    information: TangentMatrix<X>,
}

impl<X: Manifold> InformationBelief<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// The matrix is always invertible, so the conversion to a [`Gaussian`] cannot fail.
    fn checked(mean: X, information: TangentMatrix<X>) -> Checked<Self> {
        inverse("information", &mean, &information)?;
        Ok(Self { mean, information })
    }
    /// The mean.
    pub fn mean(&self) -> &X {
        &self.mean
    }
    /// $`Λ`$ in the tangent space at the mean.
    pub fn information(&self) -> &TangentMatrix<X> {
        &self.information
    }
}

impl<X: Manifold> From<InformationBelief<X>> for Gaussian<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    fn from(belief: InformationBelief<X>) -> Self {
        let covariance = inverse("information", &belief.mean, &belief.information)
            .expect("invariant: InformationBelief::checked has inverted it before");
        Self::from_parts_unchecked(belief.mean, covariance)
    }
}

impl<X: Manifold> KalmanAlgorithm<X> for InformationFilterAlgorithm
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    type Belief = InformationBelief<X>;

    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<InformationBelief<X>> {
        let information = inverse("prior", gaussian.mean(), gaussian.covariance())?;
        InformationBelief::checked(gaussian.mean().clone(), information)
    }

    fn predict<M>(&self, belief: &Self::Belief, motion: &M, control: &M::Control) -> Checked<Self::Belief>
    where
        M: MotionModel<State = X>,
    {
        let linear = linearize_motion(motion, &belief.mean, control)?;
        let factor = cholesky("information", &belief.information)?;
        // W = L⁻¹ Fᵀ, so that Wᵀ W = F Λ⁻¹ Fᵀ.
        let mut whitened = linear.jacobian.transpose();
        factor.l_dirty().solve_lower_triangular_mut(&mut whitened);
        let covariance = whitened.transpose() * &whitened + linear.noise;
        let information = inverse("predicted", &linear.mean, &covariance)?;
        InformationBelief::checked(linear.mean, information)
    }

    fn update<S>(
        &self,
        belief: &Self::Belief,
        sensor: &S,
        measurement: &S::Measurement,
        admits: impl FnOnce(&Innovation<X, S::Measurement>) -> bool,
    ) -> Checked<(Innovation<X, S::Measurement>, Option<Self::Belief>)>
    where
        S: SensorModel<State = X>,
        DefaultAllocator: UpdateAlloc<X::Dim, <S::Measurement as Manifold>::Dim>,
    {
        let linear = linearize_sensor(sensor, &belief.mean, measurement)?;
        let cross_covariance =
            cholesky("information", &belief.information)?.solve(&linear.jacobian.transpose());
        let covariance = &linear.jacobian * &cross_covariance + &linear.noise;
        let innovation = Innovation::new(linear.residual, covariance, cross_covariance)?;
        if !admits(&innovation) {
            return Ok((innovation, None));
        }
        let noise = cholesky("sensor noise", &linear.noise)?;
        let weighted = linear.jacobian.transpose();
        let mut information = &belief.information + &weighted * noise.solve(&linear.jacobian);
        symmetrize(&mut information);
        check::positive_definite("posterior information", &information)?;
        let pull = weighted * noise.solve(innovation.residual());
        let offset = cholesky("posterior information", &information)?.solve(&pull);
        let mean = check::moved("posterior mean", &belief.mean, &offset)?;
        // Information is transported by the inverse of the Jacobian for covariances: the chart in the other direction.
        if let Some(back) = transport(&mean, &belief.mean) {
            information = back.tr_mul(&information) * back;
            symmetrize(&mut information);
        }
        Ok((innovation, Some(InformationBelief::checked(mean, information)?)))
    }
}

/// The inverse of a positive definite matrix; the only place where it is formed.
fn inverse<X: Manifold>(what: &'static str, point: &X, matrix: &TangentMatrix<X>) -> Checked<TangentMatrix<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    check::positive_definite(what, matrix)?;
    let n = point.dim();
    let mut inverse = cholesky(what, matrix)?.solve(&TangentMatrix::<X>::identity_generic(n, n));
    symmetrize(&mut inverse);
    check::positive_definite(what, &inverse)?;
    Ok(inverse)
}
