use rand::{Rng, RngExt};

use super::LightingPriorError;

/// Points split into groups around centres.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_color_model::k_means;
/// let points = [0.0, 2.0, 10.0].map(|x| vec![Some(x)]);
/// let split = k_means(&points, 2, 10, &mut ChaCha8Rng::seed_from_u64(1))?;
/// assert_eq!(split.centers[split.assignment[1]], [1.0]); // the mean of 0 and 2
/// assert_eq!(split.distortion, 2.0); // 1² + 1² + 0²
/// # Ok::<(), wayfix_color_model::LightingPriorError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct KMeans {
    /// The mean of each group; coordinates without a value in the group keep the start value.
    pub centers: Vec<Vec<f64>>,
    /// The group of each point; none is empty.
    pub assignment: Vec<usize>,
    /// The sum over points of the squared distance to their centre, which the split tries to make small.
    pub distortion: f64,
}

/// A point, `None` where a coordinate is unknown.
type Point = Vec<Option<f64>>;

/// Splits points into `k` groups: Lloyd's iteration from k-means++ starts [Arthur & Vassilvitskii 2007], the best of `restarts`.
///
/// If coordinates are missing, the distance over the known ones is scaled up accordingly [Dixon 1979].
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_color_model::k_means;
/// let points = [vec![Some(1.0), Some(0.0)], vec![Some(2.0), None], vec![Some(9.0), Some(0.0)]];
/// let split = k_means(&points, 2, 10, &mut ChaCha8Rng::seed_from_u64(1))?;
/// assert!(split.assignment[0] == split.assignment[1] && split.assignment[0] != split.assignment[2]);
/// // The second point counts twice: centre 5/3, distortion (2/3)² + 2 (1/3)².
/// assert!((split.distortion - 2.0 / 3.0).abs() < 1e-15);
/// # Ok::<(), wayfix_color_model::LightingPriorError>(())
/// ```
///
/// # Errors
/// Returns an error if there are no more than `k - 1` different points, `k` or `restarts` is zero, points differ in length, have no known coordinate or
/// one that is not finite.
pub fn k_means<R: Rng + ?Sized>(
    points: &[Vec<Option<f64>>],
    k: usize,
    restarts: usize,
    rng: &mut R,
) -> Result<KMeans, LightingPriorError> {
    check(points, k)?;
    (0..restarts)
        .filter_map(|_| {
            let centers = start(points, k, rng)?;
            lloyd(points, centers)
        })
        .min_by(|a, b| a.distortion.total_cmp(&b.distortion))
        .ok_or(LightingPriorError::TooFew { what: "points", needed: k, got: k.saturating_sub(1) })
}

fn check(points: &[Point], k: usize) -> Result<(), LightingPriorError> {
    if k == 0 || points.len() < k {
        return Err(LightingPriorError::TooFew { what: "points", needed: k.max(1), got: points.len() });
    }
    for point in points {
        if point.len() != points[0].len() {
            let what = "coordinates of a point";
            return Err(LightingPriorError::Dimension { what, expected: points[0].len(), got: point.len() });
        }
        if let Some(value) = point.iter().flatten().find(|value| !value.is_finite()) {
            return Err(LightingPriorError::OutOfRange { what: "coordinate of a point", value: *value });
        }
        if point.iter().flatten().next().is_none() {
            return Err(LightingPriorError::Dimension {
                what: "known coordinates of a point",
                expected: 1,
                got: 0,
            });
        }
    }
    Ok(())
}

/// k-means++: draws each next centre by the squared distance to the nearest centre so far. `None` if there are too few distinct points.
fn start<R: Rng + ?Sized>(points: &[Point], k: usize, rng: &mut R) -> Option<Vec<Vec<f64>>> {
    let overall = mean(points.iter(), &vec![0.0; points[0].len()]);
    let complete = |point: &Point| point.iter().zip(&overall).map(|(x, mean)| x.unwrap_or(*mean)).collect();
    let mut centers: Vec<Vec<f64>> = vec![complete(&points[rng.random_range(0..points.len())])];
    while centers.len() < k {
        let distances: Vec<f64> = points.iter().map(|point| nearest(point, &centers).1).collect();
        let mut left = rng.random_range(0.0..1.0) * distances.iter().sum::<f64>();
        let chosen = distances.iter().position(|distance| {
            left -= distance;
            left < 0.0 && *distance > 0.0
        });
        // Rounding can leave the last point's share unreached; if all distances are zero there is no further distinct point.
        let chosen = chosen.or_else(|| distances.iter().rposition(|distance| *distance > 0.0))?;
        centers.push(complete(&points[chosen]));
    }
    Some(centers)
}

