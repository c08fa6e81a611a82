use wayfix_gaussian_core::Gaussian;

use super::{FusionParams, MixtureWeighting, combine};
use crate::{AppearanceMapError, PoseHypothesis, separation_squared};

/// Fuses two mixtures over poses; weights stay as they come out, for the next source to be fused.
///
/// Components nearer than the gate are combined in pairs; those without a counterpart are copied. With [`MixtureWeighting::Evidence`] a predicted component is
/// copied beside its pairs too, with the chance that none of its counterparts is where the view is from: what merely looks alike within the gate of a robot that knows
/// its place to some metres must not take it there alone. Normalize after the last source
/// ([`PoseHypothesis::into_mixture`]): that is what makes unsupported components fade. [Gross et al. 2005, Eqs. 2-8]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{FusionParams, PoseHypothesis, fuse};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let at = |x: f64, weight: f64| -> Result<_, wayfix_appearance_cml::AppearanceMapError> {
///     let gaussian = Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(0.2, 0.2, 0.1))?;
///     Ok(PoseHypothesis::new(weight, gaussian))
/// };
/// let moved = [at(0.0, 0.5)?, at(10.0, 0.5)?];
/// let seen = [at(0.1, 0.4)?];
/// let fused = PoseHypothesis::into_mixture(fuse(&moved, &seen, &FusionParams::as_published())?)?;
/// assert!(fused.weight(0) > 0.6 && fused.weight(1) < 0.4); // 0.9 against 0.5
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// When a covariance is singular or something is not finite.
pub fn fuse(
    predicted: &[PoseHypothesis],
    observed: &[PoseHypothesis],
    params: &FusionParams,
) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
    for hypothesis in predicted.iter().chain(observed) {
        // One that meets no other would pass unseen otherwise.
        Gaussian::new(*hypothesis.gaussian.mean(), *hypothesis.gaussian.covariance())?;
    }
    let agreeing = agreeing(predicted, observed, params.gate)?;
    let mut fused = Vec::with_capacity(predicted.len() + observed.len());
    for pair in &agreeing {
        let (a, b) = (&predicted[pair.predicted], &observed[pair.observed]);
        let weight = match params.mixture_weighting {
            MixtureWeighting::Support => support(pair, predicted, observed, &agreeing),
            MixtureWeighting::Evidence { .. } => a.weight * b.weight * (-0.5 * pair.squared).exp(),
        };
        fused.push(PoseHypothesis::new(weight, combine(a, b, params.fusion_rule)?));
    }
    let (missed, appeared, all_stay) = match params.mixture_weighting {
        MixtureWeighting::Support => (1.0, 1.0, false),
        MixtureWeighting::Evidence { missed, appeared } => (missed, appeared, true),
    };
    let is_alone =
        |index: usize, index_of: fn(&Pair) -> usize| !agreeing.iter().any(|p| index_of(p) == index);
    for (index, a) in predicted.iter().enumerate() {
        if all_stay || is_alone(index, |pair| pair.predicted) {
            fused.push(PoseHypothesis::new(a.weight * missed, a.gaussian.clone()));
        }
    }
    for (index, b) in observed.iter().enumerate() {
        if is_alone(index, |pair| pair.observed) {
            fused.push(PoseHypothesis::new(b.weight * appeared, b.gaussian.clone()));
        }
    }
    Ok(fused)
}

/// Two components that mean one place. [Gross et al. 2005, Eq. 2]
struct Pair {
    predicted: usize,
    observed: usize,
    squared: f64,
}

fn agreeing(
    predicted: &[PoseHypothesis],
    observed: &[PoseHypothesis],
    gate: f64,
) -> Result<Vec<Pair>, AppearanceMapError> {
    let mut pairs = Vec::new();
    // What has no weight supports nothing, and must not take away what it meets.
    let heavy = |hypothesis: &&PoseHypothesis| hypothesis.weight != 0.0;
    for (i, a) in predicted.iter().enumerate() {
        for (j, b) in observed.iter().enumerate().filter(|(_, b)| heavy(b)) {
            let squared = separation_squared(&a.gaussian, &b.gaussian)?;
            if squared < gate {
                pairs.push(Pair { predicted: i, observed: j, squared });
            }
        }
    }
    Ok(pairs)
}

/// $`w = w_a w_b / \hat w_a + w_b w_a / \hat w_b`$ with the whole weights $`\hat w`$ of the counterparts of each.
/// [Gross et al. 2005, Eqs. 6-8]
fn support(pair: &Pair, predicted: &[PoseHypothesis], observed: &[PoseHypothesis], agreeing: &[Pair]) -> f64 {
    let of_a = agreeing.iter().filter(|p| p.predicted == pair.predicted).map(|p| observed[p.observed].weight);
    let of_b = agreeing.iter().filter(|p| p.observed == pair.observed).map(|p| predicted[p.predicted].weight);
    let (counterparts_of_a, counterparts_of_b): (f64, f64) = (of_a.sum(), of_b.sum());
    let (a, b) = (predicted[pair.predicted].weight, observed[pair.observed].weight);
    // A component whose counterparts weigh nothing is supported by nothing.
    let part =
        |whole: f64, counterpart: f64, all: f64| if all > 0.0 { whole * counterpart / all } else { 0.0 };
    part(a, b, counterparts_of_a) + part(b, a, counterparts_of_b)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use wayfix_estimation_traits::Pose2;

    use super::*;

    fn at(x: f64, sigma: f64, weight: f64) -> PoseHypothesis {
        let gaussian = Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(sigma, sigma, 0.1));
        PoseHypothesis::new(weight, gaussian.unwrap())
    }

    fn fused(predicted: &[PoseHypothesis], observed: &PoseHypothesis) -> Vec<PoseHypothesis> {
        fuse(predicted, std::slice::from_ref(observed), &FusionParams::default()).unwrap()
    }

    #[test]
    fn one_look_alike_within_the_gate_takes_nobody_there() {
        let (robot, look_alike) = (at(0.0, 3.0, 1.0), at(8.0, 0.3, 0.1));
        let state = PoseHypothesis::into_mixture(fused(&[robot], &look_alike)).unwrap();
        // w_b e^{-d²/2} against m: 0.1 · e^{-32 / 9.09} = 0.003 against 0.2.
        let stays: f64 = (0..state.len())
            .filter(|i| state.components()[*i].mean().x() == 0.0)
            .map(|i| state.weight(i))
            .sum();
        assert!((stays - 0.2 / (0.2 + 0.1 * (-32.0_f64 / 9.09).exp())).abs() < 1e-9, "{stays}");
    }

    #[test]
    fn who_is_seen_there_again_and_again_is_there() {
        let (mut robot, place) = (vec![at(0.0, 3.0, 1.0)], at(4.0, 0.3, 0.5));
        for _ in 0..4 {
            robot = fused(&robot, &place);
        }
        let there: f64 = robot.iter().filter(|h| h.gaussian.mean().x() > 2.0).map(|h| h.weight).sum();
        let all: f64 = robot.iter().map(|h| h.weight).sum();
        assert!(there > 0.9 * all, "{there} of {all}");
    }

    #[test]
    fn as_printed_what_agrees_leaves_no_copy() {
        let [robot, place] = [at(0.0, 0.3, 1.0), at(0.1, 0.3, 0.5)];
        let printed =
            fuse(std::slice::from_ref(&robot), std::slice::from_ref(&place), &FusionParams::as_published());
        assert_eq!(printed.unwrap().len(), 1);
        assert_eq!(fused(&[robot], &place).len(), 2);
    }
}
