use nalgebra::{Matrix3, Vector3};

use super::super::{scene::Scene, search::black};
use super::candidate::Candidate;
use crate::{ColorDistributionState, PixelMask, PrincipalColors, TrackingError};

/// Difference of equal colours, as a share of an axis: noise, and changes of light other than intensity.
const SAME: f64 = 0.02;

impl Scene<'_> {
    /// Similarity of the colours inside a candidate's contour to those of a hypothesis, from 0 to 1: the overlap of the two Gaussians
    /// [Bhattacharyya 1943],
    /// ```math
    /// \int \sqrt{p\,q} = \left(\frac{\sqrt{|P||Q|}}{|S|}\right)^{1/2} \exp\left(-\tfrac18 d^\top S^{-1} d\right), \qquad S = \tfrac12 (P + Q).
    /// ```
    ///
    /// The hypothesis is seen in the light of the candidate's strength. A segmentation takes any pixel that has one of the colours; a shadow on
    /// the ground has the darkest of them only.
    pub(in crate::contour) fn color_similarity(
        &self,
        state: &ColorDistributionState,
        candidate: &Candidate,
        mask: &PixelMask,
    ) -> Result<f64, TrackingError> {
        let inside = self.interior(candidate, mask)?;
        let seen: Vec<Vector3<f64>> = self.colors_in(&inside).map(|(_, color)| color.into()).collect();
        if seen.is_empty() {
            return Ok(0.0);
        }
        let seen = PrincipalColors::of(&seen, &vec![1.0; seen.len()], None)?;
        let warp = state.warp_from(&self.reference.colors);
        let (expected, counts): (Vec<Vector3<f64>>, Vec<f64>) = self.reference.cloud.warped(&warp).unzip();
        let expected = PrincipalColors::of(&expected, &counts, None)?;
        let (gain, black) = match black(self.params.color_space) {
            None => (1.0, Vector3::zeros()),
            Some(black) => {
                let [seen, expected] = [seen.mean - black, expected.mean - black];
                (seen.dot(&expected) / expected.norm_squared().max(SAME * SAME), black)
            }
        };
        let apart = seen.mean - black - (expected.mean - black) * gain;
        Ok(overlap(&apart, &covariance(&seen, 1.0), &covariance(&expected, gain)))
    }
}

fn covariance(colors: &PrincipalColors, gain: f64) -> Matrix3<f64> {
    let variances = colors.axis_sigmas.map(|sigma| (gain * sigma).powi(2) + SAME * SAME);
    let axes = colors.axes.matrix();
    axes * Matrix3::from_diagonal(&variances) * axes.transpose()
}

/// Overlap of two Gaussians whose means differ by `apart`.
fn overlap(apart: &Vector3<f64>, p: &Matrix3<f64>, q: &Matrix3<f64>) -> f64 {
    let mean = (p + q) * 0.5;
    let Some(cholesky) = mean.cholesky() else { return 0.0 };
    let distance = apart.dot(&cholesky.solve(apart)) / 8.0;
    let ratio = (p.determinant() * q.determinant()).max(0.0).sqrt() / cholesky.determinant();
    (ratio.sqrt() * (-distance).exp()).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_overlap_of_gaussians_is_that_of_their_formula() {
        let unit = Matrix3::identity();
        let none = Vector3::zeros();
        assert_abs_diff_eq!(overlap(&none, &unit, &unit), 1.0, epsilon = 1e-12);
        // One standard deviation apart in each of two axes: exp(-2/8).
        let apart = Vector3::new(1.0, -1.0, 0.0);
        assert_abs_diff_eq!(overlap(&apart, &unit, &unit), (-0.25_f64).exp(), epsilon = 1e-12);
        // Standard deviations 1 and 3 along one axis: sqrt(3 / 5).
        let wide = Matrix3::from_diagonal(&Vector3::new(9.0, 1.0, 1.0));
        assert_abs_diff_eq!(overlap(&none, &unit, &wide), 0.6_f64.sqrt(), epsilon = 1e-12);
        assert_eq!(overlap(&Vector3::repeat(f64::NAN), &(unit * f64::NAN), &unit), 0.0);
    }
}
