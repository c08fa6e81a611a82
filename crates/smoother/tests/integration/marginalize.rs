//! Marginalization against the whole problem.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use crate::common::world;
use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{Const, DMatrix, Matrix2, Vector2};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_smoother::{Graph, Kernel, Method, Params, Residual, SmootherError, VariableId};

const EXACT: Params = Params {
    method: Method::LevenbergMarquardt,
    max_iterations: 100,
    relative_decrease: 1e-15,
    graduated: false,
};

/// $`b - a - z`$, which is linear.
struct Offset(Vector2<f64>);

impl Residual for Offset {
    type Dim = Const<2>;
    type Variables = (Vector2<f64>, Vector2<f64>);
    fn value(&self, (a, b): (&Vector2<f64>, &Vector2<f64>)) -> Vector2<f64> {
        b - a - self.0
    }
    fn jacobians(&self, _: (&Vector2<f64>, &Vector2<f64>)) -> (Matrix2<f64>, Matrix2<f64>) {
        (-Matrix2::identity(), Matrix2::identity())
    }
}

/// A walk in the plane past a landmark that is seen from every position; steps contradict the sightings.
fn walk(n: usize) -> (Vec<Vector2<f64>>, Vec<Vector2<f64>>) {
    let noise = |k: usize| Vector2::new((1.7 * k as f64).sin(), (2.3 * k as f64).cos()) * 0.1;
    let steps = (1..n).map(|k| Vector2::new(1.0, 0.2) + noise(k)).collect();
    let seen = (0..n).map(|k| Vector2::new(5.0 - k as f64, 3.0 - 0.2 * k as f64) + noise(7 * k)).collect();
    (steps, seen)
}

#[test]
fn linear_window_equals_batch_after_dropping() {
    let (steps, seen) = walk(30);
    let (weight, sighting) = (Matrix2::new(40.0, 3.0, 3.0, 30.0), Matrix2::new(9.0, -1.0, -1.0, 4.0));
    let run = |lag: usize| {
        let mut graph = Graph::new();
        let landmark = graph.add_variable(Vector2::zeros());
        let mut positions = vec![graph.add_variable(Vector2::zeros())];
        graph.fix(positions[0]).unwrap();
        for (k, seen) in seen.iter().enumerate() {
            if k > 0 {
                let position = graph.add_variable(Vector2::zeros());
                graph.add(Offset(steps[k - 1]), (positions[k - 1], position), weight).unwrap();
                positions.push(position);
            }
            graph.add(Offset(*seen), (positions[k], landmark), sighting).unwrap();
            graph.optimize(&EXACT).unwrap();
            if k >= lag {
                let dropped = graph.marginalize(&[positions[k - lag].index()]).unwrap();
                assert_eq!(dropped.n_variables, 1);
                assert!(dropped.n_residuals >= 2 && dropped.neighbours.contains(&landmark.index()));
            }
        }
        (graph, landmark, *positions.last().unwrap())
    };
    let (mut batch, batch_landmark, batch_last) = run(usize::MAX);
    let (mut window, window_landmark, window_last) = run(4);
    assert_eq!((batch.n_variables(), window.n_variables()), (31, 5));
    let value = |graph: &Graph, id: VariableId<Vector2<f64>>| *graph.value(id).unwrap();
    assert_abs_diff_eq!(value(&batch, batch_landmark), value(&window, window_landmark), epsilon = 1e-9);
    assert_abs_diff_eq!(value(&batch, batch_last), value(&window, window_last), epsilon = 1e-9);
    assert!(
        abs_diff_eq!(batch.cost() / window.cost(), 1.0, epsilon = 1e-9),
        "{} {}",
        batch.cost(),
        window.cost()
    );
    let joint = |graph: &mut Graph, ids: [usize; 2]| graph.marginals().unwrap().joint(&ids).unwrap();
    let of_batch = joint(&mut batch, [batch_landmark.index(), batch_last.index()]);
    let of_window = joint(&mut window, [window_landmark.index(), window_last.index()]);
    assert_abs_diff_eq!(of_batch, of_window, epsilon = 1e-9 * of_batch.amax());
}

/// At a minimum, dropping changes neither the minimum nor the covariances of the others; moved away, the optimizer comes back.
#[test]
fn nonlinear_minimum_stays_where_it_is() {
    let mut world = world(3, 24, true);
    world.graph.optimize(&EXACT).unwrap();
    let (kept, dropped) =
        (world.poses[20], [world.poses[2].index(), world.poses[3].index(), world.poses[7].index()]);
    let (value, cost) = (*world.graph.value(kept).unwrap(), world.graph.cost());
    let covariance = world.graph.marginals().unwrap().covariance(kept).unwrap();
    let n_before = (world.graph.n_variables(), world.graph.n_residuals());
    let what = world.graph.marginalize(&dropped).unwrap();
    assert_eq!(world.graph.n_variables(), n_before.0 - 3);
    assert_eq!(world.graph.n_residuals(), n_before.1 - what.n_residuals + 1);
    assert_abs_diff_eq!(world.graph.cost() / cost, 1.0, epsilon = 1e-12);
    let after = world.graph.marginals().unwrap().covariance(kept).unwrap();
    assert_abs_diff_eq!(after, covariance, epsilon = 1e-9 * covariance.amax());

    for neighbour in [kept, world.poses[4], world.poses[8]] {
        let moved = world.graph.value(neighbour).unwrap().retract(&nalgebra::Vector3::new(0.05, -0.03, 0.04));
        world.graph.set_value(neighbour, moved).unwrap();
    }
    world.graph.optimize(&EXACT).unwrap();
    assert!(value.local(world.graph.value(kept).unwrap()).norm() < 1e-6);
    assert_abs_diff_eq!(world.graph.cost() / cost, 1.0, epsilon = 1e-9);
}

