use nalgebra::{DMatrix, DVector, Vector3};
use serde::{Deserialize, Serialize};
use wayfix_gaussian_core::Gaussian;

use super::{LightingPriorError, LightingPriors};

/// [`LightingPriors`] in file format: plain lists, checked on reading.
#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PriorFile {
    colors: Vec<String>,
    #[serde(alias = "pixel_noise")] // of before, as `mean_noise`
    pixel_color_variance: [f64; 3],
    #[serde(alias = "mean_noise")]
    mean_color_variance: [f64; 3],
    members: Vec<Member>,
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Member {
    mean: Vec<f64>,
    covariance: Vec<Vec<f64>>,
}

impl From<LightingPriors> for PriorFile {
    fn from(priors: LightingPriors) -> Self {
        let member = |gaussian: &Gaussian<DVector<f64>>| Member {
            mean: gaussian.mean().as_slice().to_vec(),
            covariance: gaussian.covariance().row_iter().map(|row| row.iter().copied().collect()).collect(),
        };
        Self {
            colors: priors.colors().to_vec(),
            pixel_color_variance: priors.pixel_color_variance().into(),
            mean_color_variance: priors.mean_color_variance().into(),
            members: priors.members().iter().map(member).collect(),
        }
    }
}

impl TryFrom<PriorFile> for LightingPriors {
    type Error = LightingPriorError;

    fn try_from(file: PriorFile) -> Result<Self, LightingPriorError> {
        let members = file.members.into_iter().map(Member::gaussian).collect::<Result<_, _>>()?;
        Self::new(
            file.colors,
            members,
            Vector3::from(file.pixel_color_variance),
            Vector3::from(file.mean_color_variance),
        )
    }
}

impl Member {
    fn gaussian(self) -> Result<Gaussian<DVector<f64>>, LightingPriorError> {
        let n = self.covariance.len();
        if let Some(row) = self.covariance.iter().find(|row| row.len() != n) {
            return Err(LightingPriorError::Dimension {
                what: "row of a covariance",
                expected: n,
                got: row.len(),
            });
        }
        let covariance = DMatrix::from_fn(n, n, |i, j| self.covariance[i][j]);
        Ok(Gaussian::new(DVector::from_vec(self.mean), covariance)?)
    }
}
