//! Belief against plain versions: dense sums, logarithms throughout.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use proptest::prelude::*;
use wayfix_condensation::{
    CondensationError, DenseTransition, DiffusionKernel, DiscreteFilter, DiscreteStateSpace, GridMove,
    HeadingGrid, MeasurementOutcome, PositionGrid, SlipProbabilities, SparseTransition, StateLattice,
    TransitionModel,
};
use wayfix_integrity::CusumTest;

use crate::common::place_graph::PlaceGraph;

fn predicted(transition: &dyn TransitionModel, belief: &[f64]) -> Vec<f64> {
    let mut to = vec![f64::NAN; belief.len()];
    transition.predict(belief, &mut to);
    to
}

fn assert_close(got: &[f64], expected: &[f64]) {
    for (state, (a, b)) in got.iter().zip(expected).enumerate() {
        assert!(abs_diff_eq!(a, b, epsilon = 1e-12), "state {state}: {a} and {b}");
    }
}

/// Eq. 5 with every pair of states written out, and each row divided by its sum.
fn plain_diffusion(space: &impl StateLattice, sigmas: &[f64]) -> DenseTransition {
    let coordinates = |state: usize| {
        let mut rest = state;
        let mut places: Vec<usize> =
            space.axes().iter().rev().map(|axis| (rest % axis.len, rest /= axis.len).0).collect();
        places.reverse();
        places
    };
    let weight = |a: usize, b: usize| -> f64 {
        let axes = space.axes().iter().zip(sigmas).zip(coordinates(a).into_iter().zip(coordinates(b)));
        axes.map(|((axis, sigma), (p, q))| {
            let apart = p.abs_diff(q);
            let apart = if axis.is_cyclic { apart.min(axis.len - apart) } else { apart };
            // The kernel is cut at four sigma, and on a ring before its two ends meet.
            let radius = ((4.0 * sigma).ceil() as usize).min(if axis.is_cyclic {
                (axis.len - 1) / 2
            } else {
                axis.len
            });
            if apart > radius {
                0.0
            } else if apart == 0 {
                1.0
            } else {
                (-0.5 * (apart as f64 / sigma).powi(2)).exp()
            }
        })
        .product()
    };
    let row = |from: usize| {
        let weights: Vec<f64> = (0..space.n_states()).map(|to| weight(from, to)).collect();
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|w| w / sum).collect::<Vec<_>>()
    };
    DenseTransition::from_rows(&(0..space.n_states()).map(row).collect::<Vec<_>>())
        .expect("rows that sum to one")
}

fn belief(n: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(0.0..1.0, n)
}

proptest! {
    #[test]
    fn diffusion_is_the_plain_sum(weights in belief(35), x in 0.0..2.5, y in 0.0..2.5) {
        let grid = PositionGrid::new(7, 5).unwrap();
        let kernel = DiffusionKernel::gaussian(&grid, &[y, x]).unwrap();
        assert_close(&predicted(&kernel, &weights), &predicted(&plain_diffusion(&grid, &[y, x]), &weights));
    }

    #[test]
    fn diffusion_wraps_headings(weights in belief(8 * 12), heading in 0.0..2.0, place in 0.0..2.0) {
        let grid = HeadingGrid::new(4, 3).unwrap();
        let sigmas = [heading, place, place];
        let kernel = DiffusionKernel::gaussian(&grid, &sigmas).unwrap();
        assert_close(&predicted(&kernel, &weights), &predicted(&plain_diffusion(&grid, &sigmas), &weights));
    }

    #[test]
    fn sparse_is_dense(weights in belief(12), stay_probability in 0.0..0.5, other_action_probability in 0.0..0.5, action in 0_usize..9) {
        let grid = PositionGrid::new(4, 3).unwrap();
        let slip = SlipProbabilities { stay_probability, other_action_probability };
        let action = GridMove::ALL[action];
        let mut rows = vec![vec![0.0; 12]; 12];
        for (from, row) in rows.iter_mut().enumerate() {
            row[grid.step(from, action)] += 1.0 - stay_probability - other_action_probability;
            row[from] += stay_probability;
            GridMove::ALL.iter().for_each(|&other| row[grid.step(from, other)] += other_action_probability / 9.0);
        }
        let dense = DenseTransition::from_rows(&rows).unwrap();
        assert_close(&predicted(&slip.transition(&grid, action).unwrap(), &weights), &predicted(&dense, &weights));
    }

    /// Likelihoods thousands of nats apart: what is representable is right, what is not is zero, never NaN.
    #[test]
    fn update_is_that_of_logarithms(
        weights in prop::collection::vec(prop_oneof![Just(0.0), 1e-300..1e-290, 0.1..1.0], 6),
        log_likelihoods in prop::collection::vec(prop_oneof![Just(f64::NEG_INFINITY), -3000.0..3000.0], 6),
    ) {
        let Ok(mut filter) = DiscreteFilter::from_prior(weights) else { return Ok(()) };
        let logs: Vec<f64> = filter.belief().iter().zip(&log_likelihoods).map(|(p, l)| p.ln() + l).collect();
        let best = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let before = filter.clone();
        let outcome = filter.update(&log_likelihoods).unwrap();
        if best == f64::NEG_INFINITY {
            prop_assert_eq!(outcome, MeasurementOutcome::Impossible);
            prop_assert_eq!(filter.belief(), before.belief());
        } else {
            let sum: f64 = logs.iter().map(|l| (l - best).exp()).sum();
            let expected: Vec<f64> = logs.iter().map(|l| (l - best).exp() / sum).collect();
            assert_close(filter.belief(), &expected);
            let evidence = outcome.evidence().unwrap().log_predicted;
            assert_abs_diff_eq!(evidence - best, sum.ln(), epsilon = 1e-9 * (1.0 + evidence.abs()));
        }
    }
}

