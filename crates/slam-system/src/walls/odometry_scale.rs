use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Pose2;
use wayfix_scan_match::ScanAlignment;
use wayfix_system_core::{EventCounts, ODOMETRY_SCALE_TOLERANCE};

/// Motions by scan matching alone as a linear function of those by odometry, from keyframe to keyframe.
///
/// $`t_s = \begin{pmatrix} p & -q \\ q & p \end{pmatrix} t_o,\; θ_s = b\, θ_o`$; least squares with the information matrix of each match. A match
/// that leaves a direction undetermined, as in a corridor, does not count. For a laser and odometry that agree $`(p, q, b) = (1, 0, 1)`$; a laser that is mounted at
/// an angle turns $`t_s`$, a wrong unit scales it.
///
/// Noise of odometry makes $`p`$ and $`b`$ smaller, by its share of the squared motion [Fuller 1987]: on a straight drive all turns of odometry are noise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct OdometryScale {
    information: Matrix3<f64>,
    vector: Vector3<f64>,
    /// Sum of squares of the right side, for the residuals.
    square: f64,
    n: usize,
    /// Sums of squared translations and turns by odometry, and of their variances.
    squares: [f64; 2],
    variances: [f64; 2],
}

/// Standard errors that a difference has beyond the tolerance before it is said.
const N_SIGMAS: f64 = 3.0;

/// Matches that determine a direction less than this do not count: residuals along it are arbitrary.
const LEAST_CONDITION: f64 = 1e-3;

impl OdometryScale {
    /// Adds the motion between two keyframes by odometry, and by a match whose linearization is about `guess`.
    pub(super) fn add(
        &mut self,
        odometry: &Pose2<f64>,
        noise: &Matrix3<f64>,
        guess: &Pose2<f64>,
        found: &ScanAlignment,
    ) {
        let (to_guess, moved) = (guess.rotation_matrix().transpose(), odometry.translation);
        let mut design = Matrix3::zeros();
        design.fixed_view_mut::<2, 1>(0, 0).copy_from(&(to_guess * moved));
        design
            .fixed_view_mut::<2, 1>(0, 1)
            .copy_from(&(to_guess * nalgebra::Vector2::new(-moved.y, moved.x)));
        design.m33 = odometry.heading();
        let at_guess = (to_guess * guess.translation).push(guess.heading());
        // Every match counts alike: matches that share a wall err together, whatever the number of their points.
        let scale = found.information.trace();
        let (information, vector) = (found.information / scale, found.information_vector / scale);
        let right = vector + information * at_guess;
        let eigenvalues = found.information.symmetric_eigenvalues();
        let inverse = found
            .information
            .try_inverse()
            .filter(|_| eigenvalues.min() > LEAST_CONDITION * eigenvalues.max());
        let Some(motion) = inverse.map(|inverse| at_guess + inverse * found.information_vector) else {
            return;
        };
        self.information += design.transpose() * information * design;
        self.vector += design.transpose() * right;
        self.square += motion.dot(&(information * motion));
        self.n += 1;
        self.squares[0] += moved.norm_squared();
        self.squares[1] += odometry.heading().powi(2);
        self.variances[0] += noise.m11 + noise.m22;
        self.variances[1] += noise.m33;
    }

    /// The smallest scales of translation and turn that noise and calibration explain.
    fn least_scales(&self) -> [f64; 2] {
        [0, 1].map(|at| {
            let noise_share =
                if self.squares[at] > 0.0 { self.variances[at] / self.squares[at] } else { 1.0 };
            (1.0 - ODOMETRY_SCALE_TOLERANCE) * (1.0 - noise_share.min(1.0))
        })
    }

