//! What the cart drives in: walls and shelves as segments, metres.

use nalgebra::Vector2;

/// A hall of 16 m by 10 m with two shelves and an office in the corner.
pub fn segments() -> Vec<[Vector2<f64>; 2]> {
    let rectangles = [[0.0, 0.0, 16.0, 10.0], [4.0, 3.4, 12.0, 4.2], [4.0, 6.0, 12.0, 6.8], [14.2, 8.4, 16.0, 10.0]];
    rectangles.into_iter().flat_map(sides).collect()
}

/// How far a beam goes from `origin`, `None` when it meets nothing.
pub fn range(origin: &Vector2<f64>, direction: &Vector2<f64>) -> Option<f64> {
    let hit = |[a, b]: [Vector2<f64>; 2]| {
        // origin + r direction = a + s (b - a)
        let (along, to) = (b - a, a - origin);
        let determinant = along.x * direction.y - along.y * direction.x;
        let r = (along.x * to.y - along.y * to.x) / determinant;
        let s = (direction.x * to.y - direction.y * to.x) / determinant;
        (r > 0.0 && (0.0..=1.0).contains(&s)).then_some(r)
    };
    segments().into_iter().filter_map(hit).min_by(f64::total_cmp)
}

fn sides([x0, y0, x1, y1]: [f64; 4]) -> [[Vector2<f64>; 2]; 4] {
    let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| Vector2::new(x, y));
    [0, 1, 2, 3].map(|k| [corners[k], corners[(k + 1) % 4]])
}
