use super::PoseEstimate;

/// Result of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameOutcome {
    /// Pose of the body after the frame.
    pub estimate: PoseEstimate,
    /// Quality of the estimate.
    pub status: LocalizationStatus,
    /// Effective number of particles after weighing.
    pub effective_particles: f64,
    /// Exponent of the likelihood, at most 1: below 1 while the particles are too far apart for the likelihood of the frame.
    pub tempering: f64,
    /// Number of particles at the estimate.
    pub n_particles: usize,
    /// Probability that the robot is at one of the alternative places.
    pub alternative_probability: f64,
    /// Number of places that are tracked: the estimate and its alternatives.
    pub n_hypotheses: usize,
    /// Probability of each light.
    pub light_probabilities: Vec<f64>,
}

/// Quality of a pose estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalizationStatus {
    /// One place has at least 95 % of the probability, and the cluster of its particles is narrower than a place. A second search, if searches are on, found it again and
    /// was certain of it.
    Tracking,
    /// Several places, one that is wider, or one of which no search was certain.
    Ambiguous,
    /// The last frames together do not support the map at the estimate over the background with 95 % probability. Do not use the pose.
    Lost,
}
