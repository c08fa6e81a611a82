//! Graphs that have no solution: the error names what is missing, and the graph stays as it was.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use crate::common::world;
use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{Const, DVector, Dyn, Matrix1, Matrix3, Vector1, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_smoother::{Between, Graph, Kernel, Method, Params, Prior, Residual, SmootherError, Stop};

fn pose(x: f64) -> Pose2<f64> {
    Pose2::new(x, 0.0, 0.0)
}

fn step() -> Between<Pose2<f64>> {
    Between::new(pose(1.0))
}

#[test]
fn graph_without_gauge_names_three_directions() {
    for method in [Method::GaussNewton, Method::LevenbergMarquardt, Method::Dogleg] {
        let mut world = world(1, 15, false);
        let before = *world.graph.value(world.poses[7]).unwrap();
        let error = world.graph.optimize(&Params { method, ..Params::default() }).unwrap_err();
        let SmootherError::Unconstrained { directions, complete } = &error else { panic!("{error}") };
        let named: Vec<_> = directions.iter().map(|d| (d.variable, d.coordinate)).collect();
        assert_eq!(named, [(0, 0), (0, 1), (0, 2)], "{error}");
        // Turning about the first pose moves everything but its own position.
        assert!(*complete && directions.iter().all(|d| d.n_moving == 19), "{error}");
        assert_eq!(*world.graph.value(world.poses[7]).unwrap(), before);
        assert!(world.graph.marginals().is_err());
    }
}

#[test]
fn second_component_is_named() {
    let mut graph = Graph::new();
    let poses: Vec<_> = (0..6).map(|i| graph.add_variable(pose(f64::from(i)))).collect();
    graph.fix(poses[0]).unwrap();
    for (a, b) in [(0, 1), (1, 2), (3, 4), (4, 5)] {
        graph.add(step(), (poses[a], poses[b]), Matrix3::identity()).unwrap();
    }
    let error = graph.optimize(&Params::default()).unwrap_err();
    let SmootherError::Unconstrained { directions, .. } = &error else { panic!("{error}") };
    assert!(
        directions.len() == 3 && directions.iter().all(|d| d.variable == 3 && d.n_moving == 3),
        "{error}"
    );
    graph.add(Prior::new(pose(3.0)), (poses[3],), Matrix3::identity()).unwrap();
    assert!(graph.optimize(&Params::default()).unwrap().cost < 1e-12);
}

#[test]
fn landmark_known_by_one_range_has_one_free_direction() {
    let mut graph = Graph::new();
    let robot = graph.add_variable(pose(0.0));
    graph.fix(robot).unwrap();
    let beacon = graph.add_variable(Vector2::new(3.0, 0.0));
    graph.add(Range(3.5), (robot, beacon), Matrix1::new(1.0)).unwrap();
    let error = graph.optimize(&Params::default()).unwrap_err();
    let SmootherError::Unconstrained { directions, .. } = &error else { panic!("{error}") };
    assert_eq!((directions.len(), directions[0].variable, directions[0].coordinate), (1, 1, 1), "{error}");
    assert!(error.to_string().contains("coordinate 1 of variable 1"), "{error}");
}

#[test]
fn variable_without_a_residual_is_named() {
    let mut graph = Graph::new();
    let ids = [0.0, 1.0, 2.0].map(|x| graph.add_variable(pose(x)));
    graph.fix(ids[0]).unwrap();
    graph.add(step(), (ids[0], ids[1]), Matrix3::identity()).unwrap();
    let error = graph.optimize(&Params::default()).unwrap_err();
    assert_eq!(error, SmootherError::WithoutResidual { variables: vec![2] });
}

#[test]
fn information_that_is_no_information_is_refused() {
    let mut graph = Graph::new();
    let (a, b) = (graph.add_variable(pose(0.0)), graph.add_variable(pose(1.0)));
    let mut refused = |information: Matrix3<f64>| graph.add(step(), (a, b), information).unwrap_err();
    let indefinite = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0));
    assert!(matches!(refused(indefinite), SmootherError::IndefiniteInformation { .. }));
    let mut crooked = Matrix3::identity();
    crooked[(0, 1)] = 0.5;
    assert!(matches!(refused(crooked), SmootherError::AsymmetricInformation { .. }));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut matrix = Matrix3::identity();
        matrix[(2, 2)] = bad;
        assert!(matches!(refused(matrix), SmootherError::NotFinite { .. }));
    }
    assert_eq!(graph.n_residuals(), 0);
}

