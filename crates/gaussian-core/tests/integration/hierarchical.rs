//! Laws of learning from groups: the objective never falls, known priors are recovered, closed formulas hold, bad input is refused.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail like tests")]

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_gaussian_core::{
    Gaussian, GaussianError, HierarchicalGaussianParams, InverseWishart, IterationError, MeanPrior,
    PooledGroupEstimate, fit_hierarchical,
};

const D: usize = 6;
/// What the hyperprior of the covariance is worth here.
const PSEUDO_GROUPS: f64 = 15.0;

fn normal(rng: &mut ChaCha8Rng, n: usize) -> DVector<f64> {
    DVector::from_fn(n, |_, _| rng.sample(StandardNormal))
}

/// Two blocks of three coordinates that share a light: strong correlations across the blocks.
fn known_prior(seed: u64) -> Gaussian<DVector<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let shape = DMatrix::from_fn(D, D, |_, _| rng.sample::<f64, _>(StandardNormal));
    let covariance = &shape * shape.transpose() + DMatrix::identity(D, D);
    Gaussian::new(normal(&mut rng, D) * 10.0, covariance).unwrap()
}

/// Groups of one to five observations in which whole blocks are missing; a noise of variance 0.5.
fn draw_groups(prior: &Gaussian<DVector<f64>>, n: usize, rng: &mut ChaCha8Rng) -> Vec<PooledGroupEstimate> {
    let factor = prior.covariance().clone().cholesky().unwrap().unpack();
    (0..n)
        .map(|_| {
            let theta = prior.mean() + &factor * normal(rng, D);
            let mut group = PooledGroupEstimate::new(D);
            for _ in 0..rng.random_range(1..6) {
                let seen: Vec<usize> = match rng.random_range(0..3) {
                    0 => (0..3).collect(),
                    1 => (3..6).collect(),
                    _ => (0..6).collect(),
                };
                let noise = normal(rng, D) * 0.5_f64.sqrt();
                let values: Vec<f64> = seen.iter().map(|&i| theta[i] + noise[i]).collect();
                group.observe(&seen, &values, &vec![0.5; seen.len()]).unwrap();
            }
            group
        })
        .collect()
}

fn hyperprior(variance: f64) -> Option<InverseWishart> {
    Some(InverseWishart::from_mode(&DMatrix::from_diagonal_element(D, D, variance), PSEUDO_GROUPS).unwrap())
}

#[test]
fn the_objective_never_falls() {
    for seed in 0..40 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        // Fewer groups than coordinates as well: there the hyperprior decides.
        let n = [3, 10, 40][seed as usize % 3];
        let groups = draw_groups(&known_prior(seed + 1000), n, &mut rng);
        let mean_prior = (seed % 2 == 0).then(|| MeanPrior { mean: DVector::zeros(D), pseudo_groups: 0.01 });
        let params = HierarchicalGaussianParams {
            covariance_prior: hyperprior(4.0),
            mean_prior,
            ..Default::default()
        };
        let fit = fit_hierarchical(&groups, &params).unwrap();
        assert!(fit.iterations() > 2, "seed {seed} had nothing to climb");
        for pair in fit.objective.windows(2) {
            // The sum of a few hundred terms of about the size of the whole rounds by some hundred units in the last place.
            let rounding = 200.0 * f64::EPSILON * pair[0].abs();
            assert!(pair[1] >= pair[0] - rounding, "seed {seed}: {} to {}", pair[0], pair[1]);
        }
    }
}

/// Twenty data sets of 300 groups. Their average estimate is off by its own sampling error, measured over the sets, and by the bias
/// of the mode: the covariance's, of the order of (its own hyperprior's groups + 1) / 300.
#[test]
fn a_known_prior_is_recovered_within_sampling_error() {
    const SETS: usize = 20;
    const GROUPS: usize = 300;
    let truth = known_prior(7);
    let prior = hyperprior(4.0);
    let fits: Vec<_> = (0..SETS)
        .map(|seed| {
            let groups = draw_groups(&truth, GROUPS, &mut ChaCha8Rng::seed_from_u64(100 + seed as u64));
            let params = HierarchicalGaussianParams { covariance_prior: prior.clone(), ..Default::default() };
            fit_hierarchical(&groups, &params).unwrap().gaussian
        })
        .collect();
    // Of 27 intervals at 4.9 Student standard errors (19 degrees of freedom, 1e-4 two-sided) one in 370 runs has one that fails.
    let within = |estimates: Vec<f64>, truth: f64, bias: f64| {
        let n = estimates.len() as f64;
        let mean = estimates.iter().sum::<f64>() / n;
        let variance = estimates.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let error = (mean - truth).abs();
        assert!(error < bias + 4.9 * (variance / n).sqrt(), "{mean} for {truth}, sigma {}", variance.sqrt());
    };
    for i in 0..D {
        within(fits.iter().map(|fit| fit.mean()[i]).collect(), truth.mean()[i], 0.0);
        for j in 0..=i {
            let scale = (truth.covariance()[(i, i)] * truth.covariance()[(j, j)]).sqrt();
            let bias = scale * (PSEUDO_GROUPS + 1.0) / GROUPS as f64;
            within(
                fits.iter().map(|fit| fit.covariance()[(i, j)]).collect(),
                truth.covariance()[(i, j)],
                bias,
            );
        }
    }
}

