/// A colour of a map: its place in [`ColorMap::colors`](crate::ColorMap::colors).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ColorId(pub u8);

impl ColorId {
    /// The place as an index.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}
