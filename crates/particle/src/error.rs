use wayfix_gaussian_core::GaussianError;

/// Why an operation on particles was refused. Its operand is unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ParticleError {
    /// There must be at least one particle.
    #[error("no particles")]
    NoParticles,
    /// So many particles do not fit into memory.
    #[error("no room for {requested} particles")]
    TooMany {
        /// The requested number.
        requested: usize,
    },
    /// Two lists that belong together differ in length.
    #[error("{states} states but {log_weights} log weights")]
    Lengths {
        /// Length of the one.
        states: usize,
        /// Length of the other.
        log_weights: usize,
    },
    /// A log weight or log-likelihood is NaN or positive infinity, or their sum is.
    #[error("log weight {index} is {value}")]
    LogWeight {
        /// Whose.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A plain weight is negative or not finite.
    #[error("weight {index} is {value}")]
    Weight {
        /// Whose.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The weights are all zero: every particle is impossible, and what to do about it is the caller's decision.
    #[error("all {count} weights are zero")]
    NoWeight {
        /// How many there are.
        count: usize,
    },
    /// A resampler chose an ancestor that does not exist.
    #[error("ancestor {ancestor} of {n_particles} particles")]
    Ancestor {
        /// The one it chose.
        ancestor: usize,
        /// How many there are.
        n_particles: usize,
    },
    /// A motion gave a state that is not finite.
    #[error("state {index} is not finite")]
    State {
        /// Whose.
        index: usize,
    },
    /// A parameter is outside its range.
    #[error("{what} is {value}, must be {range}")]
    Parameter {
        /// Which one.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The values it may take.
        range: &'static str,
    },
    /// The particles have no mean, for instance because they lie all round a circle.
    #[error("moments: {0}")]
    Moments(#[from] GaussianError),
}
