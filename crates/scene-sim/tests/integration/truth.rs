//! The motion that is behind every log, and what odometry makes of it.

use crate::support::{assert_near, deviation, mean, run, streams, world};
use approx::abs_diff_eq;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2, nalgebra::Vector3};
use wayfix_scene_sim::drive::{WheelSlipParams, WheeledRobotParams};
use wayfix_scene_sim::route::{CircleRoute, RandomWaypointRoute, RoundedRectangleRoute, Route, RoutePiece};
use wayfix_scene_sim::sensor::{
    GaussianOdometry, GaussianOdometryParams, OdometryEncoding, RangeBearingDetector, RangeBearingParams,
    SimulatedSensor, WheelOdometry, WheelOdometryParams,
};
use wayfix_scene_sim::{Scenario, Simulation};
use wayfix_sensor_log::{Record, RecordData};

/// A straight route in the middle of which the origin is.
fn straight(length_m: f64) -> Route {
    let start = Pose2::new(-0.5 * length_m, 0.0, 0.0);
    Route::open(start, vec![RoutePiece { length_m, curvature_per_m: 0.0 }]).expect("a positive length")
}

fn true_poses(records: &[Record]) -> Vec<Pose2<f64>> {
    records
        .iter()
        .filter_map(|record| match record.data {
            RecordData::TruePose(pose) => Some(pose),
            _ => None,
        })
        .collect()
}

fn increments(records: &[Record]) -> Vec<Pose2<f64>> {
    records
        .iter()
        .filter_map(|record| match record.data {
            RecordData::OdometryIncrement(increment) => Some(increment),
            _ => None,
        })
        .collect()
}

fn drive(
    route: Route,
    robot: WheeledRobotParams,
    sensor: Option<Box<dyn SimulatedSensor>>,
    duration_ms: u64,
) -> Vec<Record> {
    let nothing = world(&[]);
    let simulation = Simulation { robot, duration_ms, ..Simulation::new(&nothing, route) };
    let mut sensors: Vec<Box<dyn SimulatedSensor>> = sensor.into_iter().collect();
    simulation.run(&mut sensors, &mut streams(5)).expect("valid parameters")
}

#[test]
fn the_truth_is_smooth() {
    for scenario in Scenario::all().iter().filter(|s| s.name != "monobot") {
        let records = run(scenario.name, scenario.seed);
        let (poses, period_s): (Vec<_>, f64) = (true_poses(&records), 1e-3 * truth_period_ms(&records));
        let steps: Vec<Vector3<f64>> = poses.windows(2).map(|w| w[0].local(&w[1]) / period_s).collect();
        for (k, pair) in steps.windows(2).enumerate() {
            let (name, step, next) = (scenario.name, pair[0], pair[1]);
            let speed = step.xy().norm();
            assert!(speed < 1.0, "{name} step {k}: {speed} m/s, and none is to drive faster than 0.8");
            // On wheels the chord of a step points half the turn to the side; a change of curvature bends that a little.
            let sideways = step.y - step.x * (0.5 * step.z * period_s).tan();
            assert!(sideways.abs() < 0.05 * speed + 1e-9, "{name} step {k}: {sideways} m/s sideways");
            // 0.5 m/s² of the driver and 5σ of the slip's change, 0.05 · 0.8 m/s · √(2 · 0.25 s / 1 s) in 0.25 s: 1.1 m/s².
            let change = (next.xy().norm() - speed).abs() / period_s;
            assert!(change < 1.1, "{name} step {k}: {change} m/s²");
            // Twice the curvature of a corner within a lookahead, 2 · 0.4 · 0.8/0.5 rad/s², and 5σ of the wheels' difference in slip: 3.
            let turn_change = (next.z - step.z).abs() / period_s;
            assert!(turn_change < 3.0, "{name} step {k}: {turn_change} rad/s²");
        }
    }
}

fn truth_period_ms(records: &[Record]) -> f64 {
    let stamps: Vec<_> = records
        .iter()
        .filter(|r| matches!(r.data, RecordData::TruePose(_)))
        .map(|r| r.stamp)
        .take(2)
        .collect();
    stamps[1].seconds_since(stamps[0]) * 1e3
}

