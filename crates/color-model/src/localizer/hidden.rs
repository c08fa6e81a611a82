use wayfix_gaussian_core::log_sum_exp;

/// How often somebody stands in front of the camera, and for how long: a chain of two states that keeps such a frame from speaking against a
/// place, or for one that looks away from the field.
///
/// With the probability $`h`$ that the view is hidden, a frame's likelihood relative to the background is $`(1 - h)\, p(z | x) / p_{bg}(z) + h`$:
/// what a hidden camera shows is background.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct HiddenViews {
    /// Mean time in which the view is free, seconds.
    pub free: f64,
    /// Mean time in which it is hidden, seconds.
    pub hidden: f64,
}

impl Default for HiddenViews {
    fn default() -> Self {
        Self { free: 10.0, hidden: 1.0 }
    }
}

impl HiddenViews {
    /// The probability `seconds` later.
    pub(crate) fn predict(&self, hidden: f64, seconds: f64) -> f64 {
        let rate = 1.0 / self.free + 1.0 / self.hidden;
        self.usual() + (hidden - self.usual()) * (-rate * seconds).exp()
    }

    /// The share of all views that are hidden.
    pub(crate) fn usual(&self) -> f64 {
        self.hidden / (self.free + self.hidden)
    }

    pub(crate) fn values(&self) -> [(&'static str, f64); 2] {
        [("time of a free view (s)", self.free), ("time of a hidden view (s)", self.hidden)]
    }
}

/// $`\ln [(1 - h)\, p + h]`$ of $`\ln p`$.
pub(crate) fn or_hidden(log_likelihood: f64, hidden: f64) -> f64 {
    log_sum_exp(&[(1.0 - hidden).ln() + log_likelihood, hidden.ln()])
}

/// Probability that a view of this log-likelihood was hidden.
pub(crate) fn was_hidden(log_likelihood: f64, hidden: f64) -> f64 {
    (hidden.ln() - or_hidden(log_likelihood, hidden)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hidden_view_costs_once_and_ends() {
        let views = HiddenViews::default();
        let (mut hidden, mut costs) = (views.predict(0.0, 1e3), Vec::new());
        for _ in 0..10 {
            hidden = views.predict(hidden, 0.1);
            costs.push(or_hidden(-20.0, hidden));
            hidden = was_hidden(-20.0, hidden);
        }
        // The first frame costs what it takes to be hidden at all, 1 in 11; those after it that it goes on, e^-0.1.
        assert!((costs[0] - (1.0_f64 / 11.0).ln()).abs() < 1e-6, "{costs:?}");
        assert!(costs[1..].iter().all(|cost| (-0.2..0.0).contains(cost)), "{costs:?}");
        // A frame that fits ends it.
        assert!(was_hidden(15.0, views.predict(hidden, 0.1)) < 1e-4);
        assert_eq!(or_hidden(-3.0, 0.0), -3.0);
    }
}
