use std::f64::consts::FRAC_PI_3;

use super::laser::office_laser;
use super::{OdometryParams, OtherRobotParams, PlanarDriveParams, Scenario, ScenarioParams};
use crate::drive::{WheelSlipParams, WheeledRobotParams};
use crate::monobot::MonobotParams;
use crate::random::NoiseShape;
use crate::route::{CircleRoute, RandomWaypointRoute, RoundedRectangleRoute, RouteParams};
use crate::sensor::range_bearing::{Clutter, ClutterIdentity, CorrelatedErrorParams, RangeDependentSigma};
use crate::sensor::{GaussianOdometryParams, OdometryEncoding, RangeBearingParams, WheelOdometryParams};
use crate::world::{CorridorLoop, RoadsideLandmarks, UniformLandmarkField, WorldLayout};

pub(super) fn all() -> Vec<Scenario> {
    let planar =
        |name, seed, params| Scenario { name, seed, params: ScenarioParams::Planar(Box::new(params)) };
    vec![
        planar("loop_known", 1, loop_known()),
        planar("loop_unlabelled", 2, loop_unlabelled()),
        planar("office_velocity", 3, office_velocity()),
        planar("rough_known", 4, rough_known()),
        planar("long_loop", 5, long_loop()),
        Scenario { name: "monobot", seed: 6, params: ScenarioParams::Monobot(MonobotParams::default()) },
        office_laser(),
    ]
}

/// Two laps of a circle with exactly the noise that filters assume, about 500 steps of 0.25 m as in the shared range-bearing logs.
fn loop_known() -> PlanarDriveParams {
    PlanarDriveParams {
        layout: WorldLayout::UniformField(UniformLandmarkField {
            n_landmarks: 60,
            half_width_m: 16.0,
            separation_m: 1.0,
        }),
        n_unknown_codes: 0,
        other_robots: Vec::new(),
        route: RouteParams::Circle(CircleRoute { radius_m: 10.0 }),
        robot: WheeledRobotParams::default(),
        odometry: OdometryParams::Gaussian(GaussianOdometryParams::default()),
        sensor: RangeBearingParams { max_range_m: 7.0, ..RangeBearingParams::default() },
        duration_ms: 250_000,
        truth_period_ms: 500,
    }
}

/// The same kind of world, with a sensor that reads no identities.
fn loop_unlabelled() -> PlanarDriveParams {
    let known = loop_known();
    PlanarDriveParams { sensor: RangeBearingParams { labelled: false, ..known.sensor }, ..known }
}

/// Five minutes in a hall of 6 × 6 m in the manner of the UTIAS logs: velocity odometry, a camera that reads codes, range errors
/// that grow with range and are correlated in time, two other robots, codes that no table lists.
fn office_velocity() -> PlanarDriveParams {
    let wander = |half_width_m| {
        RouteParams::Waypoints(RandomWaypointRoute { n_waypoints: 60, half_width_m, turn_radius_m: 0.35 })
    };
    PlanarDriveParams {
        layout: WorldLayout::UniformField(UniformLandmarkField {
            n_landmarks: 15,
            half_width_m: 3.0,
            separation_m: 0.8,
        }),
        n_unknown_codes: 2,
        other_robots: [2, 3].map(|id| OtherRobotParams { id, route: wander(2.0), speed_mps: 0.12 }).to_vec(),
        route: wander(2.2),
        robot: WheeledRobotParams {
            speed_mps: 0.16,
            lookahead_m: 0.2,
            left_radius_error: 0.008,
            right_radius_error: -0.004,
            wheel_separation_error: 0.03,
            slip: WheelSlipParams { slip_sigma: 0.06, correlation_time_s: 2.0, wheel_correlation: 0.5 },
            ..WheeledRobotParams::default()
        },
        odometry: OdometryParams::Wheels(WheelOdometryParams {
            encoding: OdometryEncoding::Velocity,
            ..WheelOdometryParams::default()
        }),
        sensor: RangeBearingParams {
            min_range_m: 0.3,
            max_range_m: 5.0,
            field_of_view_rad: FRAC_PI_3,
            range_noise: RangeDependentSigma { constant_m: 0.01, per_meter: 0.02 },
            bearing_sigma_rad: 0.01,
            noise_shape: NoiseShape::StudentT { degrees_of_freedom: 5.0 },
            range_bias_m: 0.02,
            drift: CorrelatedErrorParams {
                range_sigma: RangeDependentSigma { constant_m: 0.02, per_meter: 0.03 },
                bearing_sigma_rad: 0.006,
                correlation_time_s: 8.0,
            },
            outlier_share: 0.01,
            missed_target_share: 0.1,
            ..RangeBearingParams::default()
        },
        duration_ms: 300_000,
        truth_period_ms: 200,
    }
}

