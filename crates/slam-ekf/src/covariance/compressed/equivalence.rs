//! The compressed form against the full one: random walks past landmarks, at the level of covariances, where every form of damage shows.

use nalgebra::{DMatrix, DVector, Matrix2, Matrix2x3, Matrix3, Vector2};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::CompressedCovariance;
use crate::covariance::{JointCovariance, SparseJacobian};

/// Both forms with the same operations, each with the means of a filter.
struct FullAndCompressed {
    full: JointCovariance,
    full_mean: DVector<f64>,
    compressed: CompressedCovariance,
    compressed_mean: DVector<f64>,
    rng: ChaCha8Rng,
    n_restarts: usize,
}

impl FullAndCompressed {
    fn new(seed: u64) -> Self {
        let start = Matrix3::identity() * 0.01;
        Self {
            full: JointCovariance::from_robot(&start),
            full_mean: DVector::zeros(3),
            compressed: CompressedCovariance::from_robot(&start),
            compressed_mean: DVector::zeros(3),
            rng: ChaCha8Rng::seed_from_u64(seed),
            n_restarts: 0,
        }
    }

    fn uniform(&mut self) -> f64 {
        self.rng.random_range(-1.0..1.0)
    }

    fn n_landmarks(&self) -> usize {
        (self.full_mean.len() - 3) / 2
    }

    fn drive(&mut self) {
        let jacobian = Matrix3::identity() + Matrix3::from_fn(|_, _| 0.05 * self.uniform());
        let noise = Matrix3::identity() * 1e-4;
        self.full.move_robot(&jacobian, &noise);
        self.compressed.move_robot(&jacobian, &noise);
    }

    fn start_landmark(&mut self) {
        let jacobian = Matrix2x3::from_fn(|_, _| self.uniform());
        let noise = Matrix2::identity() * 1e-3;
        let offset = self.full.append(&jacobian, &noise);
        assert_eq!(self.compressed.append(&jacobian, &noise), offset);
        for mean in [&mut self.full_mean, &mut self.compressed_mean] {
            *mean = mean.clone().resize_vertically(offset + 2, 0.25);
        }
    }

    fn remove_landmark(&mut self, landmark: usize) {
        let block = 3 + 2 * landmark..5 + 2 * landmark;
        self.full.remove(block.clone());
        self.compressed.remove(block.clone());
        for mean in [&mut self.full_mean, &mut self.compressed_mean] {
            *mean = mean.clone().remove_rows(block.start, 2);
        }
    }

    /// Observes up to `n_seen` neighbours, in one correction or sequentially.
    fn look(&mut self, nearest: usize, n_seen: usize, together: bool) {
        let seen: Vec<usize> = (nearest..self.n_landmarks().min(nearest + n_seen)).collect();
        for group in seen.chunks(if together { n_seen } else { 1 }) {
            let mut jacobian = SparseJacobian::default();
            for landmark in group {
                for _ in 0..2 {
                    let robot: [f64; 3] = std::array::from_fn(|_| self.uniform());
                    let own: [f64; 2] = std::array::from_fn(|_| self.uniform());
                    jacobian.push_row(robot, 3 + 2 * landmark, own);
                }
            }
            let m = jacobian.nrows();
            let noise = DMatrix::identity(m, m) * 2.5e-3;
            let residual = DVector::from_fn(m, |_, _| 0.05 * self.uniform());
            self.full_mean += self.full.correct(&jacobian, &noise, &residual).expect("a definite noise");
            self.compressed_mean +=
                self.compressed.correct(&jacobian, &noise, &residual).expect("a definite noise");
        }
        let before = self.compressed.influences.len();
        self.compressed.end_update();
        self.n_restarts += usize::from(self.compressed.influences.len() < before);
    }

    /// Every entry to 1e-9 of the two deviations that it belongs to, every mean to 1e-9 of its deviation; and the same blocks one by one.
    fn compare(&self, when: &str) {
        let (expected, got) = (self.full.matrix(), self.compressed.matrix());
        assert_eq!(got, got.transpose(), "{when}");
        let deviation = |i: usize| expected[(i, i)].sqrt();
        for row in 0..expected.nrows() {
            for column in 0..expected.ncols() {
                let difference = expected[(row, column)] - got[(row, column)];
                let relative = difference.abs() / deviation(row) / deviation(column);
                assert!(relative < 1e-9, "{when}: {relative:e} at {row}, {column}");
            }
        }
        for offset in (3..self.full_mean.len()).step_by(2) {
            let deferred = self.compressed.deferred_step::<nalgebra::U2>(offset);
            let mean = self.compressed_mean.fixed_rows::<2>(offset) + deferred.unwrap_or_else(Vector2::zeros);
            let error = (self.full_mean.fixed_rows::<2>(offset) - mean).amax() / deviation(offset);
            assert!(error < 1e-9, "{when}: mean of {offset} by {error:e}");
            let (cross, own) = self.compressed.landmark_blocks::<nalgebra::U2, nalgebra::U3>(offset);
            assert!((cross - got.fixed_view::<2, 3>(offset, 0)).amax() < 1e-12, "{when}: cross of {offset}");
            assert!(
                (own - got.fixed_view::<2, 2>(offset, offset)).amax() < 1e-12,
                "{when}: block of {offset}"
            );
        }
        assert!((self.full_mean.rows(0, 3) - self.compressed_mean.rows(0, 3)).amax() < 1e-9, "{when}");
    }
}

#[test]
fn both_forms_are_the_same_whatever_happens_to_them() {
    let mut n_restarts = 0;
    for seed in 0..6 {
        let mut twins = FullAndCompressed::new(seed);
        let mut nearest = 0;
        for step in 0..400 {
            twins.drive();
            if twins.n_landmarks() < 40 && step % 3 == 0 {
                twins.start_landmark();
                nearest = twins.n_landmarks().saturating_sub(3);
            } else if step % 4 == 0 {
                nearest = (nearest + 1) % twins.n_landmarks();
            }
            if step % 23 == 22 {
                let any = twins.rng.random_range(0..twins.n_landmarks());
                let near = (nearest + 1).min(twins.n_landmarks() - 1);
                twins.remove_landmark(if step % 2 == 0 { any } else { near });
                nearest = nearest.min(twins.n_landmarks() - 1);
            }
            twins.look(nearest, 4, seed % 2 == 0);
            twins.compare(&format!("seed {seed}, step {step}"));
        }
        n_restarts += twins.n_restarts;
    }
    // The comparison is valid only if the area changes, and it shrinks only when it restarts: five times a run.
    assert!(n_restarts >= 30, "{n_restarts}");
}

#[test]
fn a_refused_correction_changes_no_value() {
    let mut twins = FullAndCompressed::new(6);
    for step in 0..90 {
        twins.drive();
        if step % 3 == 0 {
            twins.start_landmark();
        }
        twins.look(twins.n_landmarks().saturating_sub(3), 3, true);
    }
    let mut jacobian = SparseJacobian::default();
    jacobian.push_row([1.0, 0.0, 0.0], 3, [1.0, 0.0]); // the first landmark, long out of the area
    assert!(twins.compressed.rows[3].is_none());
    let refused = twins.compressed.correct(&jacobian, &DMatrix::from_element(1, 1, -1e6), &DVector::zeros(1));
    assert!(refused.is_none());
    twins.compare("after a refusal");
    twins.look(0, 3, true);
    twins.compare("after the next scan");
}
