/// Occlusion of the whole view, by another robot in front of the camera: a Markov chain of two states.
///
/// With probability $`h`$ the view is hidden, and the frame shows the background: its likelihood relative to the background is $`(1 - h)\, p(z | x) / p_{bg}(z) + h`$. So
/// a hidden view gives no evidence against a place, nor for one that does not see the map.
/// ```
/// use wayfix_color_model::ViewOcclusionModel;
/// let occlusion = ViewOcclusionModel { mean_time_free: 9.0, mean_time_hidden: 1.0 };
/// assert!((occlusion.share() - 0.1).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ViewOcclusionModel {
    /// Mean time of a free view, s. Default 10: robots of another team pass that often.
    pub mean_time_free: f64,
    /// Mean time of a hidden view, s; 0 if no view is ever hidden. Default 1: a robot passes by its own length.
    pub mean_time_hidden: f64,
}

impl Default for ViewOcclusionModel {
    fn default() -> Self {
        Self { mean_time_free: 10.0, mean_time_hidden: 1.0 }
    }
}

impl ViewOcclusionModel {
    /// Share of hidden views.
    pub fn share(&self) -> f64 {
        self.mean_time_hidden / (self.mean_time_free + self.mean_time_hidden)
    }

    /// The probability of a hidden view `seconds` later.
    pub(crate) fn predict(&self, hidden: f64, seconds: f64) -> f64 {
        if self.mean_time_hidden == 0.0 {
            return 0.0; // the rate is infinite
        }
        let rate = 1.0 / self.mean_time_free + 1.0 / self.mean_time_hidden;
        self.share() + (hidden - self.share()) * (-rate * seconds).exp()
    }

    /// The probability of a hidden view after a frame with this log-evidence, $`\ln [(1 - h)\, p + h]`$: Bayes.
    pub(crate) fn posterior(hidden: f64, log_evidence: f64) -> f64 {
        (hidden.ln() - log_evidence).exp().min(1.0)
    }
}

/// $`\ln [(1 - h)\, p + h]`$ of $`\ln p`$.
pub(crate) fn or_hidden(log_likelihood: f64, hidden: f64) -> f64 {
    wayfix_gaussian_core::log_sum_exp(&[(1.0 - hidden).ln() + log_likelihood, hidden.ln()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hidden_view_costs_once() {
        let occlusion = ViewOcclusionModel::default();
        let (mut hidden, mut cost) = (occlusion.share(), Vec::new());
        for _ in 0..10 {
            hidden = occlusion.predict(hidden, 0.1);
            let log_evidence = or_hidden(-50.0, hidden);
            cost.push(-log_evidence);
            hidden = ViewOcclusionModel::posterior(hidden, log_evidence);
        }
        assert!((cost[0] - 11_f64.ln()).abs() < 1e-9, "the prior odds"); // 1 of 11
        assert!(cost[9] < 0.11, "it lasts for 1 s, and a frame for 0.1 s");
    }

    #[test]
    fn view_that_is_never_hidden_is_free_at_once() {
        let never = ViewOcclusionModel { mean_time_hidden: 0.0, ..ViewOcclusionModel::default() };
        assert_eq!([0.0, 0.1].map(|seconds| never.predict(never.share(), seconds)), [0.0, 0.0]);
        assert_eq!(or_hidden(-50.0, 0.0), -50.0);
    }
}
