use super::color::Rgb8;

/// Edge of a texel of the finest level, metres.
pub(super) const TEXEL_M: f64 = 0.05;
/// Number of halvings of each axis, besides the finest level.
const HALVINGS: [usize; 2] = [6, 5];

/// The colours of an upright surface, stored for every pair of halvings along its length and height: one look-up for a wide ray.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Texture {
    levels: Vec<Level>,
}

#[derive(Clone, Debug, PartialEq)]
struct Level {
    width: usize,
    height: usize,
    texels: Vec<Rgb8>,
}

impl Texture {
    /// From texels row by row, the lowest row first.
    pub(super) fn new(width: usize, texels: Vec<Rgb8>) -> Self {
        let height = texels.len() / width.max(1);
        let mut levels: Vec<Level> = Vec::with_capacity((HALVINGS[0] + 1) * (HALVINGS[1] + 1));
        for j in 0..=HALVINGS[1] {
            let first = match j {
                0 => Level { width, height, texels: texels.clone() },
                _ => levels[(j - 1) * (HALVINGS[0] + 1)].halved_in_height(),
            };
            levels.push(first);
            for _ in 0..HALVINGS[0] {
                let next = levels[levels.len() - 1].halved_in_length();
                levels.push(next);
            }
        }
        Self { levels }
    }

    /// The mean colour, in [0, 255], of a patch of `size` metres (along, up) about a place in metres from the lower left corner.
    pub(super) fn sample(&self, along: f64, up: f64, size: [f64; 2]) -> [f32; 3] {
        let halvings = [0, 1].map(|axis| halvings(size[axis], HALVINGS[axis]));
        let level = &self.levels[halvings[1] * (HALVINGS[0] + 1) + halvings[0]];
        level.interpolate(along / texels_of(halvings[0]) - 0.5, up / texels_of(halvings[1]) - 0.5)
    }
}

/// Number of halvings at which a texel is about as large as the patch.
fn halvings(size_m: f64, most: usize) -> usize {
    let mut edge = TEXEL_M * std::f64::consts::SQRT_2;
    (0..most)
        .take_while(|_| {
            let larger = size_m > edge;
            edge *= 2.0;
            larger
        })
        .count()
}

/// Edge of a texel after some halvings, metres.
fn texels_of(halvings: usize) -> f64 {
    TEXEL_M * (1u32 << halvings) as f64
}

impl Level {
    fn interpolate(&self, x: f64, y: f64) -> [f32; 3] {
        let (x, y) = (x.clamp(0.0, (self.width - 1) as f64), y.clamp(0.0, (self.height - 1) as f64));
        let (left, below) = (x as usize, y as usize);
        let (right, above) = ((left + 1).min(self.width - 1), (below + 1).min(self.height - 1));
        let (u, v) = ((x - left as f64) as f32, (y - below as f64) as f32);
        let at = |column: usize, row: usize| self.texels[row * self.width + column];
        let (a, b, c, d) = (at(left, below), at(right, below), at(left, above), at(right, above));
        std::array::from_fn(|k| {
            let [a, b, c, d] = [a, b, c, d].map(|texel| f32::from(texel[k]));
            let (lower, upper) = (a + (b - a) * u, c + (d - c) * u);
            lower + (upper - lower) * v
        })
    }

    fn halved_in_length(&self) -> Self {
        let width = self.width.div_ceil(2);
        let pair = |row: usize, column: usize| {
            let left = row * self.width + 2 * column;
            (left, if 2 * column + 1 < self.width { left + 1 } else { left })
        };
        self.paired(width, self.height, pair)
    }

    fn halved_in_height(&self) -> Self {
        let height = self.height.div_ceil(2);
        let pair = |row: usize, column: usize| {
            let below = 2 * row * self.width + column;
            (below, if 2 * row + 1 < self.height { below + self.width } else { below })
        };
        self.paired(self.width, height, pair)
    }

    fn paired(&self, width: usize, height: usize, pair: impl Fn(usize, usize) -> (usize, usize)) -> Self {
        let mean = |i: usize| {
            let (a, b) = pair(i / width, i % width);
            std::array::from_fn(|k| {
                (u16::from(self.texels[a][k]) + u16::from(self.texels[b][k])).div_ceil(2) as u8
            })
        };
        Self { width, height, texels: (0..width * height).map(mean).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stripes of one texel, black and white.
    fn stripes() -> Texture {
        Texture::new(64, (0..64 * 16).map(|i| [if i % 2 == 0 { 0 } else { 254 }; 3]).collect())
    }

    #[test]
    fn a_small_patch_shows_a_stripe_and_a_large_one_their_mean() {
        let texture = stripes();
        assert_eq!(texture.sample(0.5 * TEXEL_M, 0.4, [0.01, 0.01]), [0.0; 3]);
        assert_eq!(texture.sample(1.5 * TEXEL_M, 0.4, [0.01, 0.01]), [254.0; 3]);
        assert_eq!(texture.sample(1.5, 0.4, [1.0, 0.01]), [127.0; 3]);
    }

    #[test]
    fn beyond_the_edge_is_the_edge() {
        let texture = stripes();
        assert_eq!(texture.sample(-3.0, -1.0, [0.01, 0.01]), [0.0; 3]);
        assert_eq!(texture.sample(99.0, 9.0, [0.01, 0.01]), [254.0; 3]);
    }
}
