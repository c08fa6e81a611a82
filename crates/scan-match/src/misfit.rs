use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{Manifold, Pose2};

use crate::{Cloud, Params};

/// How badly a cloud fits another one at a pose, and how that changes with the pose, to second order.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Misfit {
    /// Nats.
    pub(crate) cost: f64,
    /// By the correction of the guess.
    pub(crate) gradient: Vector3<f64>,
    /// $`\sum w J^T J`$: what the points know of the correction.
    pub(crate) information: Matrix3<f64>,
    /// Points that lie on a surface.
    pub(crate) n_on_surface: usize,
}

impl Misfit {
    /// Of `cloud` seen from `guess` ⊞ `correction`, with the Geman-McClure kernel $`ρ(e) = \frac{k^2}{2 σ^2} \frac{e^2}{e^2 + k^2}`$ of distances
    /// along the normals. A point without a surface near it costs the most that any point can.
    pub(crate) fn of(
        reference: &Cloud,
        cloud: &Cloud,
        guess: &Pose2<f64>,
        correction: &Vector3<f64>,
        kernel: f64,
        params: &Params,
    ) -> Self {
        let pose = guess.retract(correction);
        let by_guess = guess.rotation_matrix();
        let share = (cloud.spacing / params.independent_rad).min(1.0) / params.sigma_m.powi(2);
        let mut misfit = Self::default();
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
            let normal = by_guess.tr_mul(&surface.normal);
            let arm = seen_at - pose.translation;
            let turning = surface.normal.x * -arm.y + surface.normal.y * arm.x;
            let jacobian = Vector3::new(normal.x, normal.y, turning);
            misfit.cost += share * kernel * kernel / 2.0 * relative / (1.0 + relative);
            misfit.gradient += jacobian * (weight * distance);
            misfit.information += jacobian * jacobian.transpose() * weight;
            misfit.n_on_surface += usize::from(distance.abs() < params.kernel_m);
        }
        misfit
    }
}
