use super::Facet;
use crate::map::Plane;

/// All pieces of a map, sorted for any view.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) root: usize,
}

#[derive(Clone, Debug)]
pub(crate) enum Node {
    /// Facets on a plane, the topmost decal first, and the subtrees on its two sides.
    Split { plane: Plane, facets: Vec<Facet>, front: usize, back: usize },
    /// The content of a subtree without planes.
    Leaf { solids: Vec<Solid> },
}

/// A band of a post, or a part of it after cuts.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    /// Its place in the map's prisms.
    pub(crate) prism: usize,
    /// Its faces, if it was cut; none if it is whole.
    pub(crate) faces: Option<Vec<Face>>,
}

/// A part of a prism's surface, seen from the front of its plane only.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(crate) plane: Plane,
    pub(crate) facet: Facet,
}
