use crate::discrete::grid::shifted;
use crate::discrete::lattice::n_cells;
use crate::{CondensationError, DiscreteStateSpace, LatticeAxis, StateLattice};

/// What a robot with a heading may do in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Maneuver {
    /// One cell ahead.
    Forward,
    /// One heading counter-clockwise (with x right and y up).
    TurnLeft,
    /// One heading clockwise.
    TurnRight,
    /// Nothing.
    Stay,
}

/// Places in rows and columns with eight headings each, three degrees of freedom.
///
/// Heading 0 points along x (growing columns), each further one 45° counter-clockwise, y along growing rows.
/// The border stops a robot, also in the direction along the border.
///
/// ```
/// use wayfix_condensation::{HeadingGrid, Maneuver, DiscreteStateSpace};
/// let grid = HeadingGrid::new(5, 4)?;
/// let start = grid.state(1, 1, 7).expect("inside");
/// let turned = grid.step(start, Maneuver::TurnLeft);
/// assert_eq!(grid.pose(turned), (1, 1, 0));
/// assert_eq!(grid.pose(grid.step(turned, Maneuver::Forward)), (2, 1, 0));
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeadingGrid {
    axes: [LatticeAxis; 3],
}

/// Columns and rows that one step ahead moves, by heading.
const AHEAD: [(i8, i8); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

impl HeadingGrid {
    /// How many headings a place has.
    pub const HEADINGS: usize = AHEAD.len();

    /// A grid of so many columns and rows.
    ///
    /// # Errors
    /// [`CondensationError::Extent`] when it has no state, or more than a `u32` counts.
    pub fn new(columns: usize, rows: usize) -> Result<Self, CondensationError> {
        n_cells("grid with headings", &[Self::HEADINGS, rows, columns])?;
        let open = |len| LatticeAxis { len, is_cyclic: false };
        Ok(Self { axes: [LatticeAxis { len: Self::HEADINGS, is_cyclic: true }, open(rows), open(columns)] })
    }

    /// The state at a place with a heading, if there is one.
    pub fn state(&self, column: usize, row: usize, heading: usize) -> Option<usize> {
        let [headings, rows, columns] = self.axes.map(|axis| axis.len);
        (column < columns && row < rows && heading < headings)
            .then(|| (heading * rows + row) * columns + column)
    }

    /// Column, row and heading of a state.
    pub fn pose(&self, state: usize) -> (usize, usize, usize) {
        let [_, rows, columns] = self.axes.map(|axis| axis.len);
        (state % columns, state / columns % rows, state / (columns * rows))
    }
}

impl DiscreteStateSpace for HeadingGrid {
    type Action = Maneuver;

    fn n_states(&self) -> usize {
        self.axes.iter().map(|axis| axis.len).product()
    }

    fn actions(&self) -> &[Maneuver] {
        &[Maneuver::Forward, Maneuver::TurnLeft, Maneuver::TurnRight, Maneuver::Stay]
    }

    fn step(&self, state: usize, action: Maneuver) -> usize {
        let [headings, rows, columns] = self.axes.map(|axis| axis.len);
        let (mut column, mut row, mut heading) = self.pose(state);
        match action {
            Maneuver::Forward => {
                let (dx, dy) = AHEAD[heading % headings];
                (column, row) = (shifted(column, dx, columns), shifted(row, dy, rows));
            }
            Maneuver::TurnLeft => heading = (heading + 1) % headings,
            Maneuver::TurnRight => heading = (heading + headings - 1) % headings,
            Maneuver::Stay => {}
        }
        (heading * rows + row) * columns + column
    }
}

impl StateLattice for HeadingGrid {
    fn axes(&self) -> &[LatticeAxis] {
        &self.axes
    }
}
