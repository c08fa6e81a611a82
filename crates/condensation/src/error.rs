use wayfix_gaussian_core::GaussianError;
use wayfix_integrity::IntegrityError;
use wayfix_particle::ParticleError;

/// Why an operation was refused. Whatever it was called on is as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CondensationError {
    /// Something that must hold at least one element holds none.
    #[error("no {what}")]
    Empty {
        /// What there should be some of.
        what: &'static str,
    },
    /// Sizes do not fit.
    #[error("{what} has size {got}, expected {expected}")]
    Dimension {
        /// What has the wrong size.
        what: &'static str,
        /// The size that fits.
        expected: usize,
        /// The size that came.
        got: usize,
    },
    /// A number is NaN or infinite where it must not be.
    #[error("{what} {index} is {value}")]
    NotFinite {
        /// What it is.
        what: &'static str,
        /// Its position in its list.
        index: usize,
        /// The number.
        value: f64,
    },
    /// A parameter or a probability is outside its range.
    #[error("{what} is {value}, must be {range}")]
    Parameter {
        /// Which one.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// The probabilities of where a state leads do not sum to one.
    #[error("the transition probabilities out of state {state} sum to {sum}")]
    RowSum {
        /// The state.
        state: usize,
        /// The sum.
        sum: f64,
    },
    /// A belief without mass is no distribution.
    #[error("the belief is zero everywhere")]
    ZeroBelief,
    /// There is no such state.
    #[error("state {state} does not exist, there are {n_states}")]
    State {
        /// The requested state.
        state: usize,
        /// How many there are.
        n_states: usize,
    },
    /// A state space, a picture or a window has a side of zero, or more cells than can be counted.
    #[error("{what} of size {size:?}")]
    Extent {
        /// What it is.
        what: &'static str,
        /// Its sides.
        size: Vec<usize>,
    },
    /// Not one view fits into the scene.
    #[error("a view of {view:?} pixels does not fit into a scene of {scene:?}")]
    SceneSmallerThanView {
        /// Width and height of the scene.
        scene: (usize, usize),
        /// Width and height of a view.
        view: (usize, usize),
    },
    /// A covariance cannot be used.
    #[error(transparent)]
    Gaussian(#[from] GaussianError),
    /// A change test cannot be made.
    #[error(transparent)]
    Integrity(#[from] IntegrityError),
    /// Samples cannot be drawn or weighed.
    #[error(transparent)]
    Particle(#[from] ParticleError),
}

/// `value`, if it lies in `range`.
pub(crate) fn checked(
    what: &'static str,
    value: f64,
    valid: bool,
    range: &'static str,
) -> Result<f64, CondensationError> {
    if valid { Ok(value) } else { Err(CondensationError::Parameter { what, value, range }) }
}

/// `value` as a probability, both ends included.
pub(crate) fn probability(what: &'static str, value: f64) -> Result<f64, CondensationError> {
    checked(what, value, (0.0..=1.0).contains(&value), "between 0 and 1")
}

/// Whether `state` is one of `n_states`.
pub(crate) fn check_state(state: usize, n_states: usize) -> Result<(), CondensationError> {
    if state < n_states { Ok(()) } else { Err(CondensationError::State { state, n_states }) }
}

/// Whether sizes agree.
pub(crate) fn check_size(what: &'static str, expected: usize, got: usize) -> Result<(), CondensationError> {
    if expected == got { Ok(()) } else { Err(CondensationError::Dimension { what, expected, got }) }
}
