use nalgebra::{DMatrix, DVector, linalg::Cholesky};

use super::{
    JointCovariance, ROUNDING, SparseJacobian,
    triangular::{mirror_lower, solve_right_transposed, subtract_square_from_lower},
};

impl JointCovariance {
    /// Corrects with all rows of `jacobian` at once and returns the step $`K ν`$ of the mean. [Andrade-Cetto 2005, Eqs. 6–9]
    ///
    /// $`P' = P - W W^T`$ with $`W = P H^T L^{-T}`$ and $`L L^T = S`$, on the lower triangle: for the optimal gain the same matrix as Joseph's
    /// $`(I-KH) P (I-KH)^T + K R K^T`$. Joseph's form multiplies the rounding errors of `S` by the gain, twice, and where rows of `S` almost
    /// repeat each other that makes variances negative. Here `S` is enlarged by the bound of its own rounding, so that never too much is
    /// subtracted, and the rounding of the subtraction is added to the diagonal.
    ///
    /// Cost $`n^2 m / 2`$ multiply-adds for `m` rows. Returns `None` and changes nothing if $`S`$ is not positive definite or on overflow.
    pub(crate) fn correct(
        &mut self,
        jacobian: &SparseJacobian,
        noise: &DMatrix<f64>,
        residual: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let mut whitened = jacobian.times_transpose(&self.matrix());
        let mut innovation_covariance = jacobian.times(&whitened) + noise;
        for (row, summands) in jacobian.largest_variances(&self.matrix()).iter().enumerate() {
            innovation_covariance[(row, row)] += SMALLEST_SHARE * summands;
        }
        let l = Cholesky::new(innovation_covariance)?.unpack();
        solve_right_transposed(&mut whitened, &l);
        let step = &whitened * l.solve_lower_triangular(residual)?; // K ν = W L⁻¹ ν without ever forming the gain
        if !step.iter().all(|entry| entry.is_finite()) || !whitened.norm_squared().is_finite() {
            return None;
        }

        let given_back = self.matrix().diagonal() * ROUNDING;
        let mut p = self.matrix_mut();
        subtract_square_from_lower(&mut p, &whitened);
        for (i, variance) in given_back.iter().enumerate() {
            p[(i, i)] += variance;
        }
        mirror_lower(&mut p);
        Some(step)
    }
}

/// Relative size below which a predicted variance, a sum and difference of variances, counts as rounding noise.
///
/// Robot and landmark can each be uncertain by kilometres while their relative position is certain to millimetres; the difference in `f64` is
/// then rounding. Thousands of roundings of ε each are far below this share, and every real noise is far above it.
const SMALLEST_SHARE: f64 = 1e-12;

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
            // The noise is larger by 1e-12 of summands of up to 40; the gain, at most 1/σ = 10, enters squared.
            let tolerance = 1e-12 * 40.0 * 100.0;
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
