use crate::{MixtureWeighting, PoseHypothesis};

/// The weight of all poses that no hypothesis stands for: the robot may be anywhere.
///
/// It is 1 when the robot is switched on and knows nothing, and it fades with each view that some hypothesis expects.
/// While much of it is left new places are readily believed, and no single one is trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Anywhere(f64);

/// Share from which on no hypothesis stands for the whole.
const LITTLE: f64 = 0.2;

impl Anywhere {
    pub(super) fn everything() -> Self {
        Self(1.0)
    }

    pub(super) fn nothing() -> Self {
        Self(0.0)
    }

    pub(super) fn is_little(self) -> bool {
        self.0 < LITTLE
    }

    /// Hypotheses appear with this weight, or with the least that is always left.
    pub(super) fn weighting(self, weighting: MixtureWeighting) -> MixtureWeighting {
        match weighting {
            MixtureWeighting::Support => MixtureWeighting::Support,
            MixtureWeighting::Evidence { missed, appeared } => {
                MixtureWeighting::Evidence { missed, appeared: appeared.max(self.0) }
            }
        }
    }

    /// What is left when these hypotheses, not yet normalized, have taken their part of the weight.
    pub(super) fn after(self, weighting: MixtureWeighting, hypotheses: &[PoseHypothesis]) -> Self {
        let taken: f64 = hypotheses.iter().map(|hypothesis| hypothesis.weight).sum();
        match weighting {
            // As printed nothing is kept for what is not hypothesized.
            MixtureWeighting::Support if hypotheses.is_empty() => self,
            MixtureWeighting::Support => Self::nothing(),
            MixtureWeighting::Evidence { missed, .. } => {
                let left = self.0 * missed;
                if left > 0.0 { Self(left / (left + taken)) } else { Self::nothing() }
            }
        }
    }
}
