use nalgebra::{Matrix2, Matrix6, Vector2, Vector6};

use super::{AffineMap, EdgeSearch, SnakeFit, SnakeParams};

/// Weak prior on the start position, only for points without edges: a snake must be free to move.
const PLACE_STIFFNESS: f64 = 2e-4;

/// Factor by which a step shrinks the radius of the edges, and its final share.
const SHRINK: f64 = 0.6;
const LAST_REACH: f64 = 0.25;

/// While edges count from far away the shape is all but kept: an edge that is not the target's must not bend it.
const STIFF: f64 = 10.0;

/// A step of less than this many pixels is the last.
const STILL: f64 = 0.02;

/// Minimum area of a snake in square pixels.
pub(super) const LEAST_AREA: f64 = 4.0;

pub(super) fn fit(
    shape: &[Vector2<f64>],
    start: &AffineMap,
    edges: &impl EdgeSearch,
    params: &SnakeParams,
) -> SnakeFit {
    let mut map = *start;
    let mut reach = (params.search_distance * start.linear.determinant().abs().sqrt()).clamp(3.0, 1e3);
    let last_reach = (LAST_REACH * reach).max(params.tolerance);
    for _ in 0..params.max_iterations {
        let stiffness = if reach > last_reach { STIFF } else { params.stiffness };
        let Some(next) = step(shape, &map, start, edges, reach, [stiffness, PLACE_STIFFNESS]) else { break };
        if !is_sound(&next, start) {
            break;
        }
        let change = (next.linear - map.linear).norm() + (next.translation - map.translation).norm();
        map = next;
        if change < STILL && reach <= last_reach {
            break;
        }
        reach = (SHRINK * reach).max(last_reach);
    }
    let (support, visible) = support(shape, &map, edges, params.tolerance);
    SnakeFit { map, support, visible }
}

/// One weighted least-squares step in the six numbers $`(M_{11}, M_{12}, M_{21}, M_{22}, t_1, t_2)`$.
fn step(
    shape: &[Vector2<f64>],
    map: &AffineMap,
    start: &AffineMap,
    edges: &impl EdgeSearch,
    reach: f64,
    [shape_stiffness, place_stiffness]: [f64; 2],
) -> Option<AffineMap> {
    let mut information = Matrix6::zeros();
    let mut pull = Vector6::zeros();
    for (q, point, normal) in along(shape, map) {
        if !edges.covers(point) {
            continue;
        }
        let Some(distance) = edges.find(point, normal, reach) else { continue };
        let weight = (1.0 - (distance / (reach + 1.0)).powi(2)).powi(2);
        let [nu, nv] = normal;
        let row = Vector6::new(nu * q.x, nu * q.y, nv * q.x, nv * q.y, nu, nv);
        information += row * row.transpose() * weight;
        pull += row * (weight * distance);
    }
    let behind = numbers(start) - numbers(map);
    for i in 0..6 {
        let stiffness = shape.len() as f64 * if i < 4 { shape_stiffness } else { place_stiffness };
        information[(i, i)] += stiffness;
        pull[i] += stiffness * behind[i];
    }
    let change = information.cholesky()?.solve(&pull);
    let x = numbers(map) + change;
    Some(AffineMap { linear: Matrix2::new(x[0], x[1], x[2], x[3]), translation: Vector2::new(x[4], x[5]) })
}

fn numbers(map: &AffineMap) -> Vector6<f64> {
    let (m, t) = (&map.linear, &map.translation);
    Vector6::new(m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)], t.x, t.y)
}

/// Whether a map satisfies the bounds of [`AffineSnake::fit`](super::AffineSnake::fit).
fn is_sound(map: &AffineMap, start: &AffineMap) -> bool {
    let growth = map.linear.determinant() / start.linear.determinant();
    let area = std::f64::consts::PI * map.linear.determinant();
    if !map.is_finite() || !(0.5..=2.0).contains(&growth) || area < LEAST_AREA {
        return false;
    }
    let gram = map.linear.transpose() * map.linear;
    // Ratio of the singular values through trace and determinant: (s1² + s2²) / (s1 s2) = r + 1/r.
    gram.trace() <= (6.0 + 1.0 / 6.0) * map.linear.determinant().abs()
}

