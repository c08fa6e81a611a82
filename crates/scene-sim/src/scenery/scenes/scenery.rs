use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::{all, lab, lift, map};
use crate::SimulationError;
use crate::random::RandomStreams;
use crate::scenery::RgbPicture;

/// A named scene, and the grid of views it has room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scenery {
    /// Its name.
    pub name: &'static str,
    /// Views from left to right.
    pub columns: usize,
    /// Views from top to bottom.
    pub rows: usize,
    /// Pixels between neighbouring views.
    pub step_px: usize,
    /// Seed of its random details.
    pub seed: u64,
}

impl Scenery {
    /// Width and height of a view, in pixels. [Kasprzak & Szynkiewicz, Sec. 3.5]
    pub const VIEW_PX: usize = 256;

    /// As many states as the paper's scenes of these names have: 352, 234, 594 and 150. [Kasprzak & Szynkiewicz, Table 3, Fig. 3]
    pub const ALL: [Self; 4] = [
        Self { name: "lift", columns: 22, rows: 16, step_px: 16, seed: 501 },
        Self { name: "map", columns: 18, rows: 13, step_px: 32, seed: 502 },
        Self { name: "all", columns: 27, rows: 22, step_px: 16, seed: 503 },
        Self { name: "lab", columns: 15, rows: 10, step_px: 32, seed: 504 },
    ];

    /// The scene of that name.
    ///
    /// # Errors
    /// Returns [`SimulationError::UnknownScenario`] if there is none.
    pub fn named(name: &str) -> Result<Self, SimulationError> {
        let found = Self::ALL.into_iter().find(|scenery| scenery.name == name);
        found.ok_or_else(|| SimulationError::UnknownScenario { name: name.to_owned() })
    }

    /// Number of views.
    pub fn n_states(&self) -> usize {
        self.columns * self.rows
    }

    /// Width and height in pixels.
    pub fn size_px(&self) -> (usize, usize) {
        let length = |n: usize| Self::VIEW_PX + n.saturating_sub(1) * self.step_px;
        (length(self.columns), length(self.rows))
    }

    /// The scene as it is learned.
    pub fn compose(&self) -> RgbPicture {
        let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(self.seed));
        let size = self.size_px();
        let canvas = match self.name {
            "lift" => lift::paint(size, &mut streams),
            "map" => map::paint(size, &mut streams),
            "lab" => lab::paint(size, &mut streams),
            _ => all::paint(size, &mut streams),
        };
        canvas.finish()
    }
}
