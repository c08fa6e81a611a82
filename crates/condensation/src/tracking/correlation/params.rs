/// How a [`CorrelationTracker`](super::CorrelationTracker) sees, learns and doubts.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrelationTrackerParams {
    pub padding: f64,
    pub inertia: f64,
    pub penalty: f64,
    pub response_width: f64,
    pub support_margin: f64,
    pub color_share: f64,
    pub grey_share: f64,
    pub color_weight: f64,
    pub color_rate: f64,
    pub n_scales: usize,
    pub scale_step: f64,
    pub scale_rate: f64,
    pub scale_regularization: f64,
    pub learn_above: f64,
    pub motion_prior: f64,
}

impl Default for CorrelationTrackerParams {
    fn default() -> Self {
        Self {
            padding: 4.0,
            inertia: 2.5,
            penalty: 0.2,
            response_width: 0.0625,
            support_margin: 1.0,
            color_share: 0.2,
            grey_share: 0.05,
            color_weight: 0.3,
            color_rate: 0.04,
            n_scales: 17,
            scale_step: 1.03,
            scale_rate: 0.025,
            scale_regularization: 0.01,
            learn_above: 0.3,
            motion_prior: 0.0,
        }
    }
}
