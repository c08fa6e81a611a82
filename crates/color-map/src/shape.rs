use nalgebra::Vector3;

use crate::ColorId;

/// A coloured thing in a map. Metres, in the world frame.
#[derive(Clone, Debug, PartialEq)]
pub enum ColoredShape {
    /// A flat convex surface, visible from both sides.
    ///
    /// Polygons on one plane are decals: a later one covers an earlier one, seen from either side.
    Polygon {
        /// Its colour.
        color: ColorId,
        /// Corners in order, in either direction; at least three.
        vertices: Vec<Vector3<f64>>,
    },
    /// An upright post, such as a beacon: one closed solid a band, seen from outside.
    ///
    /// It is a regular prism of 16 sides, with a corner towards +x, and the mean width of a cylinder of this radius. Its outline is off the
    /// cylinder's by 0.7 % of the radius outwards to 1.3 % inwards: 0.65 mm at 5 cm.
    Post {
        /// Centre.
        x: f64,
        /// Centre.
        y: f64,
        /// Radius of the cylinder that the prism approximates.
        radius: f64,
        /// Colours from the bottom up; they may leave gaps.
        bands: Vec<PostBand>,
    },
}

/// One colour of a [`ColoredShape::Post`], between two heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PostBand {
    /// Its colour.
    pub color: ColorId,
    /// Lower end, metres above the carpet.
    pub from: f64,
    /// Upper end.
    pub to: f64,
}
