//! The laws of a Bayes filter, and the same bits for any number of threads.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use wayfix_condensation::{BestState, DiscreteFilter, Grid, Move, Slip, StateSpace, Transition};
use wayfix_estimation_traits::BayesFilter;

/// Code that runs any filter, run on this one.
fn localize<F>(filter: &mut F, control: &F::Control, measurement: &F::Measurement) -> F::Estimate
where
    F: BayesFilter<Estimate = BestState>,
    F::Error: std::fmt::Debug,
{
    for _ in 0..3 {
        filter.predict(control).unwrap();
        filter.update(measurement).unwrap();
    }
    filter.estimate()
}

#[test]
fn it_is_a_bayes_filter() {
    let grid = Grid::new(5, 4).unwrap();
    let stay: Box<dyn Transition> = Box::new(Slip::default().transition(&grid, Move::STAY).unwrap());
    let looks: Vec<f64> = (0..grid.n_states()).map(|s| if s == 13 { 0.0 } else { -5.0 }).collect();
    let mut filter = DiscreteFilter::uniform(20).unwrap();
    let best = localize(&mut filter, stay.as_ref(), looks.as_slice());
    assert_eq!(best.state, 13);
    assert!(best.confidence > 0.9999);
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    use wayfix_condensation::DiffusionKernel;
    let grid = Grid::new(401, 307).unwrap();
    let go = Slip { stay_probability: 0.1, other_action_probability: 0.2 }
        .transition(&grid, Move { dx: 1, dy: -1 })
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