/// Rocks along a road, every sin at once.
fn rough_known() -> PlanarDriveParams {
    PlanarDriveParams {
        layout: WorldLayout::Roadside(RoadsideLandmarks { n_landmarks: 50, clear_m: 1.0, verge_m: 4.0 }),
        n_unknown_codes: 3,
        other_robots: vec![OtherRobotParams {
            id: 2,
            route: RouteParams::Circle(CircleRoute { radius_m: 6.0 }),
            speed_mps: 0.4,
        }],
        route: RouteParams::RoundedRectangle(RoundedRectangleRoute {
            length_m: 24.0,
            width_m: 14.0,
            corner_radius_m: 2.0,
        }),
        robot: WheeledRobotParams {
            speed_mps: 0.8,
            left_radius_error: 0.003,
            right_radius_error: -0.001,
            wheel_separation_error: 0.02,
            slip: WheelSlipParams { slip_sigma: 0.05, correlation_time_s: 1.0, wheel_correlation: 0.6 },
            ..WheeledRobotParams::default()
        },
        odometry: OdometryParams::Wheels(WheelOdometryParams {
            period_ms: 250,
            ticks_per_turn: Some(500),
            travel_sigma_share: 0.01,
            ..WheelOdometryParams::default()
        }),
        sensor: RangeBearingParams {
            period_ms: 500,
            field_of_view_rad: 4.0 * FRAC_PI_3,
            range_noise: RangeDependentSigma { constant_m: 0.03, per_meter: 0.01 },
            bearing_sigma_rad: 0.015,
            noise_shape: NoiseShape::Laplace,
            range_bias_m: 0.04,
            range_scale: 1.005,
            bearing_bias_rad: 0.01,
            drift: CorrelatedErrorParams {
                range_sigma: RangeDependentSigma { constant_m: 0.02, per_meter: 0.005 },
                bearing_sigma_rad: 0.005,
                correlation_time_s: 3.0,
            },
            stamp_delay_ms: 40,
            outlier_share: 0.03,
            scan_dropout_share: 0.1,
            missed_target_share: 0.15,
            clutter: Clutter { mean: 0.3, label: ClutterIdentity::AnyLandmark },
            mislabelled_share: 0.01,
            ..RangeBearingParams::default()
        },
        duration_ms: 240_000,
        truth_period_ms: 250,
    }
}

/// Five laps of a corridor about 64 m long, landmarks on its walls and hidden behind its corners.
fn long_loop() -> PlanarDriveParams {
    PlanarDriveParams {
        layout: WorldLayout::CorridorLoop(CorridorLoop {
            length_m: 22.0,
            width_m: 12.0,
            corridor_m: 3.0,
            spacing_m: 2.5,
        }),
        n_unknown_codes: 0,
        other_robots: Vec::new(),
        route: RouteParams::RoundedRectangle(RoundedRectangleRoute {
            length_m: 22.0,
            width_m: 12.0,
            corner_radius_m: 1.5,
        }),
        robot: WheeledRobotParams {
            speed_mps: 0.8,
            left_radius_error: 0.0005,
            right_radius_error: -0.0003,
            wheel_separation_error: 0.005,
            slip: WheelSlipParams { slip_sigma: 0.02, correlation_time_s: 1.0, wheel_correlation: 0.5 },
            ..WheeledRobotParams::default()
        },
        odometry: OdometryParams::Wheels(WheelOdometryParams {
            period_ms: 500,
            ..WheelOdometryParams::default()
        }),
        sensor: RangeBearingParams { max_range_m: 6.0, ..RangeBearingParams::default() },
        duration_ms: 412_000,
        truth_period_ms: 500,
    }
}