fn support(shape: &[Vector2<f64>], map: &AffineMap, edges: &impl EdgeSearch, tolerance: f64) -> (f64, f64) {
    let (mut n_seen, mut n_supported) = (0, 0);
    for (_, point, normal) in along(shape, map) {
        if edges.covers(point) {
            n_seen += 1;
            n_supported +=
                usize::from(edges.find(point, normal, tolerance).is_some_and(|d| d.abs() <= tolerance));
        }
    }
    let share = |n: usize, of: usize| if of == 0 { 0.0 } else { n as f64 / of as f64 };
    (share(n_supported, n_seen), share(n_seen, shape.len()))
}

/// Every point of the shape, with its position and the unit outward normal.
fn along<'a>(
    shape: &'a [Vector2<f64>],
    map: &'a AffineMap,
) -> impl Iterator<Item = (&'a Vector2<f64>, [f64; 2], [f64; 2])> + 'a {
    let n = shape.len();
    shape.iter().enumerate().map(move |(i, q)| {
        let along = map.linear * (shape[(i + 1) % n] - shape[(i + n - 1) % n]);
        let length = along.norm();
        let normal = if length > 0.0 { [along.y / length, -along.x / length] } else { [0.0; 2] };
        (q, map.apply((*q).into()), normal)
    })
}

#[cfg(test)]
mod tests {
    use crate::{AffineSnake, BoundingBox, MaskEdgeSearch, Outline, PixelMask, SnakeParams};
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    fn ellipse(u: f64, v: f64, a: f64, b: f64) -> impl Fn(usize, usize) -> bool {
        move |x, y| ((x as f64 + 0.5 - u) / a).powi(2) + ((y as f64 + 0.5 - v) / b).powi(2) < 1.0
    }

    fn snake() -> AffineSnake {
        let circle =
            Outline::ellipse(&BoundingBox::from_center([60.0, 60.0], 50.0, 50.0).unwrap(), 100).unwrap();
        AffineSnake::new(&circle, &SnakeParams::default()).unwrap()
    }

    #[test]
    fn a_third_of_the_contour_may_be_hidden() {
        let target = ellipse(64.0, 62.0, 25.0, 25.0);
        // Everything left of column 50 is covered.
        let mask = PixelMask::from_fn(120, 120, |u, v| target(u, v) && u >= 50).unwrap();
        let snake = snake();
        let fit = snake.fit(snake.map(), &MaskEdgeSearch::new(&mask, (0, 0)), &SnakeParams::default());
        let outline = snake.outline_at(&fit.map).unwrap();
        assert!(abs_diff_eq!(outline.centroid()[0], 64.0, epsilon = 1.5), "{:?}", outline.centroid());
        assert!(abs_diff_eq!(outline.centroid()[1], 62.0, epsilon = 1.0), "{:?}", outline.centroid());
        assert!(fit.support > 0.5 && fit.support < 0.9, "{}", fit.support);
    }

    #[test]
    fn a_neck_stays_outside() {
        let target = ellipse(62.0, 60.0, 25.0, 25.0);
        let mask =
            PixelMask::from_fn(120, 120, |u, v| target(u, v) || (u >= 62 && (52..68).contains(&v))).unwrap();
        let snake = snake();
        let fit = snake.fit(snake.map(), &MaskEdgeSearch::new(&mask, (0, 0)), &SnakeParams::default());
        let outline = snake.outline_at(&fit.map).unwrap();
        // The neck extends from 87 to 120; the snake moves by less than its tolerance.
        let right = outline.points().iter().map(|point| point[0]).fold(0.0, f64::max);
        assert!(right < 87.0 + 2.0, "{right}");
    }

    #[test]
    fn nothing_in_sight_moves_nothing() {
        let snake = snake();
        for mask in [PixelMask::empty(120, 120).unwrap(), PixelMask::full(120, 120).unwrap()] {
            let fit = snake.fit(snake.map(), &MaskEdgeSearch::new(&mask, (0, 0)), &SnakeParams::default());
            assert_eq!((fit.support, fit.visible), (0.0, 1.0));
            assert_abs_diff_eq!(fit.map.translation, snake.map().translation, epsilon = 1e-9);
        }
        let elsewhere = PixelMask::full(10, 10).unwrap();
        let fit =
            snake.fit(snake.map(), &MaskEdgeSearch::new(&elsewhere, (500, 500)), &SnakeParams::default());
        assert_eq!((fit.support, fit.visible), (0.0, 0.0));
    }
}
