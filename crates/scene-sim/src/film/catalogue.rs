use super::{FilmFrames, OcclusionEvent};
use crate::{SimulationError, check};

/// A film that can be shown: its story, its length, and the seed of everything that is left to chance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SyntheticFilm {
    /// Its name.
    pub name: &'static str,
    /// Number of frames.
    pub n_frames: usize,
    /// Event that affects the target.
    pub occlusion: OcclusionEvent,
    /// Seed of textures, paths, light and noise.
    pub seed: u64,
}

impl SyntheticFilm {
    /// Width and height of every picture, in pixels.
    pub const SIZE_PX: (usize, usize) = (320, 240);

    /// Pictures a second.
    pub const RATE_HZ: f64 = 25.0;

    /// All of them, undisturbed.
    pub const ALL: [Self; 5] =
        [of("circles", 601), of("rectangle", 602), of("beetle", 603), of("snail", 604), of("head", 605)];

    const MAX_FRAMES: usize = 1_000_000;

    /// The film of that name.
    ///
    /// # Errors
    /// Returns [`SimulationError::UnknownScenario`] if there is none.
    pub fn named(name: &str) -> Result<Self, SimulationError> {
        let found = Self::ALL.into_iter().find(|film| film.name == name);
        found.ok_or_else(|| SimulationError::UnknownScenario { name: name.to_owned() })
    }

    /// Shows it from the beginning.
    ///
    /// # Errors
    /// Returns [`SimulationError::UnknownScenario`] if it has the name of none, and [`SimulationError::TooMany`] frames.
    pub fn frames(&self) -> Result<FilmFrames, SimulationError> {
        Self::named(self.name)?;
        check::count("frames", self.n_frames, Self::MAX_FRAMES)?;
        Ok(FilmFrames::new(*self))
    }
}

const fn of(name: &'static str, seed: u64) -> SyntheticFilm {
    SyntheticFilm { name, n_frames: 175, occlusion: OcclusionEvent::None, seed }
}
