use crate::scenery::canvas::Window;

/// Which pixels of a picture a thing covers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Silhouette {
    width: usize,
    height: usize,
    inside: Vec<bool>,
}

impl Silhouette {
    /// An empty silhouette.
    pub(super) fn empty((width, height): (usize, usize)) -> Self {
        Self { width, height, inside: vec![false; width * height] }
    }

    /// The pixels at whose centre `inside` is positive.
    pub(super) fn of(size: (usize, usize), window: &Window, inside: impl Fn(f64, f64) -> f64) -> Self {
        let mut silhouette = Self::empty(size);
        for row in window.rows.clone() {
            for column in window.columns.clone() {
                silhouette.inside[row * size.0 + column] =
                    inside(column as f64 + 0.5, row as f64 + 0.5) > 0.0;
            }
        }
        silhouette
    }

    /// The silhouette without the pixels of another.
    pub(super) fn without(mut self, other: &Self) -> Self {
        for (mine, theirs) in self.inside.iter_mut().zip(&other.inside) {
            *mine &= !theirs;
        }
        self
    }

    /// Width of the picture in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height of the picture in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Every pixel, row by row from the top left.
    pub fn pixels(&self) -> &[bool] {
        &self.inside
    }

    /// Number of pixels.
    pub fn area(&self) -> usize {
        self.inside.iter().filter(|&&inside| inside).count()
    }

    /// Left and top edge, width and height in pixels, where the pixel in column `u` and row `v` covers $`[u, u+1) × [v, v+1)`$; `None` if empty.
    pub fn bounding_box(&self) -> Option<[f64; 4]> {
        let (mut left, mut right, mut top, mut bottom) = (self.width, 0, self.height, 0);
        for (i, _) in self.inside.iter().enumerate().filter(|(_, inside)| **inside) {
            let (column, row) = (i % self.width, i / self.width);
            (left, right) = (left.min(column), right.max(column + 1));
            (top, bottom) = (top.min(row), bottom.max(row + 1));
        }
        (right > left).then(|| [left as f64, top as f64, (right - left) as f64, (bottom - top) as f64])
    }
}
