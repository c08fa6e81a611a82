use nalgebra::{DMatrix, DVector, linalg::Cholesky};

use super::{
    JointCovariance, SparseJacobian,
    triangular::{add_to_lower, mirror_lower, solve_right, solve_right_transposed},
};

impl JointCovariance {
    /// Corrects with all rows of `jacobian` at once and returns the step $`K ν`$ of the mean.
    ///
    /// Joseph's form, $`(I-KH) P (I-KH)^T + K R K^T`$, in two passes over the lower triangle that never form `I − KH`:
    ///
    /// 1. $`M = P - W W^T`$ with $`W = P H^T L^{-T}`$ and $`S = L L^T`$, which is $`(I-KH) P`$ and symmetric,
    /// 2. $`P' = M + (K R - M H^T) K^T`$, which damps the rounding errors of the first pass in every observed direction.
    ///
    /// Cost $`n^2 m`$ multiply-adds for `m` rows. `None`, and nothing changed, when $`S`$ is not positive definite or something overflows.
    pub(crate) fn correct(
        &mut self,
        jacobian: &SparseJacobian,
        noise: &DMatrix<f64>,
        residual: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let cross_covariance = jacobian.symmetric_times_transpose(&self.matrix());
        let innovation_covariance = jacobian.times(&cross_covariance) + noise;
        let l = Cholesky::new(innovation_covariance)?.unpack();

        let mut whitened = cross_covariance;
        solve_right_transposed(&mut whitened, &l);
        let mut gain = whitened.clone();
        solve_right(&mut gain, &l);
        let step = &gain * residual;
        if !step.iter().all(|entry| entry.is_finite()) || !whitened.norm_squared().is_finite() {
            return None;
        }

        let mut p = self.matrix_mut();
        add_to_lower(&mut p, -1.0, &whitened, &whitened);
        let remainder = times_block_diagonal(&gain, noise) - jacobian.lower_times_transpose(&p.as_view());
        add_to_lower(&mut p, 1.0, &remainder, &gain);
        mirror_lower(&mut p);
        Some(step)
    }
}

/// $`K R`$ for a noise that is zero almost everywhere.
fn times_block_diagonal(gain: &DMatrix<f64>, noise: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::zeros(gain.nrows(), gain.ncols());
    for (mut column, noise_column) in product.column_iter_mut().zip(noise.column_iter()) {
        for (row, &entry) in noise_column.iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
            column.axpy(entry, &gain.column(row), 1.0);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Matrix2x3, Matrix3};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// The textbook formula with dense products: the oracle of the fast one.
    fn dense_joseph(p: &DMatrix<f64>, h: &DMatrix<f64>, r: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
        let s = h * p * h.transpose() + r;
        let gain = Cholesky::new(s).unwrap().solve(&(h * p)).transpose();
        let a = DMatrix::identity(p.nrows(), p.nrows()) - &gain * h;
        (&a * p * a.transpose() + &gain * r * gain.transpose(), gain)
    }

    /// A map of `n_landmarks` points with a random covariance, and `n_seen` of them observed.
    fn random_problem(
        seed: u64,
        n_landmarks: usize,
        n_seen: usize,
    ) -> (JointCovariance, SparseJacobian, DMatrix<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut uniform = || rng.random::<f64>() * 2.0 - 1.0;
        let mut covariance = JointCovariance::from_robot(&Matrix3::identity());
        for _ in 0..n_landmarks {
            let jacobian = Matrix2x3::from_fn(|_, _| uniform());
            covariance.append(&jacobian, &(Matrix2::identity() * 0.3));
        }
        let mut jacobian = SparseJacobian::default();
        for seen in 0..n_seen {
            let offset = 3 + 2 * (seen * n_landmarks / n_seen);
            for _ in 0..2 {
                let robot = [uniform(), uniform(), uniform()];
                jacobian.push_row(robot, offset, [uniform(), uniform()]);
            }
        }
        (covariance, jacobian, DMatrix::identity(2 * n_seen, 2 * n_seen) * 0.01)
    }

    #[test]
    fn equals_the_dense_formula() {
        for (seed, (n_landmarks, n_seen)) in [(1, 1), (4, 2), (33, 12), (70, 40)].into_iter().enumerate() {
            let (mut covariance, jacobian, noise) = random_problem(seed as u64, n_landmarks, n_seen);
            let p = covariance.matrix().into_owned();
            let h = jacobian.times(&DMatrix::identity(p.nrows(), p.nrows()));
            let residual = DVector::from_fn(noise.nrows(), |row, _| (row as f64).sin());
            let (expected, gain) = dense_joseph(&p, &h, &noise);
            let step = covariance.correct(&jacobian, &noise, &residual).unwrap();
            // Two formulas for one matrix of unit size: rounding grows with n and with the condition of S (about 1e3 here).
            let tolerance = 1e-11;
            assert!(
                (covariance.matrix() - expected).amax() < tolerance,
                "covariance of {n_landmarks}/{n_seen}"
            );
            assert!((step - gain * residual).amax() < tolerance, "step of {n_landmarks}/{n_seen}");
            assert_eq!(covariance.matrix(), covariance.matrix().transpose());
        }
    }

    #[test]
    fn refuses_an_indefinite_noise_and_changes_nothing() {
        let (mut covariance, jacobian, noise) = random_problem(5, 3, 2);
        let before = covariance.matrix().into_owned();
        assert!(covariance.correct(&jacobian, &(noise * -1e6), &DVector::zeros(4)).is_none());
        assert_eq!(covariance.matrix(), before);
    }
}
