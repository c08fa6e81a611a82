use std::f64::consts::TAU;

use wayfix_gaussian_core::Gaussian;

use super::{GaussianMixtureLikelihood, MixtureFusionParams, MixtureWeighting, UniformComponent, combine};
use crate::{AppearanceMapError, PoseHypothesis, separation_squared};

/// Fuses a predicted mixture with a measurement. The weights are not normalized, so that further sources can be fused.
///
/// With [`MixtureWeighting::Evidence`] each component of the prediction is integrated over the likelihood. A component $`a`$ gives one component for
/// each peak $`b`$ within the gate, and remains itself with the floor $`m`$:
///
/// $`w_{ab} = w_a w_b \sqrt{|C_b| / |C_a + C_b|}\, e^{-d^2/2}`$, $`w_{a0} = w_a m`$.
///
/// The uniform component gives $`w_u w_b (2π)^{3/2} |C_b|^{1/2} / V`$ and $`w_u m`$; a peak wider than the map leaves it uniform,
/// with the share $`\sqrt{2π} σ_θ / 2π`$ of the headings. With [`MixtureWeighting::Support`] components are fused in pairs
/// or copied, and nothing is uniform any more. [Gross et al. 2005, Eqs. 2–8, Fig. 2]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{MixtureFusionParams, PoseHypothesis, GaussianMixtureLikelihood, UniformComponent, fuse};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let at = |x: f64, weight: f64| -> Result<_, wayfix_appearance_cml::AppearanceMapError> {
///     let gaussian = Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(0.2, 0.2, 0.1))?;
///     Ok(PoseHypothesis::new(weight, gaussian))
/// };
/// let moved = [at(0.0, 0.5)?, at(10.0, 0.5)?];
/// let seen = GaussianMixtureLikelihood { peaks: vec![at(0.1, 0.4)?], floor: 0.1 };
/// let nowhere_else = UniformComponent { weight: 0.0, volume: 1.0 };
/// let (fused, _) = fuse(&moved, nowhere_else, &seen, &MixtureFusionParams::as_published())?;
/// let fused = PoseHypothesis::into_mixture(fused)?;
/// assert!(fused.weight(0) > 0.6 && fused.weight(1) < 0.4); // 0.9 against 0.5
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// Returns an error if a covariance is singular or a number is not finite.
pub fn fuse(
    predicted: &[PoseHypothesis],
    uniform: UniformComponent,
    observed: &GaussianMixtureLikelihood,
    params: &MixtureFusionParams,
) -> Result<(Vec<PoseHypothesis>, UniformComponent), AppearanceMapError> {
    for hypothesis in predicted.iter().chain(&observed.peaks) {
        // A hypothesis without a counterpart would pass unchecked otherwise.
        Gaussian::new(*hypothesis.gaussian.mean(), *hypothesis.gaussian.covariance())?;
        crate::check::share("independent share of a hypothesis", hypothesis.independent)?;
    }
    let pairs = pairs(predicted, &observed.peaks, params.gate)?;
    let mut fused = Vec::with_capacity(predicted.len() + observed.peaks.len() + pairs.len());
    for pair in &pairs {
        let (a, b) = (&predicted[pair.predicted], &observed.peaks[pair.observed]);
        let weight = match params.mixture_weighting {
            MixtureWeighting::Support => support(pair, predicted, &observed.peaks, &pairs),
            MixtureWeighting::Evidence => evidence(a, b, pair.squared)?,
        };
        fused.push(PoseHypothesis::new(weight, combine(a, b, params.fusion_rule)?));
    }
    let copied = |hypothesis: &PoseHypothesis, factor: f64| {
        PoseHypothesis::new(hypothesis.weight * factor, hypothesis.gaussian.clone())
    };
    match params.mixture_weighting {
        MixtureWeighting::Support => {
            let is_alone = |of: fn(&Pair) -> usize, index: usize| !pairs.iter().any(|pair| of(pair) == index);
            let alone = predicted.iter().enumerate().filter(|(i, _)| is_alone(|pair| pair.predicted, *i));
            fused.extend(alone.map(|(_, a)| copied(a, 1.0)));
            let alone = observed.peaks.iter().enumerate().filter(|(i, _)| is_alone(|pair| pair.observed, *i));
            fused.extend(alone.map(|(_, b)| copied(b, 1.0)));
            let weight = if fused.is_empty() { uniform.weight } else { 0.0 };
            Ok((fused, UniformComponent { weight, ..uniform }))
        }
        MixtureWeighting::Evidence => {
            fused.extend(predicted.iter().map(|a| copied(a, observed.floor)));
            let mut kept = observed.floor;
            for b in &observed.peaks {
                let share = uniform.share_of(&b.gaussian);
                if share < 1.0 {
                    fused.push(copied(b, uniform.weight * share));
                } else {
                    kept += b.weight * (b.gaussian.sigmas().z / TAU.sqrt()).min(1.0);
                }
            }
            Ok((fused, UniformComponent { weight: uniform.weight * kept, ..uniform }))
        }
    }
}

