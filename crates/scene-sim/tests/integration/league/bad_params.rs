//! Parameters without a meaning are refused with their name and value; nothing panics.

use wayfix_color_map::PinholeCamera;
use wayfix_estimation_traits::Pose2;
use wayfix_scene_sim::SimulationError;
use wayfix_scene_sim::league::{
    BodySwayParams, CameraParams, CameraSimulator, FieldWalkParams, GaitOdometryParams, LeagueDrive,
    LeagueParams, LeggedRobotParams, LinearRgb, RobotHeadParams,
};
use wayfix_scene_sim::random::NoiseShape;

use super::support::{honest, streams};

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, -1.0];

#[track_caller]
fn assert_refused<T>(result: Result<T, SimulationError>, value: f64) {
    let named = match result {
        Err(SimulationError::Parameter { value, .. }) => Some(value.to_bits()),
        _ => None,
    };
    assert_eq!(named, Some(value.to_bits()), "{value} is not named");
}

#[test]
fn cameras() {
    for bad in BAD {
        for params in [
            CameraParams { gain: bad, ..honest() },
            CameraParams { white_balance: LinearRgb::new(1.0, bad, 1.0), ..honest() },
            CameraParams { white_balance_drift_sigma: bad, ..honest() },
            CameraParams { white_balance_correlation_s: bad, ..honest() },
            CameraParams { vignetting: LinearRgb::new(0.0, 0.0, bad), ..honest() },
            CameraParams { crosstalk: bad, ..honest() },
            CameraParams { stray_light: bad, ..honest() },
            CameraParams { full_well_electrons: bad, ..honest() },
            CameraParams { read_noise_sigma: bad, ..honest() },
            CameraParams { gamma: bad, ..honest() },
        ] {
            assert_refused(CameraSimulator::new(params), bad);
        }
    }
    assert_refused(CameraParams { jpeg_quality: 0, ..honest() }.validate(), 0.0);
    assert_refused(CameraParams { jpeg_quality: 101, ..honest() }.validate(), 101.0);
    assert_refused(CameraParams { exposure_ms: 5000, ..honest() }.validate(), 5000.0);
    let huge = PinholeCamera::new(16_384, 16_384, 1e3, 1e3, 0.0, 0.0).expect("allowed there");
    assert!(matches!(
        CameraSimulator::new(CameraParams { camera: huge, ..honest() }),
        Err(SimulationError::TooMany { .. })
    ));
}

#[test]
fn robots() {
    let default = LeggedRobotParams::default();
    for bad in BAD {
        let walks = [
            FieldWalkParams { speed_mps: bad, ..default.walk },
            FieldWalkParams { turn_radps: bad, ..default.walk },
            FieldWalkParams { speed_time_constant_s: bad, ..default.walk },
            FieldWalkParams { mean_rest_s: bad, ..default.walk },
            FieldWalkParams { sideways_share: bad, ..default.walk },
            FieldWalkParams { min_board_distance_m: bad, ..default.walk },
        ];
        let sways = [
            BodySwayParams { stride_period_s: bad, ..default.sway },
            BodySwayParams { roll_amplitude_rad: bad, ..default.sway },
            BodySwayParams { pitch_amplitude_rad: bad, ..default.sway },
            BodySwayParams { height_amplitude_m: bad, ..default.sway },
            BodySwayParams { tilt_error_sigma_rad: bad, ..default.sway },
        ];
        let heads = [
            RobotHeadParams { speed_radps: bad, ..default.head },
            RobotHeadParams { pan_limit_rad: bad, ..default.head },
            RobotHeadParams { mean_gaze_duration_s: bad, ..default.head },
            RobotHeadParams { downward_gaze_share: bad, ..default.head },
            RobotHeadParams { angle_resolution_rad: bad, ..default.head },
            RobotHeadParams { angle_latency_s: bad, ..default.head },
            RobotHeadParams { angle_bias_sigma_rad: bad, ..default.head },
        ];
        let odometries = [
            GaitOdometryParams { step_scale_range: [bad, 1.0], ..default.odometry },
            GaitOdometryParams { turn_scale_range: [1.0, bad], ..default.odometry },
            GaitOdometryParams { noise: bad, ..default.odometry },
            GaitOdometryParams {
                noise_shape: NoiseShape::StudentT { degrees_of_freedom: bad },
                ..default.odometry
            },
            GaitOdometryParams { drift_sigma_rad_per_m: bad, ..default.odometry },
            GaitOdometryParams { drift_correlation_s: bad, ..default.odometry },
        ];
        let robots = walks.map(|walk| LeggedRobotParams { walk, ..default }).into_iter();
        let robots = robots.chain(sways.map(|sway| LeggedRobotParams { sway, ..default }));
        let robots = robots.chain(heads.map(|head| LeggedRobotParams { head, ..default }));
        let robots = robots.chain(odometries.map(|odometry| LeggedRobotParams { odometry, ..default }));
        for robot in robots {
            let params = LeagueParams { robot, n_frames: 1, ..LeagueParams::default() };
            assert_refused(LeagueDrive::new(&params, streams(1)), bad);
        }
    }
}

#[test]
fn drives() {
    let default = LeagueParams::default();
    for start in
        [Pose2::new(f64::NAN, 0.0, 0.0), Pose2::new(0.0, f64::NAN, 0.0), Pose2::new(0.0, 0.0, f64::NAN)]
    {
        assert_refused(
            LeagueDrive::new(&LeagueParams { start: Some(start), ..default.clone() }, streams(1)),
            f64::NAN,
        );
    }
    assert_refused(LeagueDrive::new(&LeagueParams { period_ms: 12, ..default.clone() }, streams(1)), 12.0);
    assert_refused(
        LeagueDrive::new(&LeagueParams { period_ms: 60_001, ..default.clone() }, streams(1)),
        60_001.0,
    );
    let labels = LeagueParams { n_frames: 3, n_labelled_frames: 4, ..default.clone() }.simulate(streams(1));
    assert!(matches!(labels, Err(SimulationError::TooMany { limit: 3, got: 4, .. })));
    let many = LeagueDrive::new(&LeagueParams { n_frames: 100_001, ..default.clone() }, streams(1));
    assert!(matches!(many, Err(SimulationError::TooMany { got: 100_001, .. })));
    let none = LeagueParams { n_frames: 0, ..default };
    assert_eq!(LeagueDrive::new(&none, streams(1)).expect("no frames are no fault").count(), 0);
}
