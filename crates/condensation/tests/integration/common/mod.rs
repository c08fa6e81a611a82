//! A painted scene, and a robot that sees it in another light.

pub(crate) mod place_graph;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_condensation::{
    DiscreteStateSpace, GridMove, NavigationEnvironment, PositionGrid, RgbImage, StateDescriptorTable,
};

/// Soft blobs of colour on a gradient: smooth as photographs are, and different everywhere.
pub(crate) fn scene(width: usize, height: usize, seed: u64) -> RgbImage {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let blobs: Vec<[f64; 6]> = (0..60)
        .map(|_| {
            let at = [rng.random::<f64>() * width as f64, rng.random::<f64>() * height as f64];
            let color: [f64; 3] = std::array::from_fn(|_| rng.random_range(-90.0..90.0));
            [at[0], at[1], rng.random_range(6.0..30.0), color[0], color[1], color[2]]
        })
        .collect();
    let pixel = |i: usize| {
        let (x, y) = ((i % width) as f64, (i / width) as f64);
        let weight = |b: &[f64; 6]| (-0.5 * ((x - b[0]).powi(2) + (y - b[1]).powi(2)) / (b[2] * b[2])).exp();
        let weights: Vec<f64> = blobs.iter().map(weight).collect();
        [0, 1, 2].map(|c| {
            let sum: f64 = blobs.iter().zip(&weights).map(|(b, w)| b[3 + c] * w).sum();
            (110.0 + 0.2 * x + sum).clamp(8.0, 247.0) as u8
        })
    };
    RgbImage::from_raw(width as u32, height as u32, (0..width * height).flat_map(pixel).collect())
        .expect("3 bytes a pixel")
}

/// A robot on a grid of views.
pub(crate) struct Drive {
    pub(crate) grid: PositionGrid,
    pub(crate) seen: StateDescriptorTable,
    pub(crate) at: usize,
    /// After so many looks the robot is put elsewhere.
    pub(crate) kidnapped: Option<(usize, usize)>,
    pub(crate) looks: usize,
}

impl NavigationEnvironment<GridMove> for Drive {
    fn act(&mut self, action: GridMove) {
        self.at = self.grid.step(self.at, action);
    }

    fn observe(&mut self, features: &mut [f64]) {
        self.looks += 1;
        if let Some((_, to)) = self.kidnapped.filter(|&(after, _)| after == self.looks) {
            self.at = to;
        }
        features.copy_from_slice(self.seen.get(self.at).expect("a state of the grid"));
    }
}
