//! A graph that grows between optimizations: what costs nothing, and what has to be solved.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use crate::common::world;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::{Const, Matrix3, Vector1, Vector2};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_smoother::{Between, Graph, Kernel, Params, Residual, ResidualId, SmootherError, VariableId};

/// An arc of a step.
fn arc() -> Pose2<f64> {
    Pose2::new(1.0, 0.0, 0.5)
}

type PoseId = VariableId<Pose2<f64>>;
type Change<'a> = &'a dyn Fn(&mut Graph, &[PoseId], &[ResidualId]);

/// A path of poses that odometry and one closed loop have settled.
fn settled() -> (Graph, Vec<PoseId>, Vec<ResidualId>) {
    let mut graph = Graph::new();
    let mut poses = vec![graph.add_variable(Pose2::identity())];
    graph.fix(poses[0]).unwrap();
    let mut residuals = Vec::new();
    for _ in 0..5 {
        let (pose, residual) = drive(&mut graph, *poses.last().unwrap());
        poses.push(pose);
        residuals.push(residual);
    }
    let loop_closure = Between::new(Pose2::new(3.4, 2.1, 2.4));
    residuals.push(graph.add(loop_closure, (poses[0], poses[5]), Matrix3::identity()).unwrap());
    assert!(n_iterations(&mut graph) > 0);
    (graph, poses, residuals)
}

/// Distance of a landmark from a pose.
struct Range(f64);

impl Residual for Range {
    type Dim = Const<1>;
    type Variables = (Pose2<f64>, Vector2<f64>);
    fn value(&self, (pose, landmark): (&Pose2<f64>, &Vector2<f64>)) -> Vector1<f64> {
        Vector1::new((landmark - pose.translation).norm() - self.0)
    }
}

/// Adds a pose where odometry has it.
fn drive(graph: &mut Graph, from: PoseId) -> (PoseId, ResidualId) {
    let to = graph.add_variable(graph.value(from).unwrap().compose(&arc()));
    (to, graph.add(Between::new(arc()), (from, to), Matrix3::identity()).unwrap())
}

fn n_iterations(graph: &mut Graph) -> usize {
    graph.optimize(&Params::default()).unwrap().iterations
}

#[test]
fn edge_by_edge_ends_where_the_batch_does() {
    let step = |k: usize| arc().retract(&(nalgebra::Vector3::new(0.1, -0.05, 0.02) * (1.7 * k as f64).sin()));
    let information = Matrix3::new(90.0, 3.0, 0.0, 3.0, 40.0, 1.0, 0.0, 1.0, 400.0);
    let run = |is_online: bool| {
        let mut graph = Graph::new();
        let mut poses = vec![graph.add_variable(Pose2::identity())];
        graph.fix(poses[0]).unwrap();
        let (mut n_edges, mut n_solved) = (0, 0);
        let mut solve = |graph: &mut Graph, is_online: bool| {
            n_edges += 1;
            n_solved += usize::from(is_online && n_iterations(graph) > 0);
        };
        for k in 1..60 {
            let start = graph.value(poses[k - 1]).unwrap().compose(&step(k));
            poses.push(graph.add_variable(start));
            graph.add(Between::new(step(k)), (poses[k - 1], poses[k]), information).unwrap();
            solve(&mut graph, is_online);
            if k > 13 && k % 3 == 0 {
                let back = (0..13).fold(Pose2::identity(), |pose, _| pose.compose(&arc())).inverse();
                graph.add(Between::new(back), (poses[k], poses[k - 13]), information).unwrap();
                solve(&mut graph, is_online);
            }
        }
        n_iterations(&mut graph);
        let values: Vec<Pose2<f64>> = poses.iter().map(|pose| *graph.value(*pose).unwrap()).collect();
        (graph.cost(), values, n_edges, n_solved)
    };
    let (batch_cost, batch, ..) = run(false);
    let (cost, values, n_edges, n_solved) = run(true);
    assert_relative_eq!(cost, batch_cost, max_relative = 1e-6);
    for (value, batch) in values.iter().zip(&batch) {
        assert_abs_diff_eq!(batch.local(value).norm(), 0.0, epsilon = 1e-4);
    }
    assert_eq!((n_edges, n_solved), (59 + 15, 1 + 15), "the first edge and loop closures are solved");
}

#[test]
fn poses_where_odometry_has_them_cost_no_iteration() {
    let (mut graph, poses, _) = settled();
    let cost = graph.cost();
    let (next, _) = drive(&mut graph, poses[5]);
    let (last, _) = drive(&mut graph, next);
    let summary = graph.optimize(&Params::default()).unwrap();
    assert_eq!(summary.iterations, 0);
    assert_abs_diff_eq!(summary.cost, cost, epsilon = 1e-12);
    assert!(graph.marginals().unwrap().covariance(last).unwrap().trace() > 0.0);
}

