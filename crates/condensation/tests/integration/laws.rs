//! The laws of filters, and the same bits for any number of threads.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use wayfix_condensation::{DiscreteFilter, GridMove, PositionGrid, SlipProbabilities};
use wayfix_estimation_traits::laws;

#[test]
fn discrete_filter_obeys_the_laws_of_filters() {
    let grid = PositionGrid::new(5, 4).unwrap();
    let stay = SlipProbabilities::default().transition(&grid, GridMove::STAY).unwrap();
    let other_grid =
        SlipProbabilities::default().transition(&PositionGrid::new(3, 2).unwrap(), GridMove::STAY).unwrap();
    let state_13 = |likelihood: f64, n: usize| -> Vec<f64> {
        (0..n).map(|state| if state == 13 { likelihood } else { -5.0 }).collect()
    };
    let sees = |log_likelihoods: Vec<f64>| {
        move |filter: &mut DiscreteFilter| filter.update(&log_likelihoods).is_ok()
    };
    let (good, drives) =
        (sees(state_13(0.0, 20)), |filter: &mut DiscreteFilter| filter.predict(&stay).is_ok());
    let trial = laws::FilterLawTrial {
        estimate: &DiscreteFilter::clone,
        error: &|filter: &DiscreteFilter| 1.0 - filter.confidence(13).unwrap(),
        bound: 1e-4,
        accepted: &[&drives, &good, &drives, &good, &drives, &good],
        refused: &[
            &sees(state_13(f64::NAN, 20)),
            &sees(state_13(f64::INFINITY, 20)),
            &sees(state_13(0.0, 19)),
            &|filter| filter.predict(&other_grid).is_ok(),
        ],
    };
    laws::filter(&DiscreteFilter::uniform(20).unwrap(), &trial).unwrap();
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    use wayfix_condensation::{DiffusionKernel, DiscreteStateSpace};
    let grid = PositionGrid::new(401, 307).unwrap();
    let go = SlipProbabilities { stay_probability: 0.1, other_action_probability: 0.2 }
        .transition(&grid, GridMove { dx: 1, dy: -1 })
        .unwrap();
    let kernel = DiffusionKernel::gaussian(&grid, &[1.0, 0.7]).unwrap();
    let looks: Vec<f64> = (0..grid.n_states()).map(|s| -((s % 977) as f64).sqrt()).collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut filter = DiscreteFilter::uniform(grid.n_states()).unwrap();
            for _ in 0..4 {
                filter.predict(&go).unwrap();
                filter.predict(&kernel).unwrap();
                filter.update(&looks).unwrap().evidence().unwrap();
            }
            (filter.best(), filter.entropy().to_bits(), filter)
        })
    };
    assert_eq!(run(1), run(3));
}
