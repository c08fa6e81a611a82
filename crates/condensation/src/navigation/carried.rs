use crate::learning::DisturbanceBelief;
use crate::{N_DISTURBANCES, Transition};

/// Below this belief a state's share of a moment is rounding noise.
const NEGLIGIBLE: f64 = 1e-200;

/// A transition that carries Gaussians along with belief: where several meet they are merged by their moments.
///
/// Transitions are linear, so that $`b`$, $`b μ`$ and $`b (P + μ μ^T)`$ each go through them.
pub(super) struct Carried<'a> {
    pub(super) transition: &'a dyn Transition,
    pub(super) leak: f64,
}

impl Carried<'_> {
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

    /// The transition, and a share that goes everywhere: light and shift stay the same wherever the robot is carried.
    fn arriving(&self, leaving: Vec<f64>) -> Vec<f64> {
        let mut arriving = vec![0.0; leaving.len()];
        self.transition.predict(&leaving, &mut arriving);
        let everywhere = self.leak * leaving.iter().sum::<f64>() / leaving.len() as f64;
        arriving.iter_mut().for_each(|value| *value = (1.0 - self.leak) * *value + everywhere);
        arriving
    }
}
