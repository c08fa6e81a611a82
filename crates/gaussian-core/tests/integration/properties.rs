//! What holds for every Gaussian, tried on random ones.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, DVector, Matrix3, SMatrix, Vector3};
use proptest::prelude::*;
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_gaussian_core::{
    Gaussian, GaussianMixture, IntersectionCriterion, UnscentedParams, UnscentedTransform,
    covariance_intersection,
};

/// $`A A^T + I/10`$ with entries of $`A`$ in ±2: condition number at most 10 · (36 + 0.1), so rounding stays below 1e-12.
fn covariance() -> impl Strategy<Value = Matrix3<f64>> {
    proptest::array::uniform9(-2.0..2.0_f64).prop_map(|entries| {
        let a = Matrix3::from_row_slice(&entries);
        a * a.transpose() + Matrix3::identity() * 0.1
    })
}

fn gaussian() -> impl Strategy<Value = Gaussian<Vector3<f64>>> {
    (proptest::array::uniform3(-10.0..10.0_f64), covariance())
        .prop_map(|(mean, covariance)| Gaussian::new(Vector3::from(mean), covariance).unwrap())
}

fn pose_gaussian() -> impl Strategy<Value = Gaussian<Pose2<f64>>> {
    (proptest::array::uniform3(-10.0..10.0_f64), covariance())
        .prop_map(|([x, y, h], covariance)| Gaussian::new(Pose2::new(x, y, h), covariance * 0.02).unwrap())
}

