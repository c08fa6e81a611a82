/// Which pixels are neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PixelConnectivity {
    /// Those that share a side.
    Four,
    /// Those that share a side or a corner.
    #[default]
    Eight,
}

impl PixelConnectivity {
    /// Connectivity of the background for this connectivity of the foreground: a closed curve must separate the plane.
    pub fn dual(self) -> Self {
        match self {
            Self::Four => Self::Eight,
            Self::Eight => Self::Four,
        }
    }
}
