use nalgebra::{Matrix3, SymmetricEigen, Vector2, Vector3, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, Pose2};

use crate::{ScanMatchParams, ScanPointCloud};

/// The misfit of a cloud to another one at a pose, with its first and second derivatives by the pose.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Misfit {
    /// Nats.
    pub(crate) cost: f64,
    /// By the correction of the guess.
    pub(crate) gradient: Vector3<f64>,
    /// $`\sum w J^T J`$: information of the points about the correction.
    pub(crate) information: Matrix3<f64>,
    /// Number of points that lie on a surface.
    pub(crate) n_inliers: usize,
}

impl Misfit {
    /// The misfit of `cloud` at `guess` ⊞ `correction`, with the Geman-McClure kernel $`ρ(e) = \frac{k^2}{2 σ^2} \frac{e^2}{e^2 + k^2}`$ of distances
    /// along the normals. A point without a surface near it has the maximum cost.
    ///
    /// Gradient and information exclude the spurious information of noisy normals: see [`without_noise_of_normals`](Self::without_noise_of_normals).
    pub(crate) fn of(
        reference: &ScanPointCloud,
        cloud: &ScanPointCloud,
        guess: &Pose2<f64>,
        correction: &Vector3<f64>,
        kernel: f64,
        params: &ScanMatchParams,
    ) -> Self {
        let pose = guess.retract(correction);
        let by_guess = guess.rotation_matrix();
        let share = (cloud.spacing / params.point_error_correlation_angle_rad).min(1.0)
            / params.point_sigma_m.powi(2);
        let mut misfit = Self::default();
        let mut noise_of_normals = Matrix3::zeros();
        for point in &cloud.points {
            let seen_at = pose.transform(point);
            let Some(surface) = reference.surfaces.nearest(&seen_at, 3.0 * kernel) else {
                misfit.cost += share * kernel * kernel / 2.0;
                continue;
            };
            let distance = surface.normal.dot(&(seen_at - surface.at));
            let relative = (distance / kernel).powi(2);
            let weight = share / (1.0 + relative).powi(2);
            // The correction moves in the frame of the guess, and turns about where the robot is then.
            let arm = seen_at - pose.translation;
            let motion_along = |direction: &Vector2<f64>| {
                let in_guess = by_guess.tr_mul(direction);
                Vector3::new(in_guess.x, in_guess.y, direction.y * arm.x - direction.x * arm.y)
            };
            let jacobian = motion_along(&surface.normal);
            let by_normal = motion_along(&Vector2::new(-surface.normal.y, surface.normal.x));
            misfit.cost += share * kernel * kernel / 2.0 * relative / (1.0 + relative);
            misfit.gradient += jacobian * (weight * distance);
            misfit.information += jacobian * jacobian.transpose() * weight;
            noise_of_normals += by_normal * by_normal.transpose() * (weight * surface.normal_variance);
            misfit.n_inliers += usize::from(distance.abs() < params.robust_kernel_width_m);
        }
        misfit.without_noise_of_normals(&noise_of_normals)
    }

    /// Removes the spurious information $`N`$: normals with errors $`ε`$ add $`ε^2`$ times the motion along the surface to $`\sum w J^T J`$, so a
    /// corridor seems to determine the position along it and a round room the heading. With $`Λ = L L^T`$ the rest is $`L K L^T`$,
    /// $`K = (1 - L^{-1} N L^{-T})_+`$, and the gradient is $`L K L^{-1} g`$. [Fuller 1987, Eq. 1.2.3: errors in the regressors]
    fn without_noise_of_normals(self, noise: &Matrix3<f64>) -> Self {
        let Some(factor) = Cholesky::new(self.information).map(|factor| factor.l()) else { return self };
        let Some(inverse) = factor.try_inverse() else { return self };
        let mut kept = SymmetricEigen::new(Matrix3::identity() - inverse * noise * inverse.transpose());
        kept.eigenvalues.apply(|share| *share = share.max(0.0));
        let left = factor * kept.recompose();
        Self { gradient: left * inverse * self.gradient, information: left * factor.transpose(), ..self }
    }
}
