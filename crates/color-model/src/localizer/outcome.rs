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
    /// How much better the best place explains the frame than the colours that the frame shows on average, nats a pixel: 0.2 to 0.5 where the
    /// robot sees much of the map, about 0 or less where it sees none of it, or is elsewhere.
    pub fit: f64,
    /// How long the recent fit has been low, as a share of the time after which the robot is looked for in doubt, 0 to 1.
    pub kidnap_suspicion: f64,
    /// Places that are still pursued.
    pub n_hypotheses: usize,
    /// Probability of each member of the lighting bank.
    pub light_probabilities: Vec<f64>,
}

/// What a pose estimate is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fix {
    /// One narrow cluster has most of the weight, and what is seen has not spoken against it for long.
    Tracking,
    /// Several places fit, or one wide one.
    Ambiguous,
    /// No particle explains what is seen, or nothing was seen for long: do not use the pose.
    Lost,
}
