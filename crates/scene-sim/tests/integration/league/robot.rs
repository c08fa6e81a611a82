//! The robot: what it reports against what is true.

use approx::abs_diff_eq;
use wayfix_estimation_traits::nalgebra::Vector3;
use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
use wayfix_scene_sim::league::{
    BodySwayParams, FieldWalkParams, GaitOdometryParams, LeggedRobot, LeggedRobotParams, RobotHeadParams,
    landmarks,
};
use wayfix_scene_sim::{plane, space};

use super::support::{mean, streams};

/// Errors of the reported mount over a minute: angle (radians) and height (metres), root mean square.
fn mount_errors(params: LeggedRobotParams, seed: u64) -> (f64, f64) {
    let mut streams = streams(seed);
    let mut robot = LeggedRobot::new(params, None, landmarks(), &mut streams).expect("a sound robot");
    let (mut angles, mut heights) = (vec![], vec![]);
    for millisecond in 0..60_000 {
        robot.step(&mut streams);
        if millisecond % 100 == 0 {
            let believed: Pose3<f64> = space::on_ground(&robot.pose()).compose(&robot.reported_mount());
            let truth = robot.camera_pose();
            angles.push(believed.rotation.angle_to(&truth.rotation).powi(2));
            heights.push((believed.translation.z - truth.translation.z).powi(2));
        }
    }
    (mean(&angles).sqrt(), mean(&heights).sqrt())
}

#[test]
fn the_reported_mount_is_off_by_about_a_degree() {
    for seed in 1..5 {
        let (angle, height) = mount_errors(LeggedRobotParams::default(), seed);
        println!("seed {seed}: {:.2}° and {:.1} mm", angle.to_degrees(), height * 1e3);
        assert!((0.6..2.5).contains(&angle.to_degrees()), "{}°", angle.to_degrees());
        assert!(height < 0.01, "{height} m");
    }
}

#[test]
fn without_sway_and_errors_of_the_joints_the_mount_is_true() {
    let default = LeggedRobotParams::default();
    let params = LeggedRobotParams {
        sway: BodySwayParams {
            roll_amplitude_rad: 0.0,
            pitch_amplitude_rad: 0.0,
            height_amplitude_m: 0.0,
            tilt_error_sigma_rad: 0.0,
            ..default.sway
        },
        head: RobotHeadParams {
            angle_resolution_rad: 0.0,
            angle_latency_s: 0.0,
            angle_bias_sigma_rad: 0.0,
            ..default.head
        },
        ..default
    };
    let (angle, height) = mount_errors(params, 1);
    // A rotation's angle from its quaternion is good to √ε.
    assert!(angle < 1e-7 && height < 1e-12, "{angle} {height}");
}

/// Sums of the true and the reported motion, forwards, sideways and turning, over 100 s.
fn odometry(odometry: GaitOdometryParams, sideways_share: f64) -> [(f64, f64); 3] {
    let default = LeggedRobotParams::default();
    let walk = FieldWalkParams { sideways_share, ..default.walk };
    let params = LeggedRobotParams { odometry, walk, ..default };
    let mut streams = streams(3);
    let mut robot = LeggedRobot::new(params, None, landmarks(), &mut streams).expect("a sound robot");
    let mut sums = [(0.0, 0.0); 3];
    for _ in 0..1000 {
        let before = robot.pose();
        (0..100).for_each(|_| robot.step(&mut streams));
        let truth = plane::relative(&before, &robot.pose());
        let said = robot.odometry(0.1, &mut streams);
        let of = |pose: Pose2<f64>| [pose.x(), pose.y(), pose.heading()];
        for (sum, (truth, said)) in sums.iter_mut().zip(of(truth).into_iter().zip(of(said))) {
            sum.0 += truth.abs();
            sum.1 += said.abs();
        }
    }
    sums
}

#[test]
fn odometry_is_off_by_a_scale_per_axis() {
    let silent = GaitOdometryParams {
        step_scale_range: [0.8, 0.8],
        turn_scale_range: [1.1, 1.1],
        noise: 0.0,
        drift_sigma_rad_per_m: 0.0,
        ..LeggedRobotParams::default().odometry
    };
    // Without turning, the parts of a way add up exactly; and turns always do.
    let ([x, y, _], [_, _, turn]) = (odometry(silent, 1.0), odometry(silent, 0.0));
    for ((truth, said), scale) in [(x, 0.8), (y, 0.8), (turn, 1.1)] {
        assert!(truth > 1.0, "it moves: {truth}");
        assert!(abs_diff_eq!(truth / said, scale, epsilon = 1e-9), "{truth} of {said}");
    }
}

#[test]
fn odometry_of_a_robot_at_rest_is_nothing() {
    let walk = FieldWalkParams { speed_mps: 0.0, mean_rest_s: 1e9, ..LeggedRobotParams::default().walk };
    let mut streams = streams(1);
    let params = LeggedRobotParams { walk, ..LeggedRobotParams::default() };
    let start = Pose2::new(0.5, 0.0, 0.0);
    let mut robot = LeggedRobot::new(params, Some(start), landmarks(), &mut streams).expect("a sound robot");
    (0..400).for_each(|_| robot.step(&mut streams));
    assert_eq!(robot.odometry(0.1, &mut streams), Pose2::new(0.0, 0.0, 0.0));
    assert_eq!(robot.pose(), start);
}

#[test]
fn the_head_looks_at_landmarks_within_reach() {
    let mut streams = streams(2);
    let params = LeggedRobotParams {
        head: RobotHeadParams { downward_gaze_share: 0.0, ..LeggedRobotParams::default().head },
        ..LeggedRobotParams::default()
    };
    let mut robot = LeggedRobot::new(params, None, landmarks(), &mut streams).expect("a sound robot");
    let mut n_in_view = 0;
    for _ in 0..600 {
        (0..100).for_each(|_| robot.step(&mut streams));
        let camera = robot.camera_pose();
        let seen = |at: &Vector3<f64>| {
            let own = camera.rotation.inverse() * (at - camera.translation);
            own.x > 0.0 && (own.y / own.x).abs() < 0.54 && (own.z / own.x).abs() < 0.42
        };
        n_in_view += usize::from(landmarks().iter().any(seen));
    }
    assert!(n_in_view > 480, "some landmark in view in {n_in_view} of 600 looks");
}
