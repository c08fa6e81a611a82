//! Two programs say where the robot is. What do they say together?
//!
//! `cargo run -p wayfix-gaussian-core --example 01_fuse_two_estimates`

use nalgebra::Vector3;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{ChiSquaredGate, Gaussian, IntersectionCriterion, covariance_intersection};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 1. Each estimate is a pose (m, m, rad) with standard deviations in its own body frame: forward, left, heading.
    let odometry = Gaussian::from_sigmas(Pose2::new(2.0, 1.0, 3.10), &Vector3::new(0.10, 0.30, 0.05))?;
    let scanner = Gaussian::from_sigmas(Pose2::new(2.1, 1.1, -3.12), &Vector3::new(0.20, 0.05, 0.04))?;

    // 2. Do they agree? The difference, seen from one of them, has the sum of both covariances.
    let seen = scanner.in_chart_at(odometry.mean())?;
    let difference = Gaussian::new(Vector3::zeros(), odometry.covariance() + seen.covariance())?;
    let squared_distance = difference.mahalanobis_squared(seen.mean())?;
    let gate = ChiSquaredGate::from_probability(3, 0.99)?;
    println!("squared distance {squared_distance:.2}, gate {:.2}", gate.threshold());
    assert!(gate.accepts(squared_distance));

    // 3. Independent sources: multiply the densities. The headings 3.10 and -3.12 meet across the wrap.
    let product = odometry.product(&scanner)?;
    println!("independent:  {:?}, sigmas {:.3?}", product.mean(), product.sigmas().as_slice());
    assert!(product.sigmas()[2] < 0.04);

    // 4. Sources that may share data: covariance intersection, never overconfident whatever they share.
    let safe = covariance_intersection(&[odometry, scanner], IntersectionCriterion::Determinant)?;
    println!("any relation: {:?}, shares {:.2?}", safe.gaussian.mean(), safe.weights);
    assert!(safe.gaussian.covariance().determinant() > product.covariance().determinant());
    Ok(())
}
