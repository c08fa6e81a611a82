//! Figures of `scipy.optimize.minimize` (L-BFGS-B over the mean and the Cholesky factor; scipy 1.17.1, numpy 2.4.6), made by
//! `oracle/hierarchical.py` beside this file, which writes every group as one joint Gaussian of all its observations.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, DVector};
use wayfix_gaussian_core::{
    HierarchicalGaussianParams, InverseWishart, MeanPrior, PooledGroupEstimate, fit_hierarchical,
};

/// Seven groups of one to three observations of three coordinates, a quarter of them missing: the script's formula.
fn groups() -> Vec<PooledGroupEstimate> {
    (0..7_usize)
        .map(|j| {
            let mut group = PooledGroupEstimate::new(3);
            for i in 0..1 + j % 3 {
                let (t, i_real) = (j as f64, i as f64);
                let s = 0.7 * t + 1.3 * i_real;
                let full = [
                    2.0 * (1.9 * t).sin() + 0.3 * (5.0 * s).cos(),
                    (2.3 * t).cos() + (1.9 * t).sin() + 0.3 * (7.0 * s).sin(),
                    1.0 + 0.8 * (3.1 * t + 0.4).sin() + 0.2 * (11.0 * s).cos(),
                ];
                let seen: Vec<usize> = (0..3).filter(|d| (j + 2 * i + d) % 4 != 0).collect();
                let values: Vec<f64> = seen.iter().map(|&d| full[d]).collect();
                let variances: Vec<f64> =
                    seen.iter().map(|&d| 0.05 + 0.02 * d as f64 + 0.01 * i_real).collect();
                group.observe(&seen, &values, &variances).unwrap();
            }
            group
        })
        .collect()
}

fn inverse_wishart() -> InverseWishart {
    let scale = DMatrix::from_row_slice(3, 3, &[2.0, 0.3, 0.0, 0.3, 1.5, -0.2, 0.0, -0.2, 1.0]);
    InverseWishart::new(scale, 5.0).unwrap()
}

/// Fits until rounding hides all gains. Then both programs are within (gradient left) / (least curvature) of the optimum: the script's
/// gradients and eigenvalues give at most 2.2e-8, and EM stops below a slope of the same size. A hundredfold of that is allowed, far below
/// the differences between the three optima, 1e-3 and more.
const AGREEMENT: f64 = 2e-6;

fn assert_agrees(params: HierarchicalGaussianParams, objective: f64, mean: [f64; 3], covariance: [f64; 9]) {
    let params = HierarchicalGaussianParams { tolerance: 1e-14, max_iterations: 100_000, ..params };
    let fit = fit_hierarchical(&groups(), &params).unwrap();
    let reached = fit.objective[fit.iterations()];
    // The objective is flat at the optimum: second order in the error of the arguments, so only rounding remains.
    assert_abs_diff_eq!(reached, objective, epsilon = 1e-10);
    assert_abs_diff_eq!(
        *fit.gaussian.mean(),
        DVector::from_vec(vec![mean[0], mean[1], mean[2]]),
        epsilon = AGREEMENT
    );
    let difference = fit.gaussian.covariance() - DMatrix::from_row_slice(3, 3, &covariance);
    assert!(difference.amax() < AGREEMENT, "{difference}");
}

#[test]
fn the_maximum_of_the_likelihood_alone() {
    assert_agrees(
        HierarchicalGaussianParams::default(),
        -15.484157363861927,
        [0.4274187141122651, -0.1424347652810935, 0.9420288456479619],
        [
            3.8108818961155784,
            1.0622508933096961,
            0.3501900612603902,
            1.0622508933096961,
            0.3250324239724636,
            0.08856127882445446,
            0.3501900612603902,
            0.08856127882445446,
            0.04649522000473173,
        ],
    );
}

#[test]
fn the_maximum_with_a_hyperprior_of_the_covariance() {
    assert_agrees(
        HierarchicalGaussianParams { covariance_prior: Some(inverse_wishart()), ..Default::default() },
        -14.913597390455095,
        [0.061847484514826495, -0.13087365891966807, 0.990421574128285],
        [
            1.0135446878299526,
            0.2782315201336235,
            0.04552546796023134,
            0.2782315201336235,
            0.2304150696382595,
            0.004617112362144147,
            0.04552546796023134,
            0.004617112362144147,
            0.09900824047807688,
        ],
    );
}

#[test]
fn the_maximum_with_both_hyperpriors() {
    assert_agrees(
        HierarchicalGaussianParams {
            covariance_prior: Some(inverse_wishart()),
            mean_prior: Some(MeanPrior { mean: DVector::from_vec(vec![0.5, -0.5, 1.0]), pseudo_groups: 0.1 }),
            ..Default::default()
        },
        -19.061419593036945,
        [0.06787123608817582, -0.1402399213807958, 0.988840105052708],
        [
            0.9473114810423618,
            0.25965472954306107,
            0.04153137819993235,
            0.25965472954306107,
            0.21528014625741412,
            0.00360464887355377,
            0.04153137819993235,
            0.00360464887355377,
            0.09127252774574633,
        ],
    );
}