#[test]
fn singular_information_leaves_a_named_direction() {
    let mut graph = Graph::new();
    let (a, b) = (graph.add_variable(pose(0.0)), graph.add_variable(pose(1.1)));
    graph.fix(a).unwrap();
    graph.add(step(), (a, b), Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0))).unwrap();
    let error = graph.optimize(&Params::default()).unwrap_err();
    let SmootherError::Unconstrained { directions, .. } = &error else { panic!("{error}") };
    assert_eq!(directions.len(), 1, "{error}");
    graph.add(step(), (a, b), Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1.0))).unwrap();
    assert!(graph.optimize(&Params::default()).unwrap().cost < 1e-12);
}

#[test]
fn huge_information_is_solved_or_said() {
    for size in [1e12, 1e150, 1e300, 1e308] {
        let mut graph = Graph::new();
        let ids = [0.0, 1.1, 2.3].map(|x| graph.add_variable(pose(x)));
        graph.fix(ids[0]).unwrap();
        let first = graph.add(step(), (ids[0], ids[1]), Matrix3::identity() * size);
        graph.add(step(), (ids[1], ids[2]), Matrix3::identity()).unwrap();
        let before = *graph.value(ids[2]).unwrap();
        match first.and_then(|_| graph.optimize(&Params::default())) {
            Ok(summary) => assert!(summary.cost.is_finite() && summary.cost < 1e-3, "{size:e}: {summary:?}"),
            Err(_) => assert_eq!(*graph.value(ids[2]).unwrap(), before, "{size:e}"),
        }
    }
}

#[test]
fn residual_that_becomes_nan_is_named_and_leaves_no_trace() {
    let mut graph = Graph::new();
    let x = graph.add_variable(Vector1::new(0.5));
    assert!(matches!(graph.add(SquareRoot, (x,), Matrix1::new(1.0)), Ok(id) if id.index() == 0));
    graph.set_value(x, Vector1::new(-1.0)).unwrap();
    let error = graph.optimize(&Params::default()).unwrap_err();
    assert!(matches!(error, SmootherError::NotFinite { residual: Some(0), .. }), "{error}");
    assert_eq!(graph.value(x).unwrap().x, -1.0);
    assert!(matches!(graph.add(SquareRoot, (x,), Matrix1::new(1.0)), Err(SmootherError::NotFinite { .. })));
}

#[test]
fn wrong_shapes_and_ids_are_refused() {
    let mut graph = Graph::new();
    let (a, b) = (graph.add_variable(pose(0.0)), graph.add_variable(pose(1.0)));
    assert_eq!(
        graph.add(step(), (a, a), Matrix3::identity()),
        Err(SmootherError::SelfConnection { variable: 0 })
    );
    let information = nalgebra::DMatrix::identity(3, 3);
    let error = graph.add(Growing, (a,), information).unwrap_err();
    assert!(matches!(error, SmootherError::Shape { expected: (3, 1), got: (2, 1), .. }), "{error}");
    let two_by_three = nalgebra::DMatrix::zeros(2, 3);
    let error = graph.add(Growing, (a,), two_by_three).unwrap_err();
    let is_named =
        matches!(error, SmootherError::Shape { what: "the information", expected: (2, 2), got: (2, 3), .. });
    assert!(is_named, "{error}");
    let mut other = Graph::new();
    let like_a = other.add_variable(pose(0.0));
    assert_eq!(graph.value(like_a), Err(SmootherError::UnknownId), "a pose of the same number elsewhere");
    let foreign = (other.add_variable(Vector2::new(0.0, 0.0)), other.add_variable(pose(0.0)));
    assert_eq!(graph.value(foreign.0), Err(SmootherError::UnknownId));
    assert!(graph.add(Range(1.0), (b, foreign.0), Matrix1::new(1.0)).is_err());
    let id = graph.add(step(), (a, b), Matrix3::identity()).unwrap();
    assert!(graph.set_kernel(id, Kernel::Huber { k: -1.0 }).is_err());
    assert!(other.set_kernel(id, Kernel::Huber { k: 1.0 }).is_err());
}

