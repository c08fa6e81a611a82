use nalgebra::Vector2;

/// An upright rectangle, seen from one side only.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Panel {
    /// Its foot on the viewer's left, m.
    pub(super) left: Vector2<f64>,
    /// Its foot on the right.
    pub(super) right: Vector2<f64>,
    /// Height of its lower edge, metres.
    pub(super) bottom_m: f64,
    /// Height of its upper edge, metres.
    pub(super) top_m: f64,
    /// Its appearance.
    pub(super) material: Material,
}

/// Appearance of a panel: textures by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Material {
    /// Lit by the lamps.
    Lit(usize),
    /// A window with daylight, partly covered by its curtain.
    Window {
        /// The scene outside; its brightness is that of the day.
        outside: usize,
        /// Its curtain, drawn from the left and lit by the lamps.
        curtain: usize,
        /// Which curtain.
        number: usize,
    },
    /// One colour for legs, body and head of a person.
    Person(usize),
}

impl Panel {
    /// Whether its front faces the point `eye`.
    pub(super) fn faces(&self, eye: &Vector2<f64>) -> bool {
        (self.right - self.left).perp(&(eye - self.left)) < 0.0
    }
}

/// The feet (left, right) of the four sides of an upright block, seen from outside: the lower long side first, then counter-clockwise.
pub(super) fn sides(low: Vector2<f64>, high: Vector2<f64>) -> [(Vector2<f64>, Vector2<f64>); 4] {
    let corners = [low, Vector2::new(high.x, low.y), high, Vector2::new(low.x, high.y)];
    [0, 1, 2, 3].map(|k| (corners[k], corners[(k + 1) % 4]))
}

/// The feet of the four walls of a room, seen from inside, in the same order.
pub(super) fn walls(low: Vector2<f64>, high: Vector2<f64>) -> [(Vector2<f64>, Vector2<f64>); 4] {
    sides(low, high).map(|(left, right)| (right, left))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_seen_from_outside_and_a_room_from_inside() {
        let (low, high) = (Vector2::new(-1.0, -2.0), Vector2::new(1.0, 2.0));
        let panel =
            |(left, right)| Panel { left, right, bottom_m: 0.0, top_m: 1.0, material: Material::Lit(0) };
        let centre = Vector2::zeros();
        for side in sides(low, high) {
            let panel = panel(side);
            assert!(!panel.faces(&centre) && panel.faces(&(panel.left + panel.right)));
        }
        assert!(walls(low, high).into_iter().all(|wall| panel(wall).faces(&centre)));
    }
}
