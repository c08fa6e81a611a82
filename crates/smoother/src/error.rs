use crate::UnconstrainedDirection;

/// Why a graph cannot be built or solved. The graph stays as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SmootherError {
    /// A parameter that is not positive and finite.
    #[error("{what} is {value}; it must be positive and finite")]
    OutOfRange {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// An identifier that this graph does not have. A residual of another graph is told by its number and type only.
    #[error("a variable or residual does not belong to this graph")]
    UnknownId,
    /// A residual that names the same variable twice.
    #[error("a residual connects variable {variable} with itself")]
    SelfConnection {
        /// The variable.
        variable: usize,
    },
    /// A value that is not a finite number where one is needed.
    #[error("{what} of {} is not finite", name(*residual))]
    NotFinite {
        /// Residual, Jacobian, information, or step.
        what: &'static str,
        /// Its number in the order of adding; `None` for the whole graph.
        residual: Option<usize>,
    },
    /// A matrix or vector of another shape than its residual has.
    #[error("{what} of residual {residual} is {}×{}, expected {}×{}", got.0, got.1, expected.0, expected.1)]
    Shape {
        /// Residual, Jacobian or information.
        what: &'static str,
        /// Number of the residual in the order of adding.
        residual: usize,
        /// Rows and columns wanted.
        expected: (usize, usize),
        /// Rows and columns found.
        got: (usize, usize),
    },
    /// An information matrix that is not symmetric.
    #[error("the information is not symmetric: entries across the diagonal differ by {difference:e}")]
    AsymmetricInformation {
        /// Largest difference between an entry and its mirror image.
        difference: f64,
    },
    /// An information matrix with a negative eigenvalue.
    #[error("the information is indefinite: eigenvalues from {smallest:e} to {largest:e}")]
    IndefiniteInformation {
        /// Smallest eigenvalue.
        smallest: f64,
        /// Largest eigenvalue.
        largest: f64,
    },
    /// Variables that no residual names.
    #[error("{} that no residual connects: {}; fix or leave out", count(variables.len(), "variable"), first(variables))]
    WithoutResidual {
        /// Their numbers.
        variables: Vec<usize>,
    },
    /// Directions in which the variables can move without changing any residual.
    #[error(
        "{}{} no residual determines: {}; fix variables or add priors",
        if *complete { "" } else { "at least " },
        count(directions.len(), "direction"),
        first(directions)
    )]
    Unconstrained {
        /// A coordinate for each direction: with all of them known, the graph is determined.
        directions: Vec<UnconstrainedDirection>,
        /// Whether these are all.
        complete: bool,
    },
    /// A system that is not positive definite although no direction is free: residuals of too different sizes.
    #[error(
        "the normal equations cannot be factorized: diagonal entries from {smallest:e} to {largest:e} are too different"
    )]
    IllConditioned {
        /// Smallest diagonal entry.
        smallest: f64,
        /// Largest diagonal entry.
        largest: f64,
    },
    /// Gauss–Newton left the region where residuals are finite.
    #[error(
        "the step of iteration {iteration} leads to a cost that is not finite; Levenberg-Marquardt may converge"
    )]
    Diverged {
        /// Number of the iteration, from 1.
        iteration: usize,
    },
    /// The factor does not fit into memory.
    #[error("not enough memory for a system of {n_rows} rows")]
    OutOfMemory {
        /// Number of tangent coordinates.
        n_rows: usize,
    },
}

impl SmootherError {
    pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), Self> {
        if value > 0.0 && value.is_finite() { Ok(()) } else { Err(Self::OutOfRange { what, value }) }
    }
}

fn name(residual: Option<usize>) -> String {
    residual.map_or("the whole graph".to_owned(), |residual| format!("residual {residual}"))
}

fn count(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

/// The first few, and how many more.
fn first<T: std::fmt::Display>(all: &[T]) -> String {
    let mut text = all.iter().take(6).map(T::to_string).collect::<Vec<_>>().join(", ");
    if all.len() > 6 {
        text += &format!(" and {} more", all.len() - 6);
    }
    text
}
