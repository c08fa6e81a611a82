use image::RgbImage;

use crate::discrete::PositionGrid;
use crate::{CondensationError, DiscreteStateSpace, View, ViewGrid};

/// A global feature of a view: a few numbers that distinguish views. Implement the first two methods to use your own.
///
/// **Laws**: `extract` writes every component, finite ones; [`extract_all`](Self::extract_all) gives the same numbers to within rounding.
pub trait GlobalDescriptor: Sync {
    /// How many numbers it has.
    fn n_components(&self) -> usize;

    /// Writes the numbers of one view into `features`, which has [`n_components`](Self::n_components) elements.
    fn extract(&self, view: &View<'_>, features: &mut [f64]);

    /// The numbers of all views of a scene: one by one, unless a feature shares work between neighbouring views.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when the scene is not of the size that the views were laid out for.
    fn extract_all(
        &self,
        scene: &RgbImage,
        views: &ViewGrid,
    ) -> Result<StateDescriptorTable, CondensationError> {
        views.check(scene)?;
        let mut table = StateDescriptorTable::zeros(views.grid(), self.n_components());
        for state in 0..views.grid().n_states() {
            self.extract(&views.view(scene, state)?, table.row_mut(state));
        }
        Ok(table)
    }
}

/// The feature vector of every state.
#[derive(Clone, Debug, PartialEq)]
pub struct StateDescriptorTable {
    n_components: usize,
    values: Vec<f64>,
}

impl StateDescriptorTable {
    /// From vectors, one a state, of places that need not be views of one scene.
    ///
    /// # Errors
    /// [`CondensationError::Empty`], [`CondensationError::Dimension`] when lengths differ, [`CondensationError::NotFinite`].
    pub fn from_rows(rows: &[Vec<f64>]) -> Result<Self, CondensationError> {
        let n_components = rows.first().map_or(0, Vec::len);
        if n_components == 0 {
            return Err(CondensationError::Empty { what: "features" });
        }
        for (state, row) in rows.iter().enumerate() {
            crate::error::check_size("feature vector", n_components, row.len())?;
            if let Some(&value) = row.iter().find(|value| !value.is_finite()) {
                return Err(CondensationError::NotFinite { what: "feature of state", index: state, value });
            }
        }
        Ok(Self { n_components, values: rows.concat() })
    }

    pub(crate) fn zeros(grid: &PositionGrid, n_components: usize) -> Self {
        Self { n_components, values: vec![0.0; grid.n_states() * n_components] }
    }

    /// How many numbers a state has.
    pub fn n_components(&self) -> usize {
        self.n_components
    }

    /// How many states there are.
    pub fn n_states(&self) -> usize {
        self.values.len() / self.n_components
    }

    /// The numbers of a state, if there is one of that number.
    pub fn get(&self, state: usize) -> Option<&[f64]> {
        (state < self.n_states()).then(|| self.row(state))
    }

    /// The numbers of all states, in order.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.n_components)
    }

    /// The numbers of a state that exists.
    pub(crate) fn row(&self, state: usize) -> &[f64] {
        &self.values[state * self.n_components..][..self.n_components]
    }

    pub(crate) fn row_mut(&mut self, state: usize) -> &mut [f64] {
        &mut self.values[state * self.n_components..][..self.n_components]
    }
}