#[test]
fn belief_over_many_chunks_stays_a_distribution() {
    let grid = PositionGrid::new(300, 200).unwrap(); // several chunks, and none that divides a row
    let kernel = DiffusionKernel::gaussian(&grid, &[1.3, 0.8]).unwrap();
    let mut filter = DiscreteFilter::uniform(60_000).unwrap();
    let go = SlipProbabilities { stay_probability: 0.1, other_action_probability: 0.1 }
        .transition(&grid, GridMove { dx: 1, dy: 0 })
        .unwrap();
    let truth = 60_000 - 7;
    for _ in 0..5 {
        filter.predict(&go).unwrap();
        filter.predict(&kernel).unwrap();
        let log_likelihoods: Vec<f64> = (0..60_000_usize).map(|s| -1e-3 * s.abs_diff(truth) as f64).collect();
        assert!(filter.update(&log_likelihoods).unwrap().evidence().is_some());
        assert_abs_diff_eq!(filter.belief().iter().sum::<f64>(), 1.0, epsilon = 1e-12);
    }
    assert!(filter.best().state.abs_diff(truth) <= 300 && filter.entropy() < (60_000_f64).ln());
}

#[test]
fn a_graph_diffuses_along_its_edges() {
    let graph = PlaceGraph::new(3, &[(0, 1), (0, 2), (1, 0)]);
    assert_eq!(predicted(&graph.diffusion(0.5).unwrap(), &[1.0, 0.0, 0.0]), [0.5, 0.25, 0.25]);
    assert_eq!(predicted(&graph.diffusion(0.5).unwrap(), &[0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]);
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    assert_eq!(
        DenseTransition::from_rows(&[vec![0.5, 0.4], vec![0.0, 1.0]]),
        Err(CondensationError::RowSum { state: 0, sum: 0.9 })
    );
    assert_eq!(DiscreteFilter::from_prior(vec![0.0; 3]), Err(CondensationError::ZeroBelief));
    assert!(matches!(DiscreteFilter::uniform(0), Err(CondensationError::Extent { .. })));
    assert!(matches!(PlaceGraph::new(3, &[(0, 2)]).diffusion(1.5), Err(CondensationError::Parameter { .. })));
    assert!(matches!(
        SparseTransition::from_rows([vec![(2, 1.0)], vec![(0, 1.0)]]),
        Err(CondensationError::State { state: 2, n_states: 2 })
    ));
    assert!(matches!(PositionGrid::new(usize::MAX, 3), Err(CondensationError::Extent { .. })));
    assert!(DiffusionKernel::gaussian(&PositionGrid::new(3, 3).unwrap(), &[f64::NAN, 1.0]).is_err());
    assert!(
        SlipProbabilities { stay_probability: 0.7, other_action_probability: 0.7 }
            .transition(&PositionGrid::new(3, 3).unwrap(), GridMove::STAY)
            .is_err()
    );

    let mut filter = DiscreteFilter::from_prior(vec![1.0, 2.0, 1.0]).unwrap();
    let before = filter.clone();
    assert!(matches!(
        filter.update(&[0.0, f64::NAN, 0.0]),
        Err(CondensationError::NotFinite { index: 1, .. })
    ));
    assert!(matches!(
        filter.update(&[0.0; 2]),
        Err(CondensationError::Dimension { expected: 3, got: 2, .. })
    ));
    assert_eq!(filter.update(&[f64::NEG_INFINITY; 3]), Ok(MeasurementOutcome::Impossible));
    assert_eq!(filter.belief(), before.belief());
}

#[test]
fn kidnapped_robot_raises_one_alarm_and_is_found() {
    let grid = PositionGrid::new(20, 1).unwrap();
    let stand = SlipProbabilities::default().transition(&grid, GridMove::STAY).unwrap();
    let mut filter = DiscreteFilter::uniform(20).unwrap();
    let mut monitor = CusumTest::from_false_alarm_rate(1e-4).unwrap();
    let mut alarms = Vec::new();
    for step in 0..20 {
        let place = if step < 10 { 3 } else { 15 };
        filter.predict(&stand).unwrap();
        filter.leak(1e-6).unwrap();
        let look: Vec<f64> = (0..20).map(|s: usize| -0.5 * (s.abs_diff(place) as f64).powi(2)).collect();
        if monitor.observe(filter.update(&look).unwrap().log_likelihood_ratio()).unwrap() {
            alarms.push(step);
        }
    }
    assert_eq!(alarms, [10]);
    assert_eq!(filter.best().state, 15);
}
