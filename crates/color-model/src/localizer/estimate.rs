use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_gaussian_core::Gaussian;

/// Mean and covariance of the dominant cluster of particles.
/// ```
/// use nalgebra::Vector3;
/// use wayfix_color_model::PoseEstimate;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let pose = Gaussian::from_sigmas(Pose2::new(1.0, 0.5, 0.0), &Vector3::new(0.1, 0.3, 0.05))?;
/// let estimate = PoseEstimate { pose, share: 0.97 };
/// assert!((estimate.position_sigma() - 0.3).abs() < 1e-12); // the larger one of 0.1 m along and 0.3 m across
/// assert!((estimate.heading_sigma() - 0.05).abs() < 1e-12);
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PoseEstimate {
    /// The cluster's pose, with its covariance in the body frame of the mean (m, rad). The spread of the particles has a lower bound: their
    /// resolution, the radius of a place over their effective number.
    pub pose: Gaussian<Pose2<f64>>,
    /// The cluster's share of the whole weight, in (0, 1].
    pub share: f64,
}

impl PoseEstimate {
    /// Standard deviation of the position along its worst direction, metres.
    pub fn position_sigma(&self) -> f64 {
        let position = self.pose.covariance().fixed_view::<2, 2>(0, 0).into_owned();
        position.symmetric_eigenvalues().max().max(0.0).sqrt()
    }
    /// Standard deviation of the heading, radians.
    pub fn heading_sigma(&self) -> f64 {
        self.pose.covariance()[(2, 2)].max(0.0).sqrt()
    }
}

/// Radius of a place, in m and in rad: poses within it belong to one hypothesis. The camera of a four-legged robot (50°) shows less than a
/// landmark's width more or less within this distance.
pub(crate) const PLACE_RADIUS: f64 = 0.3;

/// Whether two poses are in one place.
pub(crate) fn is_same_place(a: &Pose2<f64>, b: &Pose2<f64>) -> bool {
    a.local(b).norm() < PLACE_RADIUS
}

/// The dominant cluster of weighted poses: mean shift from the heaviest cell of a grid. [Comaniciu & Meer 2002]
///
/// `None` when there are no poses or no weight.
pub(crate) fn dominant_cluster(particles: &[(Pose2<f64>, f64)]) -> Option<PoseEstimate> {
    let mut cells = BTreeMap::<[i64; 3], (f64, usize)>::new();
    for (at, (pose, weight)) in particles.iter().enumerate() {
        let cell = [pose.x(), pose.y(), pose.heading()].map(|v| (v / PLACE_RADIUS).floor() as i64);
        let (total, heaviest) = cells.entry(cell).or_insert((0.0, at));
        *total += weight;
        if *weight > particles[*heaviest].1 {
            *heaviest = at;
        }
    }
    let (_, (_, start)) = cells.iter().max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    let mut mean = particles[*start].0;
    let mut moments = Moments::about(&mean, particles);
    // Each step gains weight; the set of particles within the radius is finite, so the shift ends.
    loop {
        let shifted = mean.retract(&moments.mean);
        let next = Moments::about(&shifted, particles);
        let is_better = next.weight > moments.weight;
        (mean, moments) = (shifted, next);
        if !is_better {
            break;
        }
    }
    let total: f64 = particles.iter().map(|(_, weight)| weight).sum();
    if moments.weight.is_nan() || moments.weight <= 0.0 {
        return None;
    }
    let n_effective = 1.0 / particles.iter().map(|(_, weight)| (weight / total).powi(2)).sum::<f64>();
    let resolution = (PLACE_RADIUS / n_effective.max(1.0)).powi(2);
    let pose = Gaussian::new(mean, moments.spread + Matrix3::identity() * resolution).ok()?;
    Some(PoseEstimate { pose, share: moments.weight / total })
}

/// Weight, mean and spread of what is within reach of a centre, in its tangent space.
struct Moments {
    weight: f64,
    mean: Vector3<f64>,
    spread: Matrix3<f64>,
}

impl Moments {
    fn about(centre: &Pose2<f64>, particles: &[(Pose2<f64>, f64)]) -> Self {
        let (mut weight, mut sum, mut products) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for (pose, w) in particles {
            let from_centre = centre.local(pose);
            if from_centre.norm() <= PLACE_RADIUS {
                weight += w;
                sum += from_centre * *w;
                products += from_centre * from_centre.transpose() * *w;
            }
        }
        let scale = if weight > 0.0 { 1.0 / weight } else { 0.0 };
        let mean = sum * scale;
        Self { weight, mean, spread: products * scale - mean * mean.transpose() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heavier_of_two_clusters_is_the_estimate() {
        let around = |x: f64, heading: f64, weight: f64| {
            [(-0.05, -0.02), (0.05, 0.02), (0.0, 0.0)]
                .map(|(dx, turn)| (Pose2::new(x + dx, 0.0, heading + turn), weight / 3.0))
        };
        let pi = std::f64::consts::PI;
        let particles = [around(1.0, pi, 0.7), around(-1.0, 0.0, 0.3)].concat();
        let estimate = dominant_cluster(&particles).unwrap();
        assert!((estimate.share - 0.7).abs() < 1e-12);
        // The cluster contains the wrap of the heading.
        let off = Pose2::new(1.0, 0.0, pi).local(estimate.pose.mean());
        assert!(off.norm() < 1e-9, "{off}");
        let along = 2.0 / 3.0 * 0.05_f64.powi(2); // two of three are 5 cm off the mean
        let n_effective = 1.0 / (3.0 * (0.7_f64 / 3.0).powi(2) + 3.0 * 0.1_f64.powi(2));
        let resolution = (PLACE_RADIUS / n_effective).powi(2);
        assert!((estimate.pose.covariance()[(0, 0)] - along - resolution).abs() < 1e-12);
    }

    #[test]
    fn no_weight_is_no_estimate() {
        assert_eq!(dominant_cluster(&[]), None);
        assert_eq!(dominant_cluster(&[(Pose2::new(0.0, 0.0, 0.0), 0.0)]), None);
    }
}