#[test]
fn the_robot_keeps_to_its_route() {
    let mut rng = streams(9);
    let rng = rng.of(wayfix_scene_sim::random::RandomStreamPurpose::Route);
    let slip = WheelSlipParams { slip_sigma: 0.05, correlation_time_s: 1.0, wheel_correlation: 0.5 };
    let sinful = WheeledRobotParams {
        slip,
        left_radius_error: 0.02,
        wheel_separation_error: 0.05,
        ..WheeledRobotParams::default()
    };
    for route in [
        CircleRoute { radius_m: 4.0 }.route(),
        RoundedRectangleRoute { length_m: 10.0, width_m: 6.0, corner_radius_m: 1.0 }.route(),
        RandomWaypointRoute { n_waypoints: 15, half_width_m: 5.0, turn_radius_m: 1.0 }.route(rng),
    ] {
        let route = route.expect("valid parameters");
        let fine: Vec<Pose2<f64>> =
            (0..(route.length_m() / 0.02) as usize).map(|k| route.at(0.02 * k as f64)).collect();
        for pose in true_poses(&drive(route, sinful, None, 90_000)) {
            let off = fine.iter().map(|r| (r.translation - pose.translation).norm()).fold(9.0, f64::min);
            // Pursuit with lookahead L cuts an arc of radius r by about L²/(8 r) = 0.03 m; lag and sins add a few centimetres.
            assert!(off < 0.15, "{off} m off the route at {pose:?}");
        }
    }
}

#[test]
fn an_open_route_ends_at_rest_at_its_end() {
    let route = straight(5.0);
    let poses = true_poses(&drive(route, WheeledRobotParams::default(), None, 30_000));
    let end = poses[poses.len() - 1];
    assert!(abs_diff_eq!(end.x(), 2.5, epsilon = 0.1) && end == poses[poses.len() - 2], "ended at {end:?}");
}

#[test]
fn odometry_of_an_honest_robot_retraces_its_way() {
    let circle = || CircleRoute { radius_m: 2.0 }.route().expect("valid parameters");
    let exact = WheelOdometryParams { ticks_per_turn: None, ..WheelOdometryParams::default() };
    let records = drive(
        circle(),
        WheeledRobotParams::default(),
        Some(Box::new(WheelOdometry::new(exact).expect("valid"))),
        30_000,
    );
    let poses = true_poses(&records);
    let end = increments(&records).iter().fold(poses[0], |pose, step| pose.compose(step));
    // Within a period of 0.1 s wheel speeds change a little, which arcs of constant curvature do not retrace exactly.
    assert!(end.local(&poses[poses.len() - 1]).norm() < 1e-3, "{:?}", end.local(&poses[poses.len() - 1]));

    let held = WheelOdometryParams { encoding: OdometryEncoding::Velocity, ..exact };
    let records = drive(
        circle(),
        WheeledRobotParams::default(),
        Some(Box::new(WheelOdometry::new(held).expect("valid"))),
        30_000,
    );
    let velocities: Vec<_> = records
        .iter()
        .filter_map(|r| match r.data {
            RecordData::Velocity(v) => Some((r.stamp, v)),
            _ => None,
        })
        .collect();
    assert_eq!(velocities[0].0, records[0].stamp, "the first velocity holds from the start");
    let end = velocities.iter().fold(poses[0], |pose, (_, v)| {
        pose.compose(&Pose2::exp(&Vector3::new(0.1 * v.linear, 0.0, 0.1 * v.angular)))
    });
    assert!(end.local(&poses[poses.len() - 1]).norm() < 1e-3);
}

#[test]
fn wheels_that_are_not_as_built_bend_the_way() {
    // Radii differ by ±1 %: per metre driven the believed turn is off by 0.02/track = 0.0667 rad.
    let sinful = WheeledRobotParams {
        left_radius_error: 0.01,
        right_radius_error: -0.01,
        ..WheeledRobotParams::default()
    };
    let route = straight(100.0);
    let exact = WheelOdometryParams { ticks_per_turn: None, ..WheelOdometryParams::default() };
    let records = drive(route, sinful, Some(Box::new(WheelOdometry::new(exact).expect("valid"))), 20_000);
    let poses = true_poses(&records);
    let travelled = poses[poses.len() - 1].x() - poses[0].x();
    let believed: f64 = increments(&records).iter().map(Pose2::heading).sum();
    assert!(
        abs_diff_eq!(believed / travelled, 0.02 / 0.30, epsilon = 0.002),
        "{believed} rad over {travelled} m"
    );
}

