/// Most variables of one residual.
pub(crate) const MOST_VARIABLES: usize = 4;

/// Where a residual finds its variables.
#[derive(Clone, Copy, Default)]
pub struct Keys {
    /// Place in the column of its type.
    pub(crate) slots: [usize; MOST_VARIABLES],
    /// Number among all variables.
    pub(crate) indices: [usize; MOST_VARIABLES],
}
