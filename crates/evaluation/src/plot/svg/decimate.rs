//! Thinning of series to the resolution of a picture. All points are in pixels.

/// A point in pixels.
pub(in crate::plot) type Pixel = (f64, f64);

/// Keeps the lowest and the highest point of every pixel column, in the original order, and both ends.
///
/// A line through them covers the same pixels as before, so no peak is lost.
pub(in crate::plot) fn column_extremes(points: &[Pixel], column_width: f64) -> Vec<Pixel> {
    let mut kept = Vec::new();
    kept.extend(points.first());
    for column in points.chunk_by(|a, b| (a.0 / column_width).floor() == (b.0 / column_width).floor()) {
        let extreme = |keep: fn(f64, f64) -> bool| {
            (1..column.len()).fold(0, |best, k| if keep(column[k].1, column[best].1) { k } else { best })
        };
        let (lowest, highest) = (extreme(|y, best| y < best), extreme(|y, best| y > best));
        kept.push(column[lowest.min(highest)]);
        if lowest != highest {
            kept.push(column[lowest.max(highest)]);
        }
    }
    kept.extend(points.last());
    kept.dedup();
    kept
}

/// Drops points within `tolerance` pixels of the line through their kept neighbours [Douglas & Peucker 1973], with a larger tolerance if
/// more than `budget` points remain.
pub(in crate::plot) fn simplify_path(points: &[Pixel], tolerance: f64, budget: usize) -> Vec<Pixel> {
    let mut tolerance = tolerance;
    let mut path = douglas_peucker(points, tolerance);
    while path.len() > budget.max(2) {
        tolerance *= 1.5;
        path = douglas_peucker(&path, tolerance);
    }
    path
}

fn douglas_peucker(points: &[Pixel], tolerance: f64) -> Vec<Pixel> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[last] = true;
    // An explicit stack: recursion over a long path could overflow.
    let mut spans = vec![(0, last)];
    while let Some((start, end)) = spans.pop() {
        let farthest = (start + 1..end)
            .map(|k| (k, distance_to_segment(points[k], points[start], points[end])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = farthest.filter(|(_, distance)| *distance > tolerance) {
            keep[k] = true;
            spans.extend([(start, k), (k, end)]);
        }
    }
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

fn distance_to_segment(point: Pixel, start: Pixel, end: Pixel) -> f64 {
    let (dx, dy) = (end.0 - start.0, end.1 - start.1);
    let length_squared = dx * dx + dy * dy;
    let along = ((point.0 - start.0) * dx + (point.1 - start.1) * dy) / length_squared;
    let along = if length_squared > 0.0 { along.clamp(0.0, 1.0) } else { 0.0 };
    (point.0 - start.0 - along * dx).hypot(point.1 - start.1 - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_keep_the_extremes_and_the_ends() {
        // 100 000 points on 500 columns, with one spike of a single sample up and one down.
        let mut points: Vec<Pixel> =
            (0..100_000).map(|k| (f64::from(k) * 0.005, (f64::from(k) * 0.01).sin())).collect();
        points[31_416].1 = 40.0;
        points[77_777].1 = -40.0;
        let kept = column_extremes(&points, 1.0);
        assert!(kept.len() <= 2 * 500 + 2, "{} points", kept.len());
        assert!(kept.contains(&points[31_416]) && kept.contains(&points[77_777]));
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[99_999]));
        assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0), "order is kept");
        assert!(column_extremes(&[], 1.0).is_empty());
    }

    #[test]
    fn a_simplified_path_stays_within_its_tolerance() {
        let spiral: Vec<Pixel> = (0..5000)
            .map(|k| f64::from(k) * 0.01)
            .map(|angle| (angle * 4.0 * angle.cos(), angle * 4.0 * angle.sin()))
            .collect();
        let path = simplify_path(&spiral, 0.3, 2000);
        assert!(path.len() < 1000, "{} points", path.len());
        for point in &spiral {
            let nearest = path
                .windows(2)
                .map(|pair| distance_to_segment(*point, pair[0], pair[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest <= 0.3, "{point:?} is {nearest} px off");
        }
        assert!(simplify_path(&spiral, 0.3, 100).len() <= 100);
        assert!(simplify_path(&[], 0.3, 100).is_empty());
    }
}
