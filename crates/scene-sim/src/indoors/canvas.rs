use super::color::Rgb8;
use super::texture::{TEXEL_M, Texture};

/// An upright surface that is being painted; lengths in metres from its lower left corner.
pub(super) struct Canvas {
    width: usize,
    texels: Vec<Rgb8>,
}

impl Canvas {
    /// All of one colour.
    pub(super) fn new(length_m: f64, height_m: f64, color: Rgb8) -> Self {
        let [width, height] = [length_m, height_m].map(|size| ((size / TEXEL_M).round() as usize).max(1));
        Self { width, texels: vec![color; width * height] }
    }

    /// Paints the part of a rectangle, from its lower left to its upper right corner, that lies on the surface.
    pub(super) fn rectangle(&mut self, from: (f64, f64), to: (f64, f64), color: Rgb8) {
        self.paint(from, to, |_, _| color);
    }

    /// The same with a colour for every texel, by its column and row from the corner of the surface.
    pub(super) fn paint(
        &mut self,
        from: (f64, f64),
        to: (f64, f64),
        mut color: impl FnMut(usize, usize) -> Rgb8,
    ) {
        let texel = |at: f64, most: usize| ((at / TEXEL_M).round().max(0.0) as usize).min(most);
        let (width, height) = (self.width, self.texels.len() / self.width);
        for row in texel(from.1, height)..texel(to.1, height) {
            for column in texel(from.0, width)..texel(to.0, width) {
                self.texels[row * width + column] = color(column, row);
            }
        }
    }

    pub(super) fn finish(self) -> Texture {
        Texture::new(self.width, self.texels)
    }
}