#[test]
fn removed_variables_are_unknown_and_their_places_used_again() {
    let mut graph = Graph::new();
    let [a, b, c] = [0.0, 1.0, 2.0].map(|x| graph.add_variable(Vector2::new(x, 0.0)));
    graph.fix(a).unwrap();
    let first = graph.add(Offset(Vector2::x()), (a, b), Matrix2::identity()).unwrap();
    let second = graph.add(Offset(Vector2::x()), (b, c), Matrix2::identity()).unwrap();
    assert_eq!(graph.marginalize(&[99]).unwrap_err(), SmootherError::UnknownId);
    let removed = graph.remove_variables(&[c.index()]).unwrap();
    assert_eq!((removed.n_variables, removed.n_residuals), (1, 1));
    assert_eq!(graph.remove(second).unwrap_err(), SmootherError::UnknownId);
    let again = graph.add_variable(Vector2::new(5.0, 5.0));
    assert_eq!(again.index(), c.index());
    assert!(graph.value(c).is_err() && graph.value(again).unwrap().x == 5.0 && again != c);
    assert!(graph.add(Offset(Vector2::x()), (b, c), Matrix2::identity()).is_err());
    graph.set_kernel(first, Kernel::Huber { k: 1.0 }).unwrap();
    graph.remove(first).unwrap();
    assert_eq!(graph.n_residuals(), 0);
}

/// Taking back a landmark that an earlier marginalization knows leaves no trace in the graph, and the rest determined.
#[test]
fn removal_from_an_earlier_prior_is_a_marginalization() {
    let mut world = world(3, 24, true);
    world.graph.optimize(&EXACT).unwrap();
    let (second, third) = (world.poses[1].index(), world.poses[2].index());
    let first = world.graph.marginalize(&[second]).unwrap();
    assert!(first.neighbours.contains(&third));
    let removed = world.graph.remove_variables(&[third]).unwrap();
    assert!(removed.n_variables == 1 && !removed.neighbours.is_empty());
    assert!(world.graph.value(world.poses[2]).is_err());
}

#[test]
fn undetermined_variable_is_refused_and_nothing_changes() {
    let mut graph = Graph::new();
    let [a, b] = [0.0, 1.0].map(|x| graph.add_variable(Vector2::new(x, 0.0)));
    let half = Matrix2::new(1.0, 0.0, 0.0, 0.0);
    graph.add(Offset(Vector2::x()), (a, b), half).unwrap();
    let error = graph.marginalize(&[a.index()]).unwrap_err();
    assert!(matches!(error, SmootherError::IllConditioned { smallest: 0.0, .. }), "{error}");
    assert_eq!((graph.n_variables(), graph.n_residuals()), (2, 1));
}

#[test]
fn gaussian_is_what_a_marginalization_leaves() {
    let mut world = world(5, 20, true);
    let kept = [world.poses[19].index(), world.landmarks[1].index(), world.landmarks[2].index()];
    let (mean, covariance) = world.graph.gaussian(&kept).unwrap();
    let cost = world.graph.cost();
    let dropped: Vec<usize> =
        (0..world.graph.n_variables()).filter(|variable| !kept.contains(variable)).collect();
    world.graph.marginalize(&dropped).unwrap();
    let (mean_after, covariance_after) = world.graph.gaussian(&kept).unwrap();
    assert!(cost > 0.0 && mean.norm() > 1e-3);
    assert_abs_diff_eq!(mean, mean_after, epsilon = 1e-9);
    assert_abs_diff_eq!(covariance, covariance_after, epsilon = 1e-9);
}

#[test]
fn gaussian_that_is_added_is_there() {
    let mut graph = Graph::new();
    let (pose, point) = (graph.add_variable(Pose2::new(1.0, 2.0, 3.0)), graph.add_variable(Vector2::x()));
    let numbers = [point.index(), pose.index()];
    let information = DMatrix::from_fn(5, 5, |i, k| if i == k { 4.0 } else { 1.0 / (1.0 + (i + k) as f64) });
    graph.add_gaussian(&numbers, information.clone()).unwrap();
    let (mean, covariance) = graph.gaussian(&numbers).unwrap();
    assert_eq!(mean.norm(), 0.0);
    assert_abs_diff_eq!(covariance * &information, DMatrix::identity(5, 5), epsilon = 1e-12);
    let mut asymmetric = information.clone();
    asymmetric[(0, 1)] = 0.0;
    for (numbers, information) in [
        (vec![0, 7], information.clone()),
        (vec![1, 1], DMatrix::identity(4, 4)),
        (vec![1], information.clone()),
        (numbers.to_vec(), asymmetric),
        (numbers.to_vec(), -information),
        (vec![1], DMatrix::identity(2, 2) * f64::NAN),
    ] {
        assert!(graph.add_gaussian(&numbers, information).is_err(), "{numbers:?}");
        assert_eq!(graph.n_residuals(), 1);
    }
    assert_eq!(graph.gaussian(&[7]), Err(SmootherError::UnknownId));
}