#[test]
fn contradicting_closure_moves_little_under_a_robust_kernel() {
    let end = |kernel: Kernel, graduated: bool| {
        let mut world = world(9, 30, true);
        let wrong = Between::new(Pose2::new(8.0, 5.0, 2.0));
        let id =
            world.graph.add(wrong, (world.poses[2], world.poses[20]), Matrix3::identity() * 400.0).unwrap();
        world.graph.set_kernel(id, kernel).unwrap();
        let summary = world.graph.optimize(&Params { graduated, ..Params::default() }).unwrap();
        assert!(summary.cost <= summary.start_cost, "{kernel:?}: {summary:?}");
        (world.graph.value(world.poses[20]).unwrap().translation - world.true_poses[20].translation).norm()
    };
    let clean = {
        let mut world = world(9, 30, true);
        world.graph.optimize(&Params::default()).unwrap();
        (world.graph.value(world.poses[20]).unwrap().translation - world.true_poses[20].translation).norm()
    };
    assert!(end(Kernel::Squared, false) > 1.0);
    for (kernel, graduated) in [
        (Kernel::Cauchy { c: 2.385 }, false),
        (Kernel::GemanMcClure { c: 4.0 }, false),
        (Kernel::GemanMcClure { c: 4.0 }, true),
        (Kernel::Switchable { phi: 1.0 }, false),
    ] {
        let moved = end(kernel, graduated);
        assert!(
            abs_diff_eq!(moved, clean, epsilon = 0.1),
            "{kernel:?}: {moved}, without the closure {clean}"
        );
    }
}

#[test]
fn graduated_stages_count_as_iterations() {
    let mut world = world(9, 30, true);
    let wrong = Between::new(Pose2::new(800.0, 500.0, 2.0));
    let ends = (world.poses[2], world.poses[20]);
    let id = world.graph.add(wrong, ends, Matrix3::identity() * 400.0).unwrap();
    world.graph.set_kernel(id, Kernel::GemanMcClure { c: 4.0 }).unwrap();
    let params = Params { graduated: true, max_iterations: 5, ..Params::default() };
    let summary = world.graph.optimize(&params).unwrap();
    assert_eq!((summary.iterations, summary.stop), (5, Stop::IterationLimit));
}

#[test]
fn hundred_thousand_poses_in_a_chain_are_solved() {
    let mut graph = Graph::new();
    let poses: Vec<_> = (0..100_000).map(|_| graph.add_variable(Pose2::identity())).collect();
    graph.fix(poses[0]).unwrap();
    for pair in poses.windows(2) {
        graph.add(step(), (pair[0], pair[1]), Matrix3::identity()).unwrap();
    }
    let summary = graph.optimize(&Params::default()).unwrap();
    assert!(summary.cost < 1e-6, "{summary:?}");
    assert_abs_diff_eq!(graph.value(poses[99_999]).unwrap().x(), 99_999.0, epsilon = 1e-2);
}

#[test]
fn parameters_without_a_meaning_are_refused() {
    let mut world = world(1, 5, true);
    for params in [
        Params { max_iterations: 0, ..Params::default() },
        Params { relative_decrease: f64::NAN, ..Params::default() },
        Params { relative_decrease: 0.0, ..Params::default() },
    ] {
        assert!(matches!(world.graph.optimize(&params), Err(SmootherError::OutOfRange { .. })));
    }
    assert!(Graph::new().optimize(&Params::default()).unwrap().cost == 0.0, "nothing to do is done");
}

/// Distance from a robot to a beacon.
struct Range(f64);
impl Residual for Range {
    type Dim = Const<1>;
    type Variables = (Pose2<f64>, Vector2<f64>);
    fn value(&self, (robot, beacon): (&Pose2<f64>, &Vector2<f64>)) -> Vector1<f64> {
        Vector1::new((beacon - robot.translation).norm() - self.0)
    }
}

/// Has no value for negative numbers.
struct SquareRoot;
impl Residual for SquareRoot {
    type Dim = Const<1>;
    type Variables = (Vector1<f64>,);
    fn value(&self, (x,): (&Vector1<f64>,)) -> Vector1<f64> {
        Vector1::new(x.x.sqrt() - 1.0)
    }
    fn jacobians(&self, (x,): (&Vector1<f64>,)) -> (Matrix1<f64>,) {
        (Matrix1::new(0.5 / x.x.sqrt()),)
    }
}

/// Says two rows where its information has three.
struct Growing;
impl Residual for Growing {
    type Dim = Dyn;
    type Variables = (Pose2<f64>,);
    fn value(&self, (pose,): (&Pose2<f64>,)) -> DVector<f64> {
        DVector::from_vec(vec![pose.x(), pose.y()])
    }
}