/// $`w_a w_b \sqrt{|C_b| / |C_a + C_b|}\, e^{-d^2/2}`$.
fn evidence(a: &PoseHypothesis, b: &PoseHypothesis, squared: f64) -> Result<f64, AppearanceMapError> {
    let seen = b.gaussian.in_chart_at(a.gaussian.mean())?;
    let sum = a.gaussian.covariance() + seen.covariance();
    let normalizer = (seen.covariance().determinant() / sum.determinant()).sqrt();
    Ok(a.weight * b.weight * normalizer * (-squared / 2.0).exp())
}

/// Two components that mean one place. [Gross et al. 2005, Eq. 2]
struct Pair {
    predicted: usize,
    observed: usize,
    squared: f64,
}

fn pairs(
    predicted: &[PoseHypothesis],
    observed: &[PoseHypothesis],
    gate: f64,
) -> Result<Vec<Pair>, AppearanceMapError> {
    let mut pairs = Vec::new();
    for (i, a) in predicted.iter().enumerate() {
        // A component without weight supports nothing.
        for (j, b) in observed.iter().enumerate().filter(|(_, b)| b.weight != 0.0) {
            let squared = separation_squared(&a.gaussian, &b.gaussian)?;
            if squared < gate {
                pairs.push(Pair { predicted: i, observed: j, squared });
            }
        }
    }
    Ok(pairs)
}

/// $`w = w_a w_b / \hat w_a + w_b w_a / \hat w_b`$ with the sums $`\hat w`$ of the weights of the counterparts. [Gross et al. 2005, Eqs. 6–8]
fn support(pair: &Pair, predicted: &[PoseHypothesis], observed: &[PoseHypothesis], pairs: &[Pair]) -> f64 {
    let of_a = pairs.iter().filter(|p| p.predicted == pair.predicted).map(|p| observed[p.observed].weight);
    let of_b = pairs.iter().filter(|p| p.observed == pair.observed).map(|p| predicted[p.predicted].weight);
    let (counterparts_of_a, counterparts_of_b): (f64, f64) = (of_a.sum(), of_b.sum());
    let (a, b) = (predicted[pair.predicted].weight, observed[pair.observed].weight);
    // Counterparts without weight support nothing.
    let part =
        |whole: f64, counterpart: f64, all: f64| if all > 0.0 { whole * counterpart / all } else { 0.0 };
    part(a, b, counterparts_of_a) + part(b, a, counterparts_of_b)
}

#[cfg(test)]
mod tests {
    use approx::{abs_diff_eq, assert_abs_diff_eq};
    use nalgebra::{Matrix3, Vector3};
    use wayfix_estimation_traits::Pose2;

    use super::*;

    const FLOOR: f64 = 0.1;

