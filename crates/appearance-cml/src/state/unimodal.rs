use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

/// The heaviest component, if its weight is at least `min_weight`. [Gross et al. 2005, Sec. 2.1]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::unimodal;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::{Gaussian, GaussianMixture};
/// let at = |x: f64| Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1));
/// let one_mode = GaussianMixture::from_weights(vec![(0.1, at(0.0)?), (0.9, at(4.0)?)])?;
/// assert_eq!(unimodal(&one_mode, 0.8).map(|g| g.mean().x()), Some(4.0));
/// let two_modes = GaussianMixture::from_weights(vec![(0.4, at(0.0)?), (0.6, at(4.0)?)])?;
/// assert!(unimodal(&two_modes, 0.8).is_none());
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
pub fn unimodal(mixture: &GaussianMixture<Pose2<f64>>, min_weight: f64) -> Option<&Gaussian<Pose2<f64>>> {
    let weights = mixture.weights();
    let heaviest = (0..weights.len()).max_by(|&i, &j| weights[i].total_cmp(&weights[j]))?;
    (weights[heaviest] >= min_weight).then(|| &mixture.components()[heaviest])
}
