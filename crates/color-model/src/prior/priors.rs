use nalgebra::{DVector, Vector3};
use wayfix_gaussian_core::Gaussian;

use super::{LightingPriorError, error::check_positive};

/// Priors of the light before the first image: a Gaussian over all colours for each kind of light, from dark to bright.
///
/// A lighting filter starts from each member. With the feature `serde` it can be stored in a file.
/// ```
/// use nalgebra::{DMatrix, DVector, Vector3};
/// use wayfix_color_model::LightingPriors;
/// use wayfix_gaussian_core::Gaussian;
/// let shared_light = DMatrix::from_fn(6, 6, |i, j| if i == j { 100.0 } else if i % 3 == j % 3 { 90.0 } else { 0.0 });
/// let member = Gaussian::new(DVector::from_element(6, 128.0), shared_light)?;
/// let noise = Vector3::new(144.0, 36.0, 36.0);
/// let joint = LightingPriors::new(vec!["green".into(), "white".into()], vec![member], noise, noise)?;
/// let independent = joint.independent();
/// assert_eq!(independent.members()[0].covariance()[(0, 3)], 0.0);
/// assert_eq!(independent.members()[0].covariance()[(3, 3)], 100.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::file::PriorFile", into = "super::file::PriorFile"))]
pub struct LightingPriors {
    colors: Vec<String>,
    members: Vec<Gaussian<DVector<f64>>>,
    pixel_color_variance: Vector3<f64>,
    mean_color_variance: Vector3<f64>,
}

impl LightingPriors {
    /// Priors for `colors` in the map's order, one or more, with the variances (Y, U, V) of pixels and of an image's mean of a colour.
    ///
    /// # Errors
    /// Returns an error if there is no colour or no member, a member has not three numbers a colour or is not positive definite, or a variance is not
    /// positive.
    pub fn new(
        colors: Vec<String>,
        members: Vec<Gaussian<DVector<f64>>>,
        pixel_color_variance: Vector3<f64>,
        mean_color_variance: Vector3<f64>,
    ) -> Result<Self, LightingPriorError> {
        for (what, got) in [("colours of the priors", colors.len()), ("members of the priors", members.len())]
        {
            if got == 0 {
                return Err(LightingPriorError::Dimension { what, expected: 1, got });
            }
        }
        for member in &members {
            let (expected, got) = (3 * colors.len(), member.mean().len());
            if expected != got {
                return Err(LightingPriorError::Dimension {
                    what: "numbers of a lighting prior",
                    expected,
                    got,
                });
            }
            Gaussian::new(member.mean().clone(), member.covariance().clone())?;
        }
        pixel_color_variance
            .iter()
            .chain(&mean_color_variance)
            .try_for_each(|variance| check_positive("variance of the noise", *variance))?;
        Ok(Self { colors, members, pixel_color_variance, mean_color_variance })
    }

    /// Names of the colours, in the order of the map.
    pub fn colors(&self) -> &[String] {
        &self.colors
    }

    /// The Gaussians over all colours' (Y, U, V), a kind of light each.
    pub fn members(&self) -> &[Gaussian<DVector<f64>>] {
        &self.members
    }

    /// Variance of a pixel about the mean of its colour, $`ν`$, (Y, U, V).
    pub fn pixel_color_variance(&self) -> Vector3<f64> {
        self.pixel_color_variance
    }

    /// Variance of an image's mean of a colour about the light's, (Y, U, V).
    pub fn mean_color_variance(&self) -> Vector3<f64> {
        self.mean_color_variance
    }

    /// The same without correlations between colours: no colour informs another. [Schulz & Fox 2004, V.A]
    pub fn independent(&self) -> Self {
        let members = self.members.iter().map(|member| {
            let mut covariance = member.covariance().clone();
            for column in 0..covariance.ncols() {
                for row in 0..covariance.nrows() {
                    if row / 3 != column / 3 {
                        covariance[(row, column)] = 0.0;
                    }
                }
            }
            // Diagonal blocks of a positive definite matrix are positive definite.
            Gaussian::from_parts_unchecked(member.mean().clone(), covariance)
        });
        Self { members: members.collect(), ..self.clone() }
    }
}
