//! The filter against a textbook one that shares no code with it: errors in world coordinates, dense matrices, the form of Joseph.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its filter has failed")]

use crate::common;

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Pose2, wrap_angle};
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkConfirmationParams, LandmarkId, OdometryMotion, OutlierRule,
    RangeBearingSensor, SlamParams, UpdateOrder,
};

const SEED: u64 = 20_261_121;

/// State `(x, y, θ, m_1x, m_1y, …)`. [Thrun et al. 2005, section 10.2]
struct Textbook {
    x: DVector<f64>,
    p: DMatrix<f64>,
    offsets: std::collections::BTreeMap<u32, usize>,
}

impl Textbook {
    fn predict(&mut self, u: &Pose2<f64>) {
        let n = self.x.len();
        let (sin, cos) = self.x[2].sin_cos();
        let (dx, dy) = (u.x(), u.y());
        let mut f = DMatrix::identity(n, n);
        f[(0, 2)] = -sin * dx - cos * dy;
        f[(1, 2)] = cos * dx - sin * dy;
        let mut g = DMatrix::zeros(n, 3);
        (g[(0, 0)], g[(0, 1)], g[(1, 0)], g[(1, 1)], g[(2, 2)]) = (cos, -sin, sin, cos, 1.0);
        let q = DMatrix::from_diagonal(&DVector::from_iterator(3, common::ODOMETRY.map(|s| s * s)));
        self.x[0] += cos * dx - sin * dy;
        self.x[1] += sin * dx + cos * dy;
        self.x[2] = wrap_angle(self.x[2] + u.heading());
        // The odometry is in the frame before the motion, its error in the frame after it: isotropic, so it is the same.
        self.p = &f * &self.p * f.transpose() + &g * q * g.transpose();
    }

    fn rows(&self, offset: usize, z: (f64, f64)) -> (DMatrix<f64>, DVector<f64>) {
        let (dx, dy) = (self.x[offset] - self.x[0], self.x[offset + 1] - self.x[1]);
        let squared = dx * dx + dy * dy;
        let range = squared.sqrt();
        let mut h = DMatrix::zeros(2, self.x.len());
        for (column, sign) in [(0, -1.0), (offset, 1.0)] {
            h[(0, column)] = sign * dx / range;
            h[(0, column + 1)] = sign * dy / range;
            h[(1, column)] = -sign * dy / squared;
            h[(1, column + 1)] = sign * dx / squared;
        }
        h[(1, 2)] = -1.0;
        let bearing = wrap_angle(z.1 - dy.atan2(dx) + self.x[2]);
        (h, DVector::from_vec(vec![z.0 - range, bearing]))
    }

    fn update(&mut self, seen: &[(u32, f64, f64)]) {
        let noise = common::SIGHTING.map(|s| s * s);
        let known: Vec<_> = seen.iter().filter(|(id, ..)| self.offsets.contains_key(id)).collect();
        if !known.is_empty() {
            let (m, n) = (2 * known.len(), self.x.len());
            let (mut h, mut nu) = (DMatrix::zeros(m, n), DVector::zeros(m));
            for (k, (id, range, bearing)) in known.iter().enumerate() {
                let (rows, residual) = self.rows(self.offsets[id], (*range, *bearing));
                h.rows_mut(2 * k, 2).copy_from(&rows);
                nu.rows_mut(2 * k, 2).copy_from(&residual);
            }
            let r = DMatrix::from_diagonal(&DVector::from_fn(m, |row, _| noise[row % 2]));
            let s = &h * &self.p * h.transpose() + &r;
            let gain = s.cholesky().unwrap().solve(&(&h * &self.p)).transpose();
            self.x += &gain * nu;
            self.x[2] = wrap_angle(self.x[2]);
            let a = DMatrix::identity(n, n) - &gain * &h;
            self.p = &a * &self.p * a.transpose() + &gain * r * gain.transpose();
        }
        for (id, range, bearing) in seen {
            if !self.offsets.contains_key(id) {
                self.augment(*id, *range, *bearing, noise);
            }
        }
    }

    fn augment(&mut self, id: u32, range: f64, bearing: f64, noise: [f64; 2]) {
        let n = self.x.len();
        let (sin, cos) = (self.x[2] + bearing).sin_cos();
        let mut gr = DMatrix::zeros(2, n);
        (gr[(0, 0)], gr[(1, 1)], gr[(0, 2)], gr[(1, 2)]) = (1.0, 1.0, -range * sin, range * cos);
        let gz = DMatrix::from_row_slice(2, 2, &[cos, -range * sin, sin, range * cos]);
        let r = DMatrix::from_diagonal(&DVector::from_iterator(2, noise));
        let cross = &gr * &self.p;
        let own = &cross * gr.transpose() + &gz * r * gz.transpose();
        let mut p = DMatrix::zeros(n + 2, n + 2);
        p.view_mut((0, 0), (n, n)).copy_from(&self.p);
        p.view_mut((n, 0), (2, n)).copy_from(&cross);
        p.view_mut((0, n), (n, 2)).copy_from(&cross.transpose());
        p.view_mut((n, n), (2, 2)).copy_from(&own);
        self.p = p;
        let (x, y) = (self.x[0] + range * cos, self.x[1] + range * sin);
        self.x = self.x.clone().resize_vertically(n + 2, 0.0);
        (self.x[n], self.x[n + 1]) = (x, y);
        self.offsets.insert(id, n);
    }
}

