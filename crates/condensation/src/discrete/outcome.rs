use wayfix_estimation_traits::LogWeight;

/// How well a measurement fits, in nats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasurementEvidence {
    /// $`\log \sum_s p(m \mid s)\, \hat b(s)`$: at the predicted belief.
    pub log_predicted: LogWeight,
    /// $`\log \frac{1}{n} \sum_s p(m \mid s)`$: anywhere.
    pub log_uniform: LogWeight,
}

/// What a measurement did to the belief.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use = "an impossible measurement leaves the belief unchanged; the caller must decide what to do"]
pub enum MeasurementOutcome {
    /// The belief is the posterior now.
    Updated(MeasurementEvidence),
    /// Every state that belief holds possible rules the measurement out. The belief is as it was; it is never reset silently.
    Impossible,
}

impl MeasurementOutcome {
    /// The evidence, if the measurement was possible.
    pub fn evidence(&self) -> Option<MeasurementEvidence> {
        match self {
            Self::Updated(evidence) => Some(*evidence),
            Self::Impossible => None,
        }
    }

    /// $`\log \frac{1}{n} \sum_s p(m \mid s) - \log \sum_s p(m \mid s)\, \hat b(s)`$, in nats: how much better a robot anywhere explains the
    /// measurement. Infinite for an impossible measurement. A [`Cusum`](wayfix_integrity::CusumTest) of it detects a kidnapped robot.
    pub fn log_likelihood_ratio(&self) -> f64 {
        self.evidence().map_or(f64::INFINITY, |evidence| evidence.log_uniform - evidence.log_predicted)
    }
}
