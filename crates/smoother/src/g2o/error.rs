use crate::SmootherError;

/// Why a file cannot be read, or its graph not be built.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum G2oError {
    /// The reader failed: damaged or truncated compression, text that is not UTF-8.
    #[error("reading stopped after line {line}: {source}")]
    Read {
        /// Last line that was read.
        line: usize,
        /// What the reader said.
        source: std::io::Error,
    },
    /// A line that cannot be used.
    #[error("line {line}: {problem}")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong with it.
        problem: LineProblem,
    },
    /// A file without edges.
    #[error("the file has no edges")]
    Empty,
    /// Information matrices with negative eigenvalues.
    #[error(
        "{count} of {total} information matrices are indefinite, the first in line {first_line} with eigenvalues down to \
         {smallest:e}; no cost has a minimum with them (a repair on request sets negative eigenvalues to 0)"
    )]
    Indefinite {
        /// How many.
        count: usize,
        /// Of how many.
        total: usize,
        /// Line of the first.
        first_line: usize,
        /// Smallest eigenvalue of all.
        smallest: f64,
    },
    /// The graph cannot be built or solved.
    #[error(transparent)]
    Smoother(#[from] SmootherError),
    /// As [`SmootherError::WithoutResidual`] and [`SmootherError::Unconstrained`], with the names of vertices.
    #[error("{0}")]
    Undetermined(String),
    /// The writer failed.
    #[error("cannot write: {0}")]
    Write(std::io::Error),
}

/// What is wrong with a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LineProblem {
    /// A word at its begin that is not one of the format, or of a kind of vertex or edge that is not read.
    #[error("`{0}` is not a word of g2o that is read, such as VERTEX_SE2, EDGE_SE2, VERTEX_SE3:QUAT or FIX")]
    UnknownTag(String),
    /// Too few or too many numbers.
    #[error("`{tag}` has {got} numbers, expected {expected}")]
    Count {
        /// First word of the line.
        tag: String,
        /// Numbers wanted.
        expected: usize,
        /// Numbers found.
        got: usize,
    },
    /// A word that is not a finite number, or an identifier that is no whole number.
    #[error("`{0}` is not a finite number")]
    NotANumber(String),
    /// A vertex twice.
    #[error("vertex {0} is there already")]
    DuplicateVertex(u64),
    /// An edge or `FIX` that names a vertex of which no line tells.
    #[error("there is no vertex {0}")]
    MissingVertex(u64),
    /// An edge between a pose and a landmark, or landmarks, where poses are needed, or the reverse.
    #[error("vertex {0} is a landmark where a pose is needed, or the reverse")]
    WrongVertex(u64),
    /// An edge from a vertex to itself.
    #[error("the edge leads from vertex {0} to itself")]
    SelfEdge(u64),
    /// A quaternion that is not of unit length, within 1 %.
    #[error("a quaternion of length {0} is no rotation")]
    NotARotation(f64),
    /// A sensor without a line `PARAMS_SE3OFFSET`.
    #[error("there is no sensor {0}")]
    MissingSensor(u64),
    /// Numbers whose products overflow, in the line or in the poses of its vertices.
    #[error("{0} is not finite at the present poses")]
    NotFinite(&'static str),
    /// 2-d and 3-d lines in one file.
    #[error("2-d and 3-d lines are mixed")]
    MixedDimensions,
}
