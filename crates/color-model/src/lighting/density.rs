use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Distribution of the pixels of one map colour in YUV: $`N(μ[m], Σ[m,m] + ν)`$. [Schulz & Fox 2004, Eqs. 7–9]
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_map::ColorId;
/// # use wayfix_color_model::{LightingFilter, LightingFilterParams};
/// # use wayfix_gaussian_core::Gaussian;
/// # let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0]), DMatrix::identity(3, 3) * 400.0)?;
/// let light = LightingFilter::new(prior, LightingFilterParams::default())?;
/// let density = light.color(ColorId(0));
/// // 400 of the mean and (144, 36, 36) of a pixel about it.
/// assert_eq!(density.covariance.diagonal(), Vector3::new(544.0, 436.0, 436.0));
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorDensity {
    /// Mean (Y, U, V).
    pub mean: Vector3<f64>,
    /// Covariance of a single pixel.
    pub covariance: Matrix3<f64>,
}

impl ColorDensity {
    /// Half of $`KL(p ‖ q) + KL(q ‖ p)`$, nats: a distance of two densities. `None` if one of them is invalid.
    /// ```
    /// use nalgebra::{Matrix3, Vector3};
    /// use wayfix_color_model::ColorDensity;
    /// let at = |y| ColorDensity { mean: Vector3::new(y, 128.0, 128.0), covariance: Matrix3::identity() * 100.0 };
    /// assert_eq!(at(90.0).divergence(&at(90.0)), Some(0.0));
    /// let one_sigma = at(90.0).divergence(&at(100.0)).unwrap();
    /// assert!((one_sigma - 0.5).abs() < 1e-12);
    /// ```
    pub fn divergence(&self, other: &Self) -> Option<f64> {
        let (p, q) = (self.covariance.cholesky()?, other.covariance.cholesky()?);
        let between = self.mean - other.mean;
        let shape = (p.solve(&other.covariance) + q.solve(&self.covariance)).trace() - 6.0;
        let shift = between.dot(&(p.solve(&between) + q.solve(&between)));
        let divergence = 0.25 * (shape + shift);
        divergence.is_finite().then_some(divergence.max(0.0))
    }

    /// Eq. 9 for every colour of a belief $`N(μ, Σ)`$ of the light, with pixels that scatter by $`ν`$.
    pub(super) fn all<'a>(
        mean: &'a DVector<f64>,
        covariance: &'a DMatrix<f64>,
        pixel_color_variance: Vector3<f64>,
    ) -> impl Iterator<Item = Self> + 'a {
        (0..mean.len() / 3).map(move |color| Self {
            mean: mean.fixed_rows::<3>(3 * color).into_owned(),
            covariance: covariance.fixed_view::<3, 3>(3 * color, 3 * color)
                + Matrix3::from_diagonal(&pixel_color_variance),
        })
    }

    /// Density of a colour that does not exist: NaN, which every function of densities rejects.
    pub(super) fn unknown() -> Self {
        Self { mean: Vector3::repeat(f64::NAN), covariance: Matrix3::repeat(f64::NAN) }
    }
}
