use nalgebra::Vector2;
use wayfix_estimation_traits::{Angle, Pose2};

/// The rigid motion that brings `estimated` points closest to their `true` partners in the least-squares sense.
///
/// $`\min_{R,t} \sum_i ‖R e_i + t - p_i‖^2`$ in closed form: the rotation is the direction of the sum of dot and cross products about
/// the centroids. [Umeyama 1991, without scale]. The identity when there are no pairs.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix::evaluate::align;
/// let estimated = [Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0)];
/// let truth = [Vector2::new(5.0, 1.0), Vector2::new(5.0, 2.0)];
/// let motion = align(estimated.iter().copied().zip(truth));
/// assert!((motion.transform(&estimated[1]) - truth[1]).norm() < 1e-12);
/// ```
pub fn align(pairs: impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> + Clone) -> Pose2<f64> {
    let n = pairs.clone().count();
    if n == 0 {
        return Pose2::new(0.0, 0.0, 0.0);
    }
    let sums =
        pairs.clone().fold((Vector2::zeros(), Vector2::zeros()), |(e, p), pair| (e + pair.0, p + pair.1));
    let (estimated_center, true_center) = (sums.0 / n as f64, sums.1 / n as f64);
    let (dot, cross) = pairs.fold((0.0, 0.0), |(dot, cross), (estimated, truth)| {
        let (e, p) = (estimated - estimated_center, truth - true_center);
        (dot + e.dot(&p), cross + e.perp(&p))
    });
    let rotation = Pose2 { translation: Vector2::zeros(), rotation: Angle::new(cross.atan2(dot)) };
    Pose2 { translation: true_center - rotation.transform(&estimated_center), ..rotation }
}

/// Root mean square distance of the pairs after moving the first of each by `motion`; `None` when there are none.
pub fn rms_distance(
    pairs: impl Iterator<Item = (Vector2<f64>, Vector2<f64>)>,
    motion: &Pose2<f64>,
) -> Option<f64> {
    let (sum, n) = pairs.fold((0.0, 0usize), |(sum, n), (estimated, truth)| {
        (sum + (motion.transform(&estimated) - truth).norm_squared(), n + 1)
    });
    (n > 0).then(|| (sum / n as f64).sqrt())
}