#[test]
fn changes_that_move_the_minimum_are_solved() {
    let changed = |change: Change<'_>| {
        let (mut graph, poses, residuals) = settled();
        change(&mut graph, &poses, &residuals);
        let n = n_iterations(&mut graph);
        let mut afresh = settled();
        change(&mut afresh.0, &afresh.1, &afresh.2);
        let value = *afresh.0.value(afresh.1[5]).unwrap();
        afresh.0.set_value(afresh.1[5], value).unwrap();
        n_iterations(&mut afresh.0);
        assert_abs_diff_eq!(graph.cost(), afresh.0.cost(), epsilon = 1e-9);
        n
    };
    let off = arc().retract(&nalgebra::Vector3::new(0.1, 0.0, 0.0));
    let identity = Matrix3::identity();
    assert_eq!(changed(&|_, _, _| ()), 0);
    assert!(changed(&|graph, poses, _| graph.set_value(poses[3], Pose2::identity()).unwrap()) > 0);
    assert!(changed(&|graph, poses, _| graph.fix(poses[3]).unwrap()) > 0);
    assert!(
        changed(&|graph, _, residuals| graph
            .set_information::<Between<Pose2<f64>>>(residuals[5], identity * 9.0)
            .unwrap())
            > 0
    );
    assert!(
        changed(&|graph, _, residuals| graph.set_kernel(residuals[5], Kernel::Huber { k: 0.01 }).unwrap())
            > 0
    );
    assert!(changed(&|graph, _, residuals| graph.remove(residuals[5]).unwrap()) > 0);
    assert!(changed(&|graph, poses, _| drop(graph.marginalize(&[poses[2].index()]).unwrap())) > 0);
    let prior = nalgebra::DMatrix::identity(3, 3);
    assert!(changed(&|graph, poses, _| graph.add_gaussian(&[poses[4].index()], prior.clone()).unwrap()) > 0);
    let removed = |graph: &mut Graph, poses: &[PoseId], _: &[ResidualId]| {
        let (next, _) = drive(graph, poses[5]);
        graph.remove_variables(&[next.index()]).unwrap();
        drive(graph, poses[5]); // at the number that is free again
    };
    assert!(changed(&removed) > 0);
    let between = |graph: &mut Graph, ids| {
        graph.add(Between::new(off), ids, identity).unwrap();
    };
    assert!(changed(&|graph, poses, _| between(graph, (poses[2], poses[3]))) > 0);
    let new_and_off = |graph: &mut Graph, poses: &[PoseId], _: &[ResidualId]| {
        let (next, _) = drive(graph, poses[5]);
        between(graph, (poses[5], next));
    };
    assert!(changed(&new_and_off) > 0);
}

#[test]
fn refused_changes_keep_the_minimum() {
    let (mut graph, poses, residuals) = settled();
    let indefinite = -Matrix3::identity();
    graph.add(Between::new(arc()), (poses[0], poses[1]), indefinite).unwrap_err();
    graph.set_kernel(residuals[0], Kernel::Huber { k: -1.0 }).unwrap_err();
    graph.set_information::<Between<Pose2<f64>>>(residuals[0], indefinite).unwrap_err();
    assert_eq!(n_iterations(&mut graph), 0);
}

#[test]
fn small_residuals_add_up() {
    let (mut graph, poses, _) = settled();
    let off = Pose2::new(1.0 + 9e-7, 0.0, 0.5); // a square of 8e-13
    let mut add = |from: PoseId| {
        let to = graph.add_variable(graph.value(from).unwrap().compose(&arc()));
        graph.add(Between::new(off), (from, to), Matrix3::identity()).unwrap();
        (to, n_iterations(&mut graph))
    };
    let (next, first) = add(poses[5]);
    assert_eq!((first, add(next).1 > 0), (0, true));
}

#[test]
fn stricter_parameters_ask_for_more() {
    let (mut graph, ..) = settled();
    let stricter = Params { relative_decrease: 1e-15, ..Params::default() };
    assert!(graph.optimize(&stricter).unwrap().iterations > 0);
    assert_eq!(graph.optimize(&stricter).unwrap().iterations, 0);
    assert!(graph.optimize(&Params { graduated: true, ..Params::default() }).unwrap().iterations > 0);
}

#[test]
fn free_directions_of_new_variables_are_named() {
    let (mut graph, poses, _) = settled();
    let next = graph.add_variable(graph.value(poses[5]).unwrap().compose(&arc()));
    let error = graph.optimize(&Params::default()).unwrap_err();
    assert!(matches!(error, SmootherError::WithoutResidual { .. }), "{error}");
    let without_heading = Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 1.0, 0.0));
    graph.add(Between::new(arc()), (poses[5], next), without_heading).unwrap();
    let error = graph.optimize(&Params::default()).unwrap_err();
    let SmootherError::Unconstrained { directions, .. } = error else { panic!("{error}") };
    assert!(directions.iter().any(|direction| direction.variable == next.index()), "{directions:?}");

    // A range leaves the direction of a landmark free, whatever rounding says.
    for k in 0..200 {
        let (mut graph, poses, _) = settled();
        let (sin, cos) = (0.1 + 1.7 * f64::from(k)).sin_cos();
        let at = graph.value(poses[5]).unwrap().transform(&(Vector2::new(cos, sin) * 3.0));
        let landmark = graph.add_variable(at);
        graph.add(Range(3.0), (poses[5], landmark), nalgebra::Matrix1::new(7.0)).unwrap();
        let error = graph.optimize(&Params::default()).unwrap_err();
        assert!(matches!(error, SmootherError::Unconstrained { .. }), "{k}: {error}");
    }

    let (mut graph, ..) = settled();
    let floating = [0.0, 1.0].map(|x| graph.add_variable(Pose2::new(x, 0.0, 0.0)));
    let apart = Between::new(Pose2::new(1.0, 0.0, 0.0));
    graph.add(apart, (floating[0], floating[1]), Matrix3::identity()).unwrap();
    let error = graph.optimize(&Params::default()).unwrap_err();
    assert!(matches!(error, SmootherError::Unconstrained { .. }), "{error}");
}

#[test]
fn a_landmark_seen_again_is_solved() {
    let mut world = world(3, 12, true);
    assert!(n_iterations(&mut world.graph) > 0);
    let seen = wayfix_smoother::RelativePosition { measured: Vector2::new(0.5, 0.5) };
    world.graph.add(seen, (world.poses[11], world.landmarks[0]), nalgebra::Matrix2::identity()).unwrap();
    assert!(n_iterations(&mut world.graph) > 0);
}
