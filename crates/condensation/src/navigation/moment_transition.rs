use crate::learning::DisturbanceBelief;
use crate::{N_DISTURBANCES, TransitionModel};

/// Below this belief a state's share of a moment is rounding noise.
const NEGLIGIBLE: f64 = 1e-200;

/// A transition that carries Gaussians along with belief: where several meet they are merged by their moments.
///
/// Transitions are linear, so that $`b`$, $`b μ`$ and $`b (P + μ μ^T)`$ each go through them.
pub(super) struct MomentTransition<'a> {
    pub(super) transition: &'a dyn TransitionModel,
    pub(super) leak: f64,
}

impl MomentTransition<'_> {
    /// Moves belief and disturbances of one condition.
    pub(super) fn apply(&self, belief: &mut [f64], disturbances: &mut [DisturbanceBelief]) {
        let before = belief.to_vec();
        if before.iter().sum::<f64>() < NEGLIGIBLE {
            return; // this light is excluded; nothing to take along
        }
        let old = disturbances.to_vec();
        let carry = |moment: &dyn Fn(&DisturbanceBelief) -> f64| {
            self.arriving(before.iter().zip(&old).map(|(b, disturbance)| b * moment(disturbance)).collect())
        };
        belief.copy_from_slice(&carry(&|_| 1.0));
        let reached = |state: usize| belief[state] > NEGLIGIBLE;
        for i in 0..N_DISTURBANCES {
            let arrived = carry(&|d| d.mean[i]);
            for state in (0..belief.len()).filter(|&state| reached(state)) {
                disturbances[state].mean[i] = arrived[state] / belief[state];
            }
        }
        for (i, j) in (0..N_DISTURBANCES).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let arrived = carry(&|d| d.covariance[i][j] + d.mean[i] * d.mean[j]);
            for state in (0..belief.len()).filter(|&state| reached(state)) {
                let d = &mut disturbances[state];
                let covariance = arrived[state] / belief[state] - d.mean[i] * d.mean[j];
                d.covariance[i][j] = covariance;
                d.covariance[j][i] = covariance;
            }
        }
    }

    /// The transition, with a share that becomes uniform: light and shift stay the same after a kidnapping.
    fn arriving(&self, leaving: Vec<f64>) -> Vec<f64> {
        let mut arriving = vec![0.0; leaving.len()];
        self.transition.predict(&leaving, &mut arriving);
        let everywhere = self.leak * leaving.iter().sum::<f64>() / leaving.len() as f64;
        arriving.iter_mut().for_each(|value| *value = (1.0 - self.leak) * *value + everywhere);
        arriving
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SparseTransition;
    use approx::assert_abs_diff_eq;

    fn belief(mean: f64, variance: f64) -> DisturbanceBelief {
        let mut covariance = [[0.0; N_DISTURBANCES]; N_DISTURBANCES];
        (0..N_DISTURBANCES).for_each(|i| covariance[i][i] = variance);
        DisturbanceBelief { mean: [mean; N_DISTURBANCES], covariance }
    }

    /// Where two meet, mean and variance are those of the mixture; what moves alone stays as it is.
    #[test]
    fn what_meets_is_merged_by_moments() {
        let to_the_middle = SparseTransition::from_rows([[(1, 1.0)], [(2, 1.0)], [(1, 1.0)]]).unwrap();
        let mut mass = [0.2, 0.2, 0.6];
        let mut disturbances = [belief(1.0, 0.5), belief(7.0, 2.0), belief(3.0, 0.1)];
        MomentTransition { transition: &to_the_middle, leak: 0.0 }.apply(&mut mass, &mut disturbances);
        assert_abs_diff_eq!(mass[1], 0.8, epsilon = 1e-15);
        assert_abs_diff_eq!(mass[2], 0.2, epsilon = 1e-15);
        assert_abs_diff_eq!(disturbances[2].mean[0], 7.0, epsilon = 1e-12);
        assert_abs_diff_eq!(disturbances[2].covariance[0][0], 2.0, epsilon = 1e-12);
        // weights 1/4 and 3/4: mean 2.5, within 0.2, between 0.75
        assert_abs_diff_eq!(disturbances[1].mean[3], 2.5, epsilon = 1e-12);
        assert_abs_diff_eq!(disturbances[1].covariance[3][3], 0.95, epsilon = 1e-12);
        assert_abs_diff_eq!(disturbances[1].covariance[3][1], 0.75, epsilon = 1e-12);
    }
}