/// Per step as the simulation draws it; no gate, so that both see the same.
fn filter(order: UpdateOrder) -> (EkfSlam<RangeBearingSensor>, OdometryMotion) {
    let [x, _, turn] = common::ODOMETRY;
    let motion = OdometryMotion {
        translation_variance_per_meter: 0.0,
        heading_variance_per_meter: 0.0,
        heading_variance_per_radian: 0.0,
        translation_variance_per_step: x * x,
        heading_variance_per_step: turn * turn,
    };
    let params = SlamParams {
        outlier_rule: OutlierRule::Reject,
        gate_probability: 1.0 - 1e-15,
        update_order: order,
        confirmation: LandmarkConfirmationParams {
            min_detections: 1,
            ..LandmarkConfirmationParams::default()
        },
        ..SlamParams::default()
    };
    (EkfSlam::new(RangeBearingSensor::default(), params, common::start()).unwrap(), motion)
}

fn compare(order: UpdateOrder) {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let landmarks = common::landmarks(20, &mut rng);
    let steps = common::drive(200, &landmarks, &mut rng);
    let (mut slam, motion) = filter(order);
    let start = common::start();
    let mut textbook = Textbook {
        x: DVector::from_vec(vec![start.x(), start.y(), start.heading()]),
        p: DMatrix::zeros(3, 3),
        offsets: Default::default(),
    };
    for step in &steps {
        slam.predict(&motion, &step.increment).unwrap();
        if step.increment.translation.norm() > 0.0 {
            textbook.predict(&step.increment);
        }
        let report = slam.update(&step.observations, &mut KnownIdAssociation).unwrap();
        assert_eq!(report.n_rejected(), 0);
        let seen: Vec<_> = step
            .observations
            .iter()
            .map(|seen| (seen.label.unwrap().0, seen.measurement.range, seen.measurement.bearing.radians()))
            .collect();
        match order {
            UpdateOrder::Joint => textbook.update(&seen),
            UpdateOrder::Sequential => seen.iter().for_each(|one| textbook.update(std::slice::from_ref(one))),
        }
    }
    // 200 steps of some 40 measured numbers, conditions of 1e5 and less: rounding stays well below a nanometre.
    let tolerance = 1e-9;
    let robot = slam.robot();
    assert_abs_diff_eq!(robot.x(), textbook.x[0], epsilon = tolerance);
    assert_abs_diff_eq!(robot.y(), textbook.x[1], epsilon = tolerance);
    assert!(wrap_angle(robot.heading() - textbook.x[2]).abs() < tolerance);
    // The filter keeps the robot's error in the body frame; the landmarks come in the order of their first sightings in both.
    let n = textbook.x.len();
    let mut to_world = DMatrix::identity(n, n);
    to_world.view_mut((0, 0), (2, 2)).copy_from(&robot.rotation_matrix());
    let world = &to_world * slam.covariance() * to_world.transpose();
    assert_abs_diff_eq!(world, &textbook.p, epsilon = tolerance);
    for (id, offset) in &textbook.offsets {
        let landmark = slam.landmark(LandmarkId(*id)).unwrap();
        assert!((landmark.mean - textbook.x.fixed_rows::<2>(*offset)).amax() < tolerance, "landmark {id}");
    }
}

#[test]
fn joint_updates_equal_the_textbook() {
    compare(UpdateOrder::Joint);
}

#[test]
fn sequential_updates_equal_the_textbook() {
    compare(UpdateOrder::Sequential);
}

#[test]
fn joint_update_is_independent_of_observation_order() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED + 1);
    let landmarks = common::landmarks(12, &mut rng);
    let steps = common::drive(20, &landmarks, &mut rng);
    let run = |reversed: bool| {
        let (mut slam, motion) = filter(UpdateOrder::Joint);
        for step in &steps {
            slam.predict(&motion, &step.increment).unwrap();
            let mut observations = step.observations.clone();
            if reversed {
                observations.reverse();
            }
            slam.update(&observations, &mut KnownIdAssociation).unwrap();
        }
        slam
    };
    let (forward, backward) = (run(false), run(true));
    let tolerance = 1e-10; // rounding of another order of sums
    assert!((forward.robot().translation - backward.robot().translation).norm() < tolerance);
    assert_abs_diff_eq!(forward.robot_covariance(), backward.robot_covariance(), epsilon = tolerance);
    assert_eq!(forward.n_landmarks(), backward.n_landmarks());
    for (one, other) in forward.landmarks().zip(backward.landmarks()) {
        assert_eq!(one.id, other.id);
        assert_abs_diff_eq!(one.mean, other.mean, epsilon = tolerance);
        assert_abs_diff_eq!(one.covariance, other.covariance, epsilon = tolerance);
    }
}