/// Alternates assignment and averaging until nothing changes; every round lowers the distortion, so it terminates. `None` if a group becomes empty.
fn lloyd(points: &[Point], mut centers: Vec<Vec<f64>>) -> Option<KMeans> {
    let mut assignment = Vec::new();
    loop {
        let nearest: Vec<(usize, f64)> = points.iter().map(|point| nearest(point, &centers)).collect();
        let next: Vec<usize> = nearest.iter().map(|(center, _)| *center).collect();
        let distortion = nearest.iter().map(|(_, distance)| distance).sum();
        if next == assignment {
            return Some(KMeans { centers, assignment, distortion });
        }
        assignment = next;
        for (group, center) in centers.iter_mut().enumerate() {
            let members =
                || points.iter().zip(&assignment).filter(|(_, g)| **g == group).map(|(point, _)| point);
            members().next()?;
            *center = mean(members(), center);
        }
    }
}

fn nearest(point: &Point, centers: &[Vec<f64>]) -> (usize, f64) {
    let distances = centers.iter().map(|center| squared_distance(point, center)).enumerate();
    distances.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
}

fn squared_distance(point: &Point, center: &[f64]) -> f64 {
    let known = point.iter().zip(center).filter_map(|(x, c)| x.map(|x| (x - c).powi(2)));
    weight(point) * known.sum::<f64>()
}

/// Minimizes the sum of these distances: points with gaps weigh more in their known coordinates.
fn mean<'a>(points: impl Iterator<Item = &'a Point>, otherwise: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); otherwise.len()];
    for point in points {
        let weight = weight(point);
        for (sum, x) in sums.iter_mut().zip(point) {
            if let Some(x) = x {
                *sum = (sum.0 + weight * x, sum.1 + weight);
            }
        }
    }
    sums.iter()
        .zip(otherwise)
        .map(|((sum, weights), other)| if *weights > 0.0 { sum / weights } else { *other })
        .collect()
}

fn weight(point: &Point) -> f64 {
    point.len() as f64 / point.iter().flatten().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

    /// All ways to split few points are few.
    fn least_distortion(points: &[Point]) -> f64 {
        (1..(1_u32 << points.len()) - 1)
            .map(|mask| {
                let of = |group: u32| {
                    let members: Vec<&Point> = points
                        .iter()
                        .enumerate()
                        .filter(|(i, _)| (mask >> i) & 1 == group)
                        .map(|(_, p)| p)
                        .collect();
                    let center = mean(members.iter().copied(), &[0.0, 0.0]);
                    members.iter().map(|point| squared_distance(point, &center)).sum::<f64>()
                };
                of(0) + of(1)
            })
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn many_starts_find_the_best_split_of_complete_points() {
        for seed in 0..20 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut coordinate = || Some(rng.random_range(0.0..10.0));
            let points: Vec<Point> = (0..10).map(|_| vec![coordinate(), coordinate()]).collect();
            let split = k_means(&points, 2, 300, &mut rng).unwrap();
            let least = least_distortion(&points);
            // Equal but for the rounding of ten terms.
            assert!(
                split.distortion <= least * (1.0 + 1e-13),
                "seed {seed}: {} above {least}",
                split.distortion
            );
        }
    }

    #[test]
    fn gaps_do_not_tear_groups_apart() {
        for seed in 0..20 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            // Groups 30 apart in each coordinate and 10 wide: whichever coordinates are known, the nearer centre is the right one.
            let points: Vec<Point> = (0..24)
                .map(|i| {
                    let mut coordinate = || Some(f64::from(i % 2) * 30.0 + rng.random_range(0.0..10.0));
                    let mut point = vec![coordinate(), coordinate(), coordinate()];
                    point[i as usize % 3] = None;
                    point
                })
                .collect();
            let split = k_means(&points, 2, 10, &mut rng).unwrap().assignment;
            assert!(
                (0..24).all(|i| split[i] == split[i % 2]) && split[0] != split[1],
                "seed {seed}: {split:?}"
            );
        }
    }

    #[test]
    fn points_that_make_no_groups_are_refused() {
        let rng = &mut ChaCha8Rng::seed_from_u64(0);
        let one = vec![Some(1.0)];
        assert!(matches!(k_means(&vec![one.clone(); 5], 2, 10, rng), Err(LightingPriorError::TooFew { .. })));
        assert!(k_means(std::slice::from_ref(&one), 2, 10, rng).is_err());
        assert!(k_means(&[], 1, 10, rng).is_err());
        assert!(k_means(std::slice::from_ref(&one), 0, 10, rng).is_err());
        assert!(k_means(std::slice::from_ref(&one), 1, 0, rng).is_err());
        assert!(k_means(&[one.clone(), vec![None]], 1, 10, rng).is_err());
        assert!(k_means(&[one.clone(), vec![Some(f64::NAN)]], 1, 10, rng).is_err());
        assert!(k_means(&[one.clone(), vec![]], 1, 10, rng).is_err());
        assert!(k_means(&[one], 1, 10, rng).is_ok());
    }
}
