use nalgebra::Vector2;
use wayfix_estimation_traits::{Angle, Pose2};

use crate::plot::statistics::median;

/// The rigid motion that brings `estimated` points closest to their `true` partners in the least-squares sense.
///
/// $`\min_{R,t} \sum_i ‖R e_i + t - p_i‖^2`$ in closed form: the rotation is the direction of the sum of dot and cross products about
/// the centroids. [Umeyama 1991, without scale]. The identity when there are no pairs.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_evaluation::errors::align;
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

/// RMS distance of the pairs after moving the first of each by `motion`; `None` without pairs.
pub fn rms_distance(
    pairs: impl Iterator<Item = (Vector2<f64>, Vector2<f64>)>,
    motion: &Pose2<f64>,
) -> Option<f64> {
    let (sum, n) = pairs.fold((0.0, 0usize), |(sum, n), (estimated, truth)| {
        (sum + (motion.transform(&estimated) - truth).norm_squared(), n + 1)
    });
    (n > 0).then(|| (sum / n as f64).sqrt())
}

/// Median distance of the pairs after moving the first of each by `motion`; `None` without pairs.
pub fn median_distance(
    pairs: impl Iterator<Item = (Vector2<f64>, Vector2<f64>)>,
    motion: &Pose2<f64>,
) -> Option<f64> {
    median(pairs.map(|(estimated, truth)| (motion.transform(&estimated) - truth).norm()))
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

    use super::*;

    const SEED: u64 = 11;

    fn cloud(n: usize) -> Vec<Vector2<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        (0..n).map(|_| Vector2::new(rng.random_range(-9.0..9.0), rng.random_range(-9.0..9.0))).collect()
    }

    fn residual(estimated: &[Vector2<f64>], truth: &[Vector2<f64>], motion: &Pose2<f64>) -> f64 {
        rms_distance(estimated.iter().copied().zip(truth.iter().copied()), motion).unwrap()
    }

    #[test]
    fn a_rigid_motion_is_found_exactly() {
        let estimated = cloud(20);
        for heading in [0.0, 1e-9, 0.7, -2.5, 3.1, std::f64::consts::PI] {
            let motion = Pose2::new(3.0, -40.0, heading);
            let truth: Vec<_> = estimated.iter().map(|point| motion.transform(point)).collect();
            let found = align(estimated.iter().copied().zip(truth.iter().copied()));
            assert!(residual(&estimated, &truth, &found) < 1e-12, "heading {heading}");
        }
    }

    #[test]
    fn mirror_image_is_rotated_and_never_reflected() {
        let truth = cloud(20);
        let mirrored: Vec<_> = truth.iter().map(|point| Vector2::new(point.x, -point.y)).collect();
        let found = align(mirrored.iter().copied().zip(truth.iter().copied()));
        let ours = residual(&mirrored, &truth, &found);
        assert!(ours > 1.0, "a reflection would bring it to 0");
        // Every other rotation about the centroids, in steps of a milliradian, is worse.
        let center = |points: &[Vector2<f64>]| points.iter().sum::<Vector2<f64>>() / points.len() as f64;
        for step in 0..6283 {
            let rotation = Pose2::new(0.0, 0.0, 1e-3 * f64::from(step));
            let translation = center(&truth) - rotation.transform(&center(&mirrored));
            let other = Pose2 { translation, ..rotation };
            assert!(residual(&mirrored, &truth, &other) >= ours - 1e-12, "step {step}");
        }
    }

    #[test]
    fn few_points_align_as_far_as_they_tell() {
        assert_eq!(align(std::iter::empty()), Pose2::new(0.0, 0.0, 0.0));
        assert_eq!(rms_distance(std::iter::empty(), &Pose2::new(0.0, 0.0, 0.0)), None);
        let (estimated, truth) = (Vector2::new(1.0, 2.0), Vector2::new(-3.0, 5.0));
        let found = align(std::iter::once((estimated, truth)));
        assert_eq!((found.transform(&estimated), found.heading()), (truth, 0.0));
    }
}
