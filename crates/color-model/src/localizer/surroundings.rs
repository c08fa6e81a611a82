use crate::YuvImage;

/// Bits of Y, U and V that a cell of the histogram leaves out.
const SHIFTS: [u32; 3] = [4, 3, 3];
const CELLS: usize = 1 << (24 - SHIFTS[0] - SHIFTS[1] - SHIFTS[2]);
/// YUV values in a cell.
const CELL_LEVELS: f64 = (1_u32 << (SHIFTS[0] + SHIFTS[1] + SHIFTS[2])) as f64;

/// Share of the background that looks like the rest of the frame. The frame also shows the map's colours, which the background does
/// not have, so the larger part is uniform: a label then gains up to 3 nats over none where it explains a pixel as well as the frame does.
const LIKE_THE_FRAME: f64 = 0.05;

/// The background that labels have to beat when none was learned: in part how often each colour occurs in the frame itself.
///
/// A uniform background would reward any label of a grey wall; against the frame's own colours, rare ones (beacons, goals) count most.
pub(crate) struct Surroundings {
    nats: Vec<f32>,
}

impl Surroundings {
    pub(crate) fn of(image: &YuvImage) -> Self {
        let mut counts = vec![0_u32; CELLS];
        for pixel in image.pixels() {
            counts[cell(*pixel)] += 1;
        }
        let per_pixel = LIKE_THE_FRAME / (image.pixels().len().max(1) as f64 * CELL_LEVELS);
        let uniform = (1.0 - LIKE_THE_FRAME) / f64::from(1_u32 << 24);
        let nats = counts.iter().map(|&n| -(uniform + per_pixel * f64::from(n)).ln() as f32).collect();
        Self { nats }
    }

    /// $`-\ln p_{bg}(c)`$.
    pub(crate) fn nats(&self, pixel: [u8; 3]) -> f64 {
        f64::from(self.nats[cell(pixel)])
    }
}

fn cell([y, u, v]: [u8; 3]) -> usize {
    let [y, u, v] = [(y, 0), (u, 1), (v, 2)].map(|(value, channel)| usize::from(value >> SHIFTS[channel]));
    (y << (16 - SHIFTS[1] - SHIFTS[2])) | (u << (8 - SHIFTS[2])) | v
}