proptest! {
    #[test]
    fn intersection_is_never_overconfident(
        p in gaussian(), q in gaussian(), mix in proptest::array::uniform9(-1.0..1.0_f64), trace in any::<bool>(),
    ) {
        let criterion = if trace { IntersectionCriterion::Trace } else { IntersectionCriterion::Determinant };
        let fused = covariance_intersection(&[p.clone(), q.clone()], criterion).unwrap();
        // Any cross-covariance L_p K L_qᵀ with |K| ≤ 1 is consistent with the two.
        let k = Matrix3::from_row_slice(&mix);
        let k = k / k.singular_values().max().max(1.0);
        let (lp, lq) = (p.covariance().cholesky().unwrap().l(), q.covariance().cholesky().unwrap().l());
        let cross = lp * k * lq.transpose();
        // The true covariance of the fused mean, whose gains are C ω_i P_i⁻¹.
        let c = fused.gaussian.covariance();
        let gp = c * p.covariance().try_inverse().unwrap() * fused.weights[0];
        let gq = c * q.covariance().try_inverse().unwrap() * fused.weights[1];
        let truth = gp * p.covariance() * gp.transpose() + gq * q.covariance() * gq.transpose()
            + gp * cross * gq.transpose() + gq * cross.transpose() * gp.transpose();
        let slack = (c - truth).symmetric_eigenvalues().min();
        prop_assert!(slack >= -1e-10 * c.norm(), "true covariance sticks out by {slack:e}");
    }

    #[test]
    fn runnalls_and_west_keep_the_first_two_moments(
        parts in proptest::collection::vec((0.1..1.0_f64, gaussian()), 3..7), west in any::<bool>(),
    ) {
        let mixture = GaussianMixture::from_weights(parts).unwrap();
        let before = mixture.moments().unwrap();
        let reduced = if west { mixture.reduce_west(2) } else { mixture.reduce_runnalls(2) }.unwrap();
        let after = reduced.moments().unwrap();
        prop_assert_eq!(reduced.len(), 2);
        assert_abs_diff_eq!(after.mean(), before.mean(), epsilon = 1e-11);
        assert_abs_diff_eq!(after.covariance(), before.covariance(), epsilon = 1e-11 * before.covariance().norm());
    }

    #[test]
    fn conditional_times_marginal_is_the_joint(joint in gaussian(), v in -5.0..5.0_f64, w in proptest::array::uniform2(-5.0..5.0_f64)) {
        let joint = joint.to_dynamic();
        let whole = joint.log_density(&DVector::from_vec(vec![w[0], v, w[1]])).unwrap();
        let marginal = joint.marginal(&[1]).unwrap().log_density(&DVector::from_vec(vec![v])).unwrap();
        let conditional = joint.conditional(&[1], &DVector::from_vec(vec![v])).unwrap().log_density(&DVector::from_vec(vec![w[0], w[1]])).unwrap();
        assert_abs_diff_eq!(marginal + conditional, whole, epsilon = 1e-11 * whole.abs().max(1.0));
    }

    #[test]
    fn unscented_transform_of_an_affine_function_is_exact(
        g in gaussian(), entries in proptest::array::uniform6(-2.0..2.0_f64), alpha in 0.3..1.5_f64,
    ) {
        let a = SMatrix::<f64, 2, 3>::from_row_slice(&entries);
        let params = UnscentedParams { alpha, ..UnscentedParams::default() };
        let transformed = UnscentedTransform::new(&g, |x: &Vector3<f64>| a * x, &params).unwrap();
        assert_abs_diff_eq!(*transformed.mean(), a * g.mean(), epsilon = 1e-11);
        assert_abs_diff_eq!(transformed.covariance(), a * g.covariance() * a.transpose(), epsilon = 1e-10);
        assert_abs_diff_eq!(transformed.cross_covariance(), g.covariance() * a.transpose(), epsilon = 1e-10);
    }

    #[test]
    fn fusing_poses_does_not_depend_on_the_order(p in pose_gaussian(), delta in proptest::array::uniform3(-0.3..0.3_f64), c in covariance()) {
        let q = Gaussian::new(p.mean().retract(&Vector3::from(delta)), c * 0.02).unwrap();
        let (pq, qp) = (p.product(&q).unwrap(), q.product(&p).unwrap());
        // Both stop within 1.5e-8 sigma of the same mode.
        prop_assert!(pq.mean().local(qp.mean()).norm() < 1e-6);
        assert_abs_diff_eq!(pq.covariance(), qp.covariance(), epsilon = 1e-6 * pq.covariance().norm());
        prop_assert!(pq.covariance().trace() <= p.covariance().trace() + 1e-9, "news made a pose less certain");
    }

    #[test]
    fn divergences_are_not_negative_and_vanish_for_equals(p in pose_gaussian(), q in pose_gaussian()) {
        prop_assert!(p.kl_divergence(&q).unwrap() > -1e-9);
        prop_assert!(p.kl_divergence(&p).unwrap().abs() < 1e-12);
        prop_assert!(p.bhattacharyya_distance(&p).unwrap().abs() < 1e-12);
        let (there, back) = (p.bhattacharyya_distance(&q).unwrap(), q.bhattacharyya_distance(&p).unwrap());
        prop_assert!(there > -1e-9 && back > -1e-9);
    }

    #[test]
    fn no_matrix_makes_a_gaussian_panic(entries in proptest::collection::vec(any::<f64>(), 9), n in 0_usize..4) {
        let covariance = DMatrix::from_fn(n, n, |i, j| entries[3 * i + j]);
        let symmetric = covariance.symmetric_part();
        for matrix in [covariance, symmetric] {
            if let Ok(gaussian) = Gaussian::new(DVector::zeros(n), matrix) {
                prop_assert!(gaussian.covariance().clone().cholesky().is_some());
            }
        }
    }
}

#[test]
fn dead_mixtures_say_so() {
    let standard = Gaussian::from_sigmas(Vector3::zeros(), &Vector3::new(1.0, 1.0, 1.0)).unwrap();
    let dead = GaussianMixture::from_log_weights(vec![(f64::NEG_INFINITY, standard.clone()); 3]);
    assert_eq!(dead, Err(wayfix_gaussian_core::GaussianError::NoWeight { count: 3 }));
    assert!(GaussianMixture::from_weights(vec![(f64::NAN, standard.clone())]).is_err());
    assert!(GaussianMixture::from_weights(vec![(1.0, standard.clone()), (-0.5, standard)]).is_err());
    assert!(GaussianMixture::<Vector3<f64>>::from_weights(vec![]).is_err());
}

#[test]
fn intersection_of_many_leaves_out_what_adds_nothing() {
    let sigmas = |s: f64| Gaussian::from_sigmas(Vector3::zeros(), &Vector3::new(s, s, s)).unwrap();
    let fused =
        covariance_intersection(&[sigmas(1.0), sigmas(3.0), sigmas(2.0)], IntersectionCriterion::Trace)
            .unwrap();
    assert_abs_diff_eq!(*fused.gaussian.covariance(), Matrix3::identity(), epsilon = 1e-6);
    assert!(fused.weights[0] > 0.999_999);
}