    /// $`(p, q, b)`$ and their standard errors by the residuals; `None` before odometry has moved and turned.
    fn estimate(&self) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let inverse = self.information.try_inverse()?;
        let estimate = inverse * self.vector;
        let residual = (self.square - estimate.dot(&self.vector)).max(0.0);
        let freedom = (3 * self.n).checked_sub(3).filter(|freedom| *freedom > 0)?;
        let variances = inverse.diagonal() * residual / freedom as f64;
        let sigmas = variances.map(f64::sqrt);
        (estimate.iter().chain(&sigmas).all(|value| value.is_finite())).then_some((estimate, sigmas))
    }

    /// Says when scans contradict odometry beyond calibration.
    pub(super) fn warn(&self, events: &mut EventCounts) {
        let Some((estimate, sigmas)) = self.estimate() else { return };
        let [translation, turn] = self.least_scales();
        let tolerance = ODOMETRY_SCALE_TOLERANCE;
        let ranges = [(translation, 1.0 + tolerance), (-tolerance, tolerance), (turn, 1.0 + tolerance)];
        let is_off = |at: usize| {
            let ((low, high), margin) = (ranges[at], N_SIGMAS * sigmas[at]);
            estimate[at] < low - margin || estimate[at] > high + margin
        };
        if (0..3).any(is_off) {
            let [p, q, b] = estimate.into();
            let (scale, angle) = (p.hypot(q), q.atan2(p).to_degrees());
            events.warn(
                "scans_contradict_odometry",
                format!(
                    "between keyframes, scan matching finds {scale:.2} times the distance of odometry, in a direction turned by {angle:.0}°, and {b:.2} times its turn: check units and scale of both, the sign of turns, where the laser is mounted (`laser_pose`), and whether it sees the robot itself"
                ),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wayfix_estimation_traits::{LieGroup, Manifold};

    /// A match that sees a motion, linearized about odometry.
    fn matched(odometry: Pose2<f64>, seen: &Pose2<f64>, information: Matrix3<f64>) -> ScanAlignment {
        let correction = odometry.local(seen);
        let information_vector = information * correction;
        ScanAlignment {
            pose: odometry,
            correction,
            information,
            information_vector,
            guess_scale: 1.0,
            overlap: 1.0,
        }
    }

    /// A log of 40 motions of which scans see `seen(motion)` with ±1 mm, linearized about odometry.
    fn after(seen: impl Fn(&Pose2<f64>) -> Pose2<f64>, information: Matrix3<f64>) -> OdometryScale {
        let mut scale = OdometryScale::default();
        for step in 0..40 {
            let odometry = Pose2::new(0.25, 0.01, 0.1 * f64::from(step).sin());
            let noise = Pose2::new(0.001 * f64::from(step % 2 * 2 - 1), 0.0, 0.0);
            let found = matched(odometry, &seen(&odometry).compose(&noise), information);
            let noise = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 1e-4));
            scale.add(&odometry, &noise, &odometry, &found);
        }
        scale
    }

    fn is_said(scale: &OdometryScale) -> bool {
        let mut events = EventCounts::default();
        scale.warn(&mut events);
        events.get("scans_contradict_odometry") == 1
    }

    #[test]
    fn wrong_units_signs_and_mounts_are_said() {
        let all = Matrix3::from_diagonal_element(1e4);
        let mirrored = |u: &Pose2<f64>| Pose2::new(u.x(), -u.y(), -u.heading());
        let feet = |u: &Pose2<f64>| Pose2::new(0.3048 * u.x(), 0.3048 * u.y(), u.heading());
        let sideways = |u: &Pose2<f64>| Pose2::new(-u.y(), u.x(), u.heading());
        let itself = |_: &Pose2<f64>| Pose2::identity();
        assert!(is_said(&after(mirrored, all)) && is_said(&after(feet, all)));
        assert!(is_said(&after(sideways, all)) && is_said(&after(itself, all)));
    }

    #[test]
    fn calibration_and_corridors_are_not() {
        let all = Matrix3::from_diagonal_element(1e4);
        let calibrated = |u: &Pose2<f64>| Pose2::new(1.1 * u.x(), 1.1 * u.y(), 0.9 * u.heading());
        assert!(!is_said(&after(calibrated, all)));
        let (estimate, _) = after(calibrated, all).estimate().unwrap();
        assert!((estimate - Vector3::new(1.1, 0.0, 0.9)).norm() < 0.02, "{estimate}");
        // A corridor along x: a match claims to stand there, and knows little or nothing of it.
        let stands = |u: &Pose2<f64>| Pose2::new(0.0, u.y(), u.heading());
        assert!(!is_said(&after(stands, Matrix3::from_diagonal(&Vector3::new(1e-3, 1e4, 1e4)))));
    }

    #[test]
    fn turns_of_odometry_that_are_noise_are_not() {
        let mut scale = OdometryScale::default();
        let information = Matrix3::from_diagonal_element(1e4);
        for step in 0..40 {
            // Straight on; odometry turns by ±5 mrad, scans by ±2 mrad at other times.
            let odometry = Pose2::new(0.25, 0.0, 0.005 * f64::from(step % 2 * 2 - 1));
            let seen = Pose2::new(0.25, 0.0, 0.002 * f64::from(step / 2 % 2 * 2 - 1));
            let found = matched(odometry, &seen, information);
            let noise = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 25e-6));
            scale.add(&odometry, &noise, &odometry, &found);
        }
        assert!(scale.estimate().unwrap().0.z.abs() < 0.1 && !is_said(&scale));
    }
}
