use crate::YuvImage;

/// Bits of Y, U and V that a cell of the histogram leaves out: 32 levels of Y, 8 of U and of V share a cell.
const SHIFTS: [u32; 3] = [4, 3, 3];
const CELLS: usize = 1 << (24 - SHIFTS[0] - SHIFTS[1] - SHIFTS[2]);
/// Levels in a cell.
const CELL_LEVELS: f64 = (1_u32 << (SHIFTS[0] + SHIFTS[1] + SHIFTS[2])) as f64;
/// Share of the density that is uniform, so that no colour is impossible.


/// How often each colour occurs in one frame, as a density over YUV: the background that labels have to beat.
///
/// With $`p_{bg}(c)`$ the frame's own, $`\ln p(c|m) - \ln p_{bg}(c)`$ is the pointwise mutual information of a pixel's colour and its label.
pub struct Surroundings {
    nats: Vec<f32>,
}

impl Surroundings {
    pub fn of(image: &YuvImage) -> Self {
        let mut counts = vec![0_u32; CELLS];
        for pixel in image.pixels() {
            counts[cell(*pixel)] += 1;
        }
        let UNIFORM_SHARE = std::env::var("US").ok().map_or(0.8, |v| v.parse().unwrap());
        let per_pixel = (1.0 - UNIFORM_SHARE) / (image.pixels().len().max(1) as f64 * CELL_LEVELS);
        let uniform = UNIFORM_SHARE / (1_u32 << 24) as f64;
        let nats = counts.iter().map(|&n| -(uniform + per_pixel * f64::from(n)).ln() as f32).collect();
        Self { nats }
    }

    /// $`-\ln p_{bg}(c)`$.
    pub fn nats(&self, pixel: [u8; 3]) -> f64 {
        f64::from(self.nats[cell(pixel)])
    }
}

fn cell([y, u, v]: [u8; 3]) -> usize {
    let [y, u, v] = [(y, 0), (u, 1), (v, 2)].map(|(value, channel)| usize::from(value >> SHIFTS[channel]));
    (y << (16 - SHIFTS[1] - SHIFTS[2])) | (u << (8 - SHIFTS[2])) | v
}