#[test]
fn exact_complete_observations_give_the_sample_moments() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let truth = known_prior(3);
    let samples: Vec<DVector<f64>> = (0..20).map(|_| truth.mean() + normal(&mut rng, D)).collect();
    let groups: Vec<_> = samples
        .iter()
        .map(|sample| {
            let mut group = PooledGroupEstimate::new(D);
            group.observe(&[0, 1, 2, 3, 4, 5], sample.as_slice(), &[0.0; D]).unwrap();
            group
        })
        .collect();
    let mean = samples.iter().sum::<DVector<f64>>() / 20.0;
    let scatter = samples.iter().map(|x| (x - &mean) * (x - &mean).transpose()).sum::<DMatrix<f64>>();
    let fit = fit_hierarchical(&groups, &HierarchicalGaussianParams::default()).unwrap();
    // Means of size 10, conditioning below 100: some dozen roundings.
    assert_abs_diff_eq!(fit.gaussian.mean(), &mean, epsilon = 1e-13);
    assert_abs_diff_eq!(*fit.gaussian.covariance(), &scatter / 20.0, epsilon = 1e-12);
    // With a hyperprior: its scale and degrees of freedom join in. [Gelman et al. 2003, section 3.6]
    let prior = hyperprior(2.0).unwrap();
    let params = HierarchicalGaussianParams { covariance_prior: Some(prior.clone()), ..Default::default() };
    let fit = fit_hierarchical(&groups, &params).unwrap();
    let expected = (scatter + prior.scale()) / (20.0 + PSEUDO_GROUPS);
    assert_abs_diff_eq!(*fit.gaussian.covariance(), expected, epsilon = 1e-12);
}

#[test]
fn silent_groups_change_nothing() {
    let mut groups = draw_groups(&known_prior(1), 10, &mut ChaCha8Rng::seed_from_u64(1));
    let params = HierarchicalGaussianParams { covariance_prior: hyperprior(4.0), ..Default::default() };
    let fit = fit_hierarchical(&groups, &params).unwrap();
    groups.push(PooledGroupEstimate::new(D));
    assert_eq!(fit_hierarchical(&groups, &params).unwrap(), fit);
}

#[test]
fn what_determines_no_gaussian_is_refused() {
    let groups = draw_groups(&known_prior(1), D, &mut ChaCha8Rng::seed_from_u64(1));
    let flat = HierarchicalGaussianParams::default();
    let step = |groups: &[PooledGroupEstimate], params: &HierarchicalGaussianParams| match fit_hierarchical(
        groups, params,
    ) {
        Err(IterationError::Step(error)) => error,
        other => panic!("expected a refusal, got {other:?}"),
    };
    assert!(matches!(step(&groups, &flat), GaussianError::TooFew { needed: 7, got: 6, .. }));
    assert!(matches!(step(&[], &flat), GaussianError::Empty { .. }));
    let with_prior = HierarchicalGaussianParams { covariance_prior: hyperprior(1.0), ..flat.clone() };
    assert!(matches!(step(&[PooledGroupEstimate::new(2)], &with_prior), GaussianError::Dimension { .. }));
    assert_eq!(
        step(&[PooledGroupEstimate::new(D)], &with_prior),
        GaussianError::Unobserved { coordinate: 0 }
    );
    // The same exact vector again and again has no covariance.
    let mut group = PooledGroupEstimate::new(1);
    group.observe(&[0], &[2.0], &[0.0]).unwrap();
    assert!(matches!(step(&vec![group; 5], &flat), GaussianError::NotPositiveDefinite { .. }));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let params = HierarchicalGaussianParams { tolerance: bad, ..with_prior.clone() };
        assert!(matches!(step(&groups, &params), GaussianError::Parameter { .. }));
        let mean_prior = Some(MeanPrior { mean: DVector::zeros(D), pseudo_groups: bad });
        let params = HierarchicalGaussianParams { mean_prior, ..with_prior.clone() };
        assert!(matches!(step(&groups, &params), GaussianError::Parameter { .. }));
    }
    let mean_prior = Some(MeanPrior { mean: DVector::from_element(D, f64::NAN), pseudo_groups: 1.0 });
    let params = HierarchicalGaussianParams { mean_prior, ..with_prior };
    assert!(matches!(step(&groups, &params), GaussianError::NotFinite { .. }));
}

#[test]
fn both_hyperpriors_speak_where_no_group_does() {
    let params = HierarchicalGaussianParams {
        covariance_prior: hyperprior(4.0),
        mean_prior: Some(MeanPrior { mean: DVector::from_element(D, 3.0), pseudo_groups: 1.0 }),
        ..Default::default()
    };
    let fit = fit_hierarchical(&[PooledGroupEstimate::new(D)], &params).unwrap();
    assert_eq!(fit.gaussian.mean(), &DVector::from_element(D, 3.0));
    // Ψ / (ν + d + 2): N(m, Σ/κ) adds one |Σ|^(-1/2).
    let (groups, mode) = (PSEUDO_GROUPS, 4.0);
    assert_abs_diff_eq!(fit.gaussian.covariance()[(2, 2)], mode * groups / (groups + 1.0), epsilon = 1e-14);
}

#[test]
fn iteration_limit_error_carries_the_last_estimate() {
    let groups = draw_groups(&known_prior(1), 10, &mut ChaCha8Rng::seed_from_u64(1));
    let params = HierarchicalGaussianParams {
        covariance_prior: hyperprior(4.0),
        max_iterations: 3,
        ..Default::default()
    };
    match fit_hierarchical(&groups, &params) {
        Err(IterationError::NotConverged { last, iterations: 3, .. }) => {
            assert_eq!(last.iterations(), 3);
            assert!(last.objective[3] > last.objective[0]);
        }
        other => panic!("expected no convergence, got {other:?}"),
    }
}