    fn at(x: f64, sigma: f64, weight: f64) -> PoseHypothesis {
        let gaussian = Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(sigma, sigma, 0.1));
        PoseHypothesis::new(weight, gaussian.unwrap())
    }

    fn fused(
        predicted: &[PoseHypothesis],
        peak: &PoseHypothesis,
        params: &MixtureFusionParams,
    ) -> Vec<PoseHypothesis> {
        let uniform = UniformComponent { weight: 0.0, volume: 1.0 };
        let seen = GaussianMixtureLikelihood { peaks: vec![peak.clone()], floor: FLOOR };
        fuse(predicted, uniform, &seen, params).unwrap().0
    }

    #[test]
    fn evidence_is_the_integral_over_the_component() {
        let (a, b) = (at(0.0, 3.0, 1.0), at(4.0, 0.3, 0.5));
        let weight = fused(std::slice::from_ref(&a), &b, &MixtureFusionParams::default())[0].weight;
        // Numerically, with the standard normal of `a` in x; y and heading at the centre give the ratio of their σ.
        let density = |x: f64| (-0.5 * (x / 3.0).powi(2)).exp() / (3.0 * std::f64::consts::TAU.sqrt());
        let peak = |x: f64| 0.5 * (-0.5 * ((x - 4.0) / 0.3).powi(2)).exp();
        let along: f64 =
            (-20_000..20_000).map(|k| 1e-3 * f64::from(k)).map(|x| 1e-3 * density(x) * peak(x)).sum();
        let across = 0.3 / (3.0_f64.powi(2) + 0.3_f64.powi(2)).sqrt() * 0.1 / (2.0 * 0.01_f64).sqrt();
        assert!(
            abs_diff_eq!(weight / (along * across), 1.0, epsilon = 1e-6),
            "{weight} and {}",
            along * across
        );
    }

    #[test]
    fn missed_component_keeps_the_floor() {
        let far = fused(&[at(0.0, 0.3, 1.0)], &at(8.0, 0.3, 0.5), &MixtureFusionParams::default());
        assert!(far.iter().any(|h| h.gaussian.mean().x() == 0.0 && h.weight == FLOOR));
    }

    #[test]
    fn repeated_match_moves_the_weight_there() {
        let (mut robot, place) = (vec![at(0.0, 1.0, 1.0)], at(1.5, 0.3, 0.5));
        for _ in 0..8 {
            robot = fused(&robot, &place, &MixtureFusionParams::default());
        }
        let there: f64 = robot.iter().filter(|h| h.gaussian.mean().x() > 0.75).map(|h| h.weight).sum();
        let all: f64 = robot.iter().map(|h| h.weight).sum();
        assert!(there > 0.9 * all, "{there} of {all}");
    }

    #[test]
    fn weight_of_the_unknown_pose_is_a_probability() {
        let uniform = UniformComponent { weight: 1.0, volume: 1000.0 };
        let peak = PoseHypothesis::new(0.5, at(0.0, 0.3, 1.0).gaussian);
        let seen = GaussianMixtureLikelihood { peaks: vec![peak.clone()], floor: FLOOR };
        let (places, left) = fuse(&[], uniform, &seen, &MixtureFusionParams::default()).unwrap();
        let volume = (2.0 * std::f64::consts::PI).powf(1.5) * (0.3 * 0.3 * 0.1);
        assert_abs_diff_eq!(places[0].weight, 0.5 * volume / 1000.0, epsilon = 1e-12);
        assert_eq!(left.weight, FLOOR);
        // A peak wider than the map gives no place.
        let wide = GaussianMixtureLikelihood { peaks: vec![at(0.0, 100.0, 0.5)], floor: FLOOR };
        let (places, left) = fuse(&[], uniform, &wide, &MixtureFusionParams::default()).unwrap();
        let headings = 0.1 / std::f64::consts::TAU.sqrt();
        assert_abs_diff_eq!(left.weight - 0.5 * headings, FLOOR, epsilon = 1e-12);
        assert!(places.is_empty());
        // A source of probability 0.9 takes 0.9 of it, whatever the extent of the map.
        let source = GaussianMixtureLikelihood::of_probabilities(
            vec![PoseHypothesis { weight: 0.9, ..peak }],
            &uniform,
        );
        let (places, left) = fuse(&[], uniform, &source, &MixtureFusionParams::default()).unwrap();
        assert_abs_diff_eq!(places[0].weight, 0.9, epsilon = 1e-12);
        assert_abs_diff_eq!(left.weight, 0.1, epsilon = 1e-12);
    }

    #[test]
    fn published_pairs_leave_no_copy() {
        let [robot, place] = [at(0.0, 0.3, 1.0), at(0.1, 0.3, 0.5)];
        assert_eq!(
            fused(std::slice::from_ref(&robot), &place, &MixtureFusionParams::as_published()).len(),
            1
        );
        assert_eq!(fused(&[robot], &place, &MixtureFusionParams::default()).len(), 3);
    }

    #[test]
    fn singular_hypothesis_is_refused_without_a_counterpart() {
        let flat = Gaussian::from_parts_unchecked(Pose2::new(9.0, 0.0, 0.0), Matrix3::zeros());
        let seen = GaussianMixtureLikelihood { peaks: vec![PoseHypothesis::new(1.0, flat)], floor: FLOOR };
        let uniform = UniformComponent { weight: 0.0, volume: 1.0 };
        assert!(fuse(&[at(0.0, 0.3, 1.0)], uniform, &seen, &MixtureFusionParams::default()).is_err());
    }
}
