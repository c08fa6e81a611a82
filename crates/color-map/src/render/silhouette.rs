//! The outline of a convex solid: the edges between a visible and an invisible face.

use super::{
    outline::Outline,
    view::{ImagePoint, View},
};
use crate::map::{PLANE_TOLERANCE_M, Prism, SIDES};

/// Puts a prism's silhouette on the outline.
pub(super) fn trace(prism: &Prism, view: &View, outline: &mut Outline) {
    let lower: [ImagePoint; SIDES] = std::array::from_fn(|k| view.point(&prism.corner(k, prism.from)));
    let upper: [ImagePoint; SIDES] = std::array::from_fn(|k| view.point(&prism.corner(k, prism.to)));
    let side: [bool; SIDES] = std::array::from_fn(|k| prism.sides[k].distance(&view.eye) > PLANE_TOLERANCE_M);
    let top = prism.top().distance(&view.eye) > PLANE_TOLERANCE_M;
    let bottom = prism.bottom().distance(&view.eye) > PLANE_TOLERANCE_M;

    outline.clear();
    // A visible face goes around its edge a → b counter-clockwise.
    let mut edge = |a: &ImagePoint, b: &ImagePoint| outline.add((a, b), (b, a));
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        match (side[k], side[next]) {
            (true, false) => edge(&lower[next], &upper[next]),
            (false, true) => edge(&upper[next], &lower[next]),
            _ => {}
        }
        match (side[k], bottom) {
            (true, false) => edge(&lower[k], &lower[next]),
            (false, true) => edge(&lower[next], &lower[k]),
            _ => {}
        }
        match (side[k], top) {
            (true, false) => edge(&upper[next], &upper[k]),
            (false, true) => edge(&upper[k], &upper[next]),
            _ => {}
        }
    }
}
