use nalgebra::{DefaultAllocator, Dim, OMatrix, RealField};
use wayfix_estimation_traits::{Manifold, MotionModel, SensorModel, StateAlloc, UpdateAlloc};
use wayfix_gaussian_core::{Gaussian, GaussianError, cholesky};

use super::{
    FactoredGaussian,
    rotation::{Rotation, triangle, triangle_of_sum, turn_columns},
};
use crate::{
    Innovation, KalmanAlgorithm,
    algebra::transport::transport,
    check,
    error::Checked,
    linearize::{linearize_motion, linearize_sensor},
};

/// The square-root (array) form: carries the Cholesky factor $`L`$ of $`P`$ and rotates arrays into triangles.
///
/// Predict: $`[F L\;\; Q^{1/2}] → [L\;\; 0]`$. Update:
///
/// ```math
/// \begin{pmatrix} R^{1/2} & H L \\ 0 & L \end{pmatrix} → \begin{pmatrix} S^{1/2} & 0 \\ K S^{1/2} & L \end{pmatrix}
/// ```
///
/// Nothing is subtracted, so variances cannot become negative, and half the digits suffice. [Kailath et al. 2000, §12.3]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SquareRootKalmanAlgorithm;

impl<X: Manifold> KalmanAlgorithm<X> for SquareRootKalmanAlgorithm
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    type Belief = FactoredGaussian<X>;

    fn belief_from(&self, gaussian: &Gaussian<X>) -> Checked<FactoredGaussian<X>> {
        let factor = cholesky("prior", gaussian.covariance())?.unpack();
        Ok(FactoredGaussian { mean: gaussian.mean().clone(), factor })
    }

    fn predict<M>(&self, belief: &Self::Belief, motion: &M, control: &M::Control) -> Checked<Self::Belief>
    where
        M: MotionModel<State = X>,
    {
        let linear = linearize_motion(motion, &belief.mean, control)?;
        let factor = triangle_of_sum(linear.jacobian * &belief.factor, linear.noise_factor);
        check_factor("predicted", &factor)?;
        Ok(FactoredGaussian { mean: linear.mean, factor })
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
        let noise_factor = cholesky("sensor noise", &linear.noise)?.unpack();
        let array = rotated(noise_factor, &linear.jacobian, belief.factor.clone());
        check_factor("innovation", &array.innovation_factor)?;
        let innovation =
            Innovation::of_factors(linear.residual, array.innovation_factor, &array.scaled_gain)?;
        if !admits(&innovation) {
            return Ok((innovation, None));
        }
        let offset = array.scaled_gain * innovation.whitened();
        let mean = check::moved("posterior mean", &belief.mean, &offset)?;
        let factor = match transport(&belief.mean, &mean) {
            Some(jacobian) => triangle(jacobian * array.factor),
            None => array.factor,
        };
        check_factor("posterior", &factor)?;
        Ok((innovation, Some(FactoredGaussian { mean, factor })))
    }
}

/// What the array of an update becomes.
struct Rotated<T: RealField + Copy, D: Dim, M: Dim>
where
    DefaultAllocator: UpdateAlloc<D, M>,
{
    /// $`S^{1/2}`$.
    innovation_factor: OMatrix<T, M, M>,
    /// $`K S^{1/2}`$.
    scaled_gain: OMatrix<T, D, M>,
    /// $`L`$ after the measurement.
    factor: OMatrix<T, D, D>,
}

/// Rotates $`H L`$ into $`R^{1/2}`$, row by row, and everything below along.
///
/// Columns are taken from the last to the first: then $`L`$ stays triangular by itself, and each entry of its diagonal is only ever
/// multiplied by a cosine.
fn rotated<T, D, M>(
    mut innovation_factor: OMatrix<T, M, M>,
    jacobian: &OMatrix<T, M, D>,
    mut factor: OMatrix<T, D, D>,
) -> Rotated<T, D, M>
where
    T: RealField + Copy,
    D: Dim,
    M: Dim,
    DefaultAllocator: UpdateAlloc<D, M>,
{
    let mut seen = jacobian * &factor;
    let (n, m) = (factor.shape_generic().0, seen.shape_generic().0);
    let mut scaled_gain = OMatrix::zeros_generic(n, m);
    for row in 0..m.value() {
        for k in (0..n.value()).rev() {
            if let Some(rotation) = Rotation::eliminating(innovation_factor[(row, row)], seen[(row, k)]) {
                turn_columns(rotation, row, (&mut innovation_factor, row), (&mut seen, k));
                turn_columns(rotation, k, (&mut scaled_gain, row), (&mut factor, k));
            }
        }
    }
    Rotated { innovation_factor, scaled_gain, factor }
}

/// Finite, with a positive diagonal.
fn check_factor<T: RealField + Copy, D: Dim>(what: &'static str, factor: &OMatrix<T, D, D>) -> Checked
where
    DefaultAllocator: StateAlloc<D>,
{
    check::finite(what, factor)?;
    match (0..factor.nrows()).find(|i| factor[(*i, *i)] <= T::zero()) {
        None => Ok(()),
        Some(pivot) => Err(GaussianError::NotPositiveDefinite {
            what,
            pivot,
            value: wayfix_estimation_traits::to_f64(factor[(pivot, pivot)]),
        }
        .into()),
    }
}

impl<X: Manifold, Z: Manifold<Scalar = X::Scalar>> Innovation<X, Z>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    /// From $`S^{1/2}`$ and $`K S^{1/2}`$: $`S`$ is not factored again.
    fn of_factors(
        residual: nalgebra::OVector<X::Scalar, Z::Dim>,
        innovation_factor: OMatrix<X::Scalar, Z::Dim, Z::Dim>,
        scaled_gain: &OMatrix<X::Scalar, X::Dim, Z::Dim>,
    ) -> Checked<Self> {
        let transposed = innovation_factor.transpose();
        let cross_covariance = scaled_gain * &transposed;
        let covariance = &innovation_factor * transposed;
        Self::factored(
            residual,
            covariance,
            cross_covariance,
            crate::algebra::ldl::Ldl::from_root(&innovation_factor),
        )
    }
}
