//! The map's surfaces as a binary space partition: it gives the surfaces from front to back for every eye point, without comparisons.
//!
//! [Fuchs, Kedem & Naylor 1980]: a node holds the polygons of one plane and two trees, one for either side. From any eye point, surfaces on its side
//! may hide the plane and the surfaces behind it, but not the reverse. Surfaces that cross the plane are cut in two. Leaves hold only posts. Of two
//! upright prisms with disjoint circumscribed circles, the one with the smaller power of the eye's foot with respect to its circle cannot be hidden
//! by the other: a ray that meets it second would cross their radical axis twice.

mod build;
mod facet;
mod partition;

pub(crate) use facet::Facet;
pub(crate) use partition::{Face, Node, Solid, Tree};
