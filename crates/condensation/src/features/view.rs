use crate::Picture;

/// A rectangle of a picture: what the camera sees in one state.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    picture: &'a Picture,
    corner: (usize, usize),
    size: (usize, usize),
}

impl<'a> View<'a> {
    /// The caller knows that the rectangle lies inside and has pixels.
    pub(crate) fn inside(picture: &'a Picture, corner: (usize, usize), size: (usize, usize)) -> Self {
        Self { picture, corner, size }
    }

    /// Column and row of the top left pixel in the picture.
    pub fn corner(&self) -> (usize, usize) {
        self.corner
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.size.0
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.size.1
    }

    /// How many pixels it has.
    pub fn n_pixels(&self) -> usize {
        self.size.0 * self.size.1
    }

    /// Rows of red, green and blue, from the top.
    pub fn rows(&self) -> impl Iterator<Item = &'a [[u8; 3]]> {
        self.lines(self.picture.pixels())
    }

    /// Rows of grey values, from the top.
    pub fn grey_rows(&self) -> impl Iterator<Item = &'a [u8]> {
        self.lines(self.picture.grey())
    }

    /// The pixels as a picture of their own.
    pub fn to_picture(&self) -> Picture {
        let bytes = self.rows().flatten().flatten().copied().collect();
        Picture::from_rgb(self.size.0, self.size.1, bytes).expect("invariant: a view has pixels")
    }

    fn lines<T>(&self, pixels: &'a [T]) -> impl Iterator<Item = &'a [T]> {
        let ((x, y), (width, height)) = (self.corner, self.size);
        pixels.chunks_exact(self.picture.width()).skip(y).take(height).map(move |row| &row[x..x + width])
    }
}
