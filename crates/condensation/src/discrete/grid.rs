use crate::discrete::lattice::n_cells;
use crate::{CondensationError, DiscreteStateSpace, LatticeAxis, StateLattice};

/// A step to one of the eight neighbours, or none: $`(dx, dy) ∈ \{-1, 0, 1\}^2`$. [Kasprzak & Szynkiewicz, Sec. 2.3]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GridMove {
    /// Columns to the right.
    pub dx: i8,
    /// Rows down.
    pub dy: i8,
}

impl GridMove {
    /// No step.
    pub const STAY: Self = Self { dx: 0, dy: 0 };

    /// All nine: diagonal steps first, since of equally good steps they keep most choices open, and standing still last.
    pub const ALL: [Self; 9] = [
        Self { dx: -1, dy: -1 },
        Self { dx: 1, dy: -1 },
        Self { dx: -1, dy: 1 },
        Self { dx: 1, dy: 1 },
        Self { dx: 0, dy: -1 },
        Self { dx: -1, dy: 0 },
        Self { dx: 1, dy: 0 },
        Self { dx: 0, dy: 1 },
        Self::STAY,
    ];
}

/// Places in rows and columns, two degrees of freedom; the border stops a [`GridMove`].
///
/// ```
/// use wayfix_condensation::{PositionGrid, GridMove, DiscreteStateSpace};
/// let grid = PositionGrid::new(4, 3)?;
/// let corner = grid.state(3, 2).expect("inside");
/// assert_eq!(grid.step(corner, GridMove { dx: 1, dy: -1 }), grid.state(3, 1).expect("inside"));
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PositionGrid {
    axes: [LatticeAxis; 2],
}

impl PositionGrid {
    /// A grid of so many columns and rows.
    ///
    /// # Errors
    /// [`CondensationError::Extent`] when it has no state, or more than a `u32` counts.
    pub fn new(columns: usize, rows: usize) -> Result<Self, CondensationError> {
        n_cells("grid", &[rows, columns])?;
        Ok(Self { axes: [rows, columns].map(|len| LatticeAxis { len, is_cyclic: false }) })
    }

    /// How many columns it has.
    pub fn columns(&self) -> usize {
        self.axes[1].len
    }

    /// How many rows it has.
    pub fn rows(&self) -> usize {
        self.axes[0].len
    }

    /// The state at a place, if that is inside.
    pub fn state(&self, column: usize, row: usize) -> Option<usize> {
        (column < self.columns() && row < self.rows()).then(|| row * self.columns() + column)
    }

    /// Column and row of a state.
    pub fn place(&self, state: usize) -> (usize, usize) {
        (state % self.columns(), state / self.columns())
    }
}

impl DiscreteStateSpace for PositionGrid {
    type Action = GridMove;

    fn n_states(&self) -> usize {
        self.columns() * self.rows()
    }

    fn actions(&self) -> &[GridMove] {
        &GridMove::ALL
    }

    fn step(&self, state: usize, action: GridMove) -> usize {
        let (column, row) = self.place(state);
        let column = shifted(column, action.dx, self.columns());
        shifted(row, action.dy, self.rows()) * self.columns() + column
    }
}

impl StateLattice for PositionGrid {
    fn axes(&self) -> &[LatticeAxis] {
        &self.axes
    }
}

/// `at` moved by `by`, stopped at the ends.
pub(crate) fn shifted(at: usize, by: i8, len: usize) -> usize {
    at.saturating_add_signed(isize::from(by)).min(len - 1)
}
