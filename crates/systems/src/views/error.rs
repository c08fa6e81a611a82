use std::{io, path::PathBuf};

use wayfix_condensation::CondensationError;
use wayfix_scene_sim::SimulationError;
use wayfix_sensor_log::ImageError;

/// Errors of learning views and of driving between them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewsError {
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// A file is no image of a known format.
    #[error("{} is neither JPEG nor PNG", path.display())]
    NotAPicture {
        /// Path of the file.
        path: PathBuf,
    },
    /// An image is damaged.
    #[error("{} is damaged", path.display())]
    Image {
        /// Path of the file.
        path: PathBuf,
        /// The decoding error.
        source: ImageError,
    },
    /// An image is uniform.
    #[error("the {which} has one grey value only: all its views look the same")]
    NoContrast {
        /// The learned scene or the real one.
        which: &'static str,
    },
    /// The learned and the real scene differ in size.
    #[error(
        "the learned scene has {learned:?} pixels, the real one {real:?}: they must show the same from the same place"
    )]
    Sizes {
        /// Width and height of the learned scene.
        learned: (usize, usize),
        /// Width and height of the real scene.
        real: (usize, usize),
    },
    /// There are more hypotheses than the memory limit allows.
    #[error("{n_states} places in {n_conditions} lights are more than {max} hypotheses: take a larger step")]
    TooManyStates {
        /// Number of places.
        n_states: usize,
        /// Number of light conditions per place.
        n_conditions: usize,
        /// Largest allowed product of the two.
        max: usize,
    },
    /// Two traverses of the same places have too few images.
    #[error("{}: {n_learned} pictures learned and {n_seen} seen, at least {min} of each are needed", folder.display())]
    TooFewPictures {
        /// Folder of both traverses.
        folder: PathBuf,
        /// Number of images of the first traverse.
        n_learned: usize,
        /// Number of images of the second traverse.
        n_seen: usize,
        /// Minimum number for both.
        min: usize,
    },
    /// Places of the grid have no learned picture.
    #[error(
        "{n_without} of {n_places} places have no picture: each column and row up to the largest needs one"
    )]
    PlacesWithoutPicture {
        /// Places without one.
        n_without: usize,
        /// All places.
        n_places: usize,
    },
    /// A logged drive has no move between two places of the grid.
    #[error(
        "none of {n_rows} rows tells a move between two places of a grid of {columns} × {rows}: dx, dy, column, row"
    )]
    NoMoves {
        /// Rows of the table.
        n_rows: usize,
        /// Columns of the grid.
        columns: usize,
        /// Rows of the grid.
        rows: usize,
    },
    /// A scene cannot be composed or rendered.
    #[error(transparent)]
    Scenery(#[from] SimulationError),
    /// An error of the library.
    #[error(transparent)]
    Condensation(#[from] CondensationError),
}
