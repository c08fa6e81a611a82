use std::{io, path::PathBuf};

use wayfix_condensation::CondensationError;
use wayfix_scene_sim::SimError;
use wayfix_sensor_log::ImageError;

/// Why views could not be learned or driven through.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewsError {
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file is no picture of a known kind.
    #[error("{} is neither JPEG nor PNG", path.display())]
    NotAPicture {
        /// Which one.
        path: PathBuf,
    },
    /// A picture is damaged.
    #[error("{} is damaged", path.display())]
    Image {
        /// Which one.
        path: PathBuf,
        /// In what way.
        source: ImageError,
    },
    /// A picture shows the same everywhere.
    #[error("the {which} has one grey value only: all its views look the same")]
    NoContrast {
        /// The learned scene or the real one.
        which: &'static str,
    },
    /// The scene that was learned and the one that is seen are not of one size.
    #[error(
        "the learned scene has {learned:?} pixels, the real one {real:?}: they must show the same from the same place"
    )]
    Sizes {
        /// Width and height that were learned.
        learned: (usize, usize),
        /// Width and height that are seen.
        real: (usize, usize),
    },
    /// More hypotheses than memory is meant for.
    #[error("{n_states} places in {n_conditions} lights are more than {max} hypotheses: take a larger step")]
    TooManyStates {
        /// Places.
        n_states: usize,
        /// Lights that each place is tried in.
        n_conditions: usize,
        /// Most products of the two.
        max: usize,
    },
    /// Two traverses that should show the same places have too few pictures.
    #[error("{}: {n_learned} pictures learned and {n_seen} seen, at least {min} of each are needed", folder.display())]
    TooFewPictures {
        /// Folder of both.
        folder: PathBuf,
        /// Of the first traverse.
        n_learned: usize,
        /// Of the second.
        n_seen: usize,
        /// Least number of both.
        min: usize,
    },
    /// A scene cannot be composed, or not be seen like that.
    #[error(transparent)]
    Scenery(#[from] SimError),
    /// The library refused.
    #[error(transparent)]
    Condensation(#[from] CondensationError),
}