#[test]
fn slip_has_the_size_asked_for() {
    // Straight drive, both wheels slipping as one: true travel falls short of the encoders' by the mean slip over a period.
    let slip = WheelSlipParams { slip_sigma: 0.05, correlation_time_s: 1.0, wheel_correlation: 1.0 };
    let straight = straight(3000.0);
    let exact = WheelOdometryParams { ticks_per_turn: None, ..WheelOdometryParams::default() };
    let records = drive(
        straight,
        WheeledRobotParams { slip, ..WheeledRobotParams::default() },
        Some(Box::new(WheelOdometry::new(exact).expect("valid"))),
        2_000_000,
    );
    let poses = true_poses(&records);
    let shares: Vec<f64> = poses
        .windows(2)
        .zip(increments(&records))
        .skip(30)
        .map(|(pair, believed)| 1.0 - (pair[1].x() - pair[0].x()) / believed.x())
        .collect();
    // The mean over 0.1 s of a process with τ = 1 s has 1 − 0.1/3 of its variance; 2000 s are worth about 2000 / (2 τ) samples
    // for a mean, 2000 / τ for a variance.
    let sigma = 0.05 * (1.0_f64 - 0.1 / 3.0).sqrt();
    assert_near("mean slip", mean(&shares), 0.0, sigma / 1000.0_f64.sqrt());
    assert_near("σ of the slip", deviation(&shares), sigma, sigma / (2.0 * 2000.0_f64).sqrt());
}

#[test]
fn encoders_count_whole_ticks_and_lose_none() {
    let straight = straight(300.0);
    let coarse = WheelOdometryParams { ticks_per_turn: Some(100), ..WheelOdometryParams::default() };
    let sensor = Box::new(WheelOdometry::new(coarse).expect("valid"));
    let records = drive(straight, WheeledRobotParams::default(), Some(sensor), 60_000);
    let tick_m = std::f64::consts::TAU * 0.05 / 100.0;
    let steps: Vec<f64> = increments(&records).iter().map(Pose2::x).collect();
    assert!(steps.iter().all(|x| ((x / tick_m) - (x / tick_m).round()).abs() < 1e-6));
    let poses = true_poses(&records);
    let travelled = poses[poses.len() - 1].x() - poses[0].x();
    assert!(
        abs_diff_eq!(steps.iter().sum::<f64>(), travelled, epsilon = tick_m),
        "errors of counting do not add up"
    );
}

#[test]
fn gaussian_odometry_has_the_noise_of_the_shared_logs() {
    // Standing still, increments are noise alone.
    let params = GaussianOdometryParams { period_ms: 1, ..GaussianOdometryParams::default() };
    let standing = WheeledRobotParams { speed_mps: 0.0, ..WheeledRobotParams::default() };
    let route = CircleRoute { radius_m: 2.0 }.route().expect("valid");
    let sensor = Box::new(GaussianOdometry::new(params).expect("valid"));
    let steps = increments(&drive(route, standing, Some(sensor), 40_000));
    assert_eq!(steps.len(), 40_000);
    for (what, sigma, values) in [
        ("x", 0.02, steps.iter().map(Pose2::x).collect::<Vec<_>>()),
        ("y", 0.02, steps.iter().map(Pose2::y).collect()),
        ("heading", 0.005, steps.iter().map(Pose2::heading).collect()),
    ] {
        assert_near(what, mean(&values), 0.0, sigma / 200.0);
        assert_near(what, deviation(&values), sigma, sigma / 80_000.0_f64.sqrt());
    }
}

#[test]
fn latency_shows_in_the_stamps_alone() {
    let scene = world(&[(3.0, 0.0), (-3.0, 1.0)]);
    let looks = |stamp_delay_ms| -> Vec<Record> {
        let params = RangeBearingParams { stamp_delay_ms, ..RangeBearingParams::default() };
        let sensor = Box::new(RangeBearingDetector::new(params).expect("valid"));
        let route = CircleRoute { radius_m: 2.0 }.route().expect("valid");
        let records = Simulation::new(&scene, route).run(&mut [sensor], &mut streams(5)).expect("valid");
        records.into_iter().filter(|r| matches!(r.data, RecordData::Detections(_))).collect()
    };
    for (prompt, late) in looks(0).iter().zip(looks(70)) {
        assert_eq!(prompt.data, late.data);
        assert_eq!(late.stamp.nanoseconds() - prompt.stamp.nanoseconds(), 70_000_000);
    }
}
