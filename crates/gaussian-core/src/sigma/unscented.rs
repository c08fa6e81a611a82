use nalgebra::{DefaultAllocator, OMatrix};
use wayfix_estimation_traits::{Manifold, StateAlloc, Tangent, TangentMatrix, UpdateAlloc};

use crate::{
    Gaussian, GaussianError, IterationError, SigmaPoints, UnscentedParams, gaussian::check_dimension,
    sigma::weighted_mean::weighted_mean_near, symmetrize, weighted_mean,
};

/// The unscented transform of a Gaussian under a function: the sigma points and their images, as deviations from their means.
#[derive(Clone, Debug, PartialEq)]
pub struct UnscentedTransform<X: Manifold, Z: Manifold>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    mean: Z,
    n_states: X::Dim,
    deviations: Vec<SigmaDeviation<X, Z>>,
}

/// A sigma point and its image, as deviations from their means.
#[derive(Clone, Debug, PartialEq)]
pub struct SigmaDeviation<X: Manifold, Z: Manifold>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    /// Its weight in a covariance.
    pub weight: X::Scalar,
    /// Of the sigma point.
    pub state: Tangent<X>,
    /// Of the image.
    pub image: Tangent<Z>,
}

impl<X: Manifold, Z: Manifold<Scalar = X::Scalar>> UnscentedTransform<X, Z>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    /// Sends sigma points through `function`.
    ///
    /// Exact for linear functions, second order for others; means and differences on the manifolds, so poses and bearings need no care.
    ///
    /// ```
    /// use nalgebra::{Vector1, Vector2};
    /// use wayfix_gaussian_core::{Gaussian, UnscentedParams, UnscentedTransform};
    /// let point = Gaussian::from_sigmas(Vector2::new(0.0, 10.0), &Vector2::new(1.0, 1.0))?;
    /// let range = |p: &Vector2<f64>| Vector1::new(p.norm());
    /// let transformed = UnscentedTransform::new(&point, range, &UnscentedParams::default())?;
    /// assert!(transformed.mean()[0] > 10.04); // the bend of the circle: 10 + σ²/2r, where a linearization says 10
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`SigmaPoints::new`] and of [`weighted_mean`], which returns its last estimate.
    pub fn new(
        gaussian: &Gaussian<X>,
        function: impl Fn(&X) -> Z,
        params: &UnscentedParams,
    ) -> Result<Self, IterationError<Z>> {
        let sigma = SigmaPoints::new(gaussian, params)?;
        let images: Vec<Z> = sigma.points.iter().map(function).collect();
        Self::from_images(gaussian, &sigma, &images)
    }

    /// The same from images of the sigma points of `gaussian`, in their order.
    ///
    /// # Errors
    /// When images, points and weights differ in number; those of [`weighted_mean`], which returns its last estimate.
    pub fn from_images(
        gaussian: &Gaussian<X>,
        sigma: &SigmaPoints<X>,
        images: &[Z],
    ) -> Result<Self, IterationError<Z>> {
        check_dimension("images", sigma.points.len(), images.len())?;
        check_dimension("covariance weights", images.len(), sigma.covariance_weights.len())?;
        let centre = images.first().ok_or(GaussianError::Empty { what: "points" })?;
        let mean = weighted_mean_near(centre, images, &sigma.mean_weights)?;
        let points = sigma.points.iter().zip(images).zip(&sigma.covariance_weights);
        let deviations = points.map(|((point, image), &weight)| SigmaDeviation {
            weight: nalgebra::convert(weight),
            state: gaussian.mean().local(point),
            image: mean.local(image),
        });
        Ok(Self { deviations: deviations.collect(), n_states: gaussian.dim(), mean })
    }

    /// Mean of $`f(x)`$.
    pub fn mean(&self) -> &Z {
        &self.mean
    }

    /// The sigma points with their images.
    pub fn deviations(&self) -> &[SigmaDeviation<X, Z>] {
        &self.deviations
    }

    /// Covariance of $`f(x)`$ at its mean; singular when $`f`$ maps into fewer dimensions than it shows. Add noise before you invert it.
    pub fn covariance(&self) -> TangentMatrix<Z> {
        let mut covariance = OMatrix::zeros_generic(self.mean.dim(), self.mean.dim());
        for SigmaDeviation { weight, image, .. } in &self.deviations {
            covariance.ger(*weight, image, image, nalgebra::one());
        }
        symmetrize(&mut covariance);
        covariance
    }

    /// $`\mathrm{cov}(x, f(x))`$: `dim X × dim Z`.
    pub fn cross_covariance(&self) -> OMatrix<X::Scalar, X::Dim, Z::Dim> {
        let mut cross_covariance = OMatrix::zeros_generic(self.n_states, self.mean.dim());
        for SigmaDeviation { weight, state, image } in &self.deviations {
            cross_covariance.ger(*weight, state, image, nalgebra::one());
        }
        cross_covariance
    }
}

/// Moments of weighted points: mean on the manifold, covariance at the mean.
///
/// For sample clouds and particles. The covariance divides by the sum of weights.
///
/// ```
/// use nalgebra::Vector1;
/// let (mean, covariance) = wayfix_gaussian_core::weighted_moments(&[Vector1::new(0.0), Vector1::new(2.0)], &[1.0, 1.0])?;
/// assert_eq!((mean[0], covariance[(0, 0)]), (1.0, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of [`weighted_mean`]; and weights that are negative.
pub fn weighted_moments<X: Manifold>(
    points: &[X],
    weights: &[f64],
) -> Result<(X, TangentMatrix<X>), IterationError<X>>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    if let Some(index) = weights.iter().position(|&weight| weight < 0.0) {
        return Err(GaussianError::Weight { index, value: weights[index] }.into());
    }
    let mean = weighted_mean(points, weights)?;
    let sum: f64 = weights.iter().sum();
    let mut covariance = OMatrix::zeros_generic(mean.dim(), mean.dim());
    for (point, weight) in points.iter().zip(weights) {
        let deviation = mean.local(point);
        let share = nalgebra::convert::<f64, X::Scalar>(weight / sum);
        covariance.ger(share, &deviation, &deviation, nalgebra::one());
    }
    symmetrize(&mut covariance);
    Ok((mean, covariance))
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use nalgebra::{Vector1, Vector3};
    use wayfix_estimation_traits::{Angle, Pose2};

    use super::*;

    #[test]
    fn identity_keeps_a_wide_heading() {
        for sigma in [0.5, 1.0, 1.3, 1.5, 1.8] {
            let wide =
                Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.3), &Vector3::new(0.1, 0.1, sigma)).unwrap();
            let same = UnscentedTransform::new(&wide, Pose2::clone, &UnscentedParams::default()).unwrap();
            let heading: f64 = same.mean().heading();
            assert!(abs_diff_eq!(heading, 0.3, epsilon = 1e-9), "{sigma}: {heading}");
            let found: f64 = same.covariance().m33;
            assert!(abs_diff_eq!(found.sqrt(), sigma, epsilon = 1e-9), "{sigma}: {found}");
        }
    }

    #[test]
    fn sigma_points_beyond_half_a_turn_are_refused() {
        let lost = Gaussian::from_sigmas(Angle::new(0.0), &Vector1::new(3.5)).unwrap();
        let transformed = UnscentedTransform::new(&lost, Angle::clone, &UnscentedParams::default());
        let error = transformed.unwrap_err();
        assert!(matches!(error, IterationError::Step(GaussianError::SigmaPointWraps { .. })), "{error:?}");
    }
}
