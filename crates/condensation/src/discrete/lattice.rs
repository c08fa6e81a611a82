use crate::{CondensationError, DiscreteStateSpace};

/// One direction of a lattice of states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeAxis {
    /// How many steps it has.
    pub len: usize,
    /// Whether the last step neighbours the first, as with headings.
    pub is_cyclic: bool,
}

/// A state space whose states form a box, numbered with the last axis fastest.
///
/// **Law**: the product of the axes' lengths is the number of states.
pub trait StateLattice: DiscreteStateSpace {
    /// The axes, slowest first.
    fn axes(&self) -> &[LatticeAxis];
}

/// How many cells a box has, if it has any and a `u32` counts them (transitions store states so).
pub(crate) fn n_cells(what: &'static str, sides: &[usize]) -> Result<usize, CondensationError> {
    sides
        .iter()
        .try_fold(1_usize, |product, &side| product.checked_mul(side))
        .filter(|&product| product > 0 && u32::try_from(product).is_ok())
        .ok_or_else(|| CondensationError::Extent { what, size: sides.to_vec() })
}
