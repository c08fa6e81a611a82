//! The map's surfaces as a binary space partition: every eye gets them from front to back, without comparing them.
//!
//! [Fuchs, Kedem & Naylor 1980]: a node holds the polygons of one plane and two trees, one for either side. Seen from anywhere, what is on
//! the eye's own side may hide the plane and what is behind it, never the other way round. What reaches through the plane is cut in two.
//! Leaves hold posts only. Of two upright prisms with disjoint circumscribed circles, the one with the smaller power of the eye's foot with
//! respect to its circle cannot be hidden by the other: a ray that meets it second would cross their radical axis twice.

mod build;
mod facet;
mod partition;

pub(crate) use facet::Facet;
pub(crate) use partition::{Face, Node, Solid, Tree};
