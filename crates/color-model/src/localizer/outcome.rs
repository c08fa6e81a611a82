use super::PoseEstimate;

/// What one frame did.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameOutcome {
    /// Where the robot is, after the frame.
    pub estimate: PoseEstimate,
    /// What that estimate is worth.
    pub fix: Fix,
    /// Effective number of particles after weighing.
    pub effective_particles: f64,
    /// Power of the likelihood that left enough of them effective: below 1 while particles are too coarse for what the frame tells.
    pub tempering: f64,
    /// Number of particles after the frame.
    pub n_particles: usize,
    /// Log of the mean likelihood ratio to the background, nats a pixel of the image, before tempering.
    pub log_evidence_per_pixel: f64,
    /// Share of what the image could be explained by at best that the estimate explains; low of a robot that is elsewhere.
    pub fit: f64,
    /// Suspicion that the robot was carried away, 0 to 1: how far the recent fit fell below the usual one.
    pub kidnap_suspicion: f64,
    /// Number of particles injected.
    pub n_injected: usize,
    /// Probability of each member of the lighting bank.
    pub light_probabilities: Vec<f64>,
}

/// What a pose estimate is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fix {
    /// One narrow cluster has most of the weight, and it fits what is seen.
    Tracking,
    /// Several places fit, or one wide one.
    Ambiguous,
    /// No particle explains what is seen, or nothing was seen for long: do not use the pose.
    Lost,
}
