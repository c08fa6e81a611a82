//! Parameters without a meaning are refused with their name and value; nothing panics.

use crate::support::{streams, world};
use wayfix_estimation_traits::Pose2;
use wayfix_scene_sim::drive::{WheelSlipParams, WheeledRobotParams};
use wayfix_scene_sim::monobot::MonobotParams;
use wayfix_scene_sim::random::{NoiseShape, RandomStreamPurpose};
use wayfix_scene_sim::route::{CircleRoute, RandomWaypointRoute, RoundedRectangleRoute, Route, RoutePiece};
use wayfix_scene_sim::sensor::laser::People;
use wayfix_scene_sim::sensor::range_bearing::{
    Clutter, ClutterIdentity, CorrelatedErrorParams, RangeDependentSigma,
};
use wayfix_scene_sim::sensor::{
    GaussianOdometryParams, LaserParams, RangeBearingParams, SimulatedSensor, WheelOdometryParams,
};
use wayfix_scene_sim::sensor::{SensorReading, TrueState};
use wayfix_scene_sim::world::{CorridorLoop, OfficeFloor, RoadsideLandmarks, UniformLandmarkField};
use wayfix_scene_sim::{Scenario, ScenarioParams, Simulation, SimulationError};

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, -1.0];

#[track_caller]
fn assert_refused(result: Result<(), SimulationError>, value: f64) {
    let named = match &result {
        Err(SimulationError::Parameter { value, .. }) => Some(value.to_bits()),
        _ => None,
    };
    assert_eq!(named, Some(value.to_bits()), "{value} gave {result:?}");
}

#[test]
fn sensor_parameters() {
    let honest = RangeBearingParams::default();
    for bad in BAD {
        let sigma = RangeDependentSigma { constant_m: bad, per_meter: 0.0 };
        let growth = RangeDependentSigma { constant_m: 0.1, per_meter: bad };
        let drift = |correlation_time_s, bearing_sigma_rad| CorrelatedErrorParams {
            correlation_time_s,
            bearing_sigma_rad,
            ..CorrelatedErrorParams::default()
        };
        for params in [
            RangeBearingParams { min_range_m: bad, ..honest },
            RangeBearingParams { max_range_m: bad, ..honest },
            RangeBearingParams { field_of_view_rad: bad, ..honest },
            RangeBearingParams { range_noise: sigma, ..honest },
            RangeBearingParams { range_noise: growth, ..honest },
            RangeBearingParams { bearing_sigma_rad: bad, ..honest },
            RangeBearingParams { noise_shape: NoiseShape::StudentT { degrees_of_freedom: bad }, ..honest },
            RangeBearingParams { range_scale: bad, ..honest },
            RangeBearingParams { drift: drift(bad, 0.0), ..honest },
            RangeBearingParams { drift: drift(1.0, bad), ..honest },
            RangeBearingParams { outlier_share: bad, ..honest },
            RangeBearingParams { scan_dropout_share: bad, ..honest },
            RangeBearingParams { missed_target_share: bad, ..honest },
            RangeBearingParams { mislabelled_share: bad, ..honest },
            RangeBearingParams {
                clutter: Clutter { mean: bad, label: ClutterIdentity::Unlabelled },
                ..honest
            },
        ] {
            assert_refused(params.validate(), bad);
        }
    }
    assert_refused(RangeBearingParams { range_bias_m: f64::NAN, ..honest }.validate(), f64::NAN);
    assert_refused(RangeBearingParams { bearing_bias_rad: f64::NAN, ..honest }.validate(), f64::NAN);
    assert_refused(RangeBearingParams { outlier_share: 1.5, ..honest }.validate(), 1.5);
    assert_refused(RangeBearingParams { period_ms: 0, ..honest }.validate(), 0.0);
    let tail = NoiseShape::StudentT { degrees_of_freedom: 2.0 };
    assert_refused(RangeBearingParams { noise_shape: tail, ..honest }.validate(), 2.0);
}

#[test]
fn laser_parameters() {
    let honest = LaserParams::default();
    let people = |people| LaserParams { people, ..honest };
    let nobody = People::default();
    for bad in BAD {
        for params in [
            LaserParams { max_range_m: bad, ..honest },
            LaserParams { no_echo_range_m: bad, ..honest },
            LaserParams { range_noise: RangeDependentSigma { constant_m: bad, per_meter: 0.0 }, ..honest },
            LaserParams { noise_shape: NoiseShape::StudentT { degrees_of_freedom: bad }, ..honest },
            LaserParams { bearing_sigma_rad: bad, ..honest },
            LaserParams { range_resolution_m: bad, ..honest },
            LaserParams { beam_width_rad: bad, ..honest },
            LaserParams { mixed_pixel_share: bad, ..honest },
            LaserParams { dropout_share: bad, ..honest },
            LaserParams { spurious_share: bad, ..honest },
            people(People { mean: bad, ..nobody }),
            people(People { radius_m: bad, ..nobody }),
            people(People { nearest_m: bad, ..nobody }),
            people(People { farthest_m: bad, ..nobody }),
        ] {
            assert_refused(params.validate(), bad);
        }
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert_refused(LaserParams { first_beam_rad: bad, ..honest }.validate(), bad);
        assert_refused(LaserParams { beam_step_rad: bad, ..honest }.validate(), bad);
        assert_refused(LaserParams { range_bias_m: bad, ..honest }.validate(), bad);
    }
    assert_refused(LaserParams { period_ms: 0, ..honest }.validate(), 0.0);
    assert_refused(LaserParams { beam_step_rad: 0.05, ..honest }.validate(), 180.0 * 0.05);
    assert_refused(people(People { mean: 101.0, ..nobody }).validate(), 101.0);
    let endless = LaserParams { n_beams: usize::MAX, ..honest };
    assert!(matches!(endless.validate(), Err(SimulationError::TooMany { .. })));
}

#[test]
fn drive_and_odometry_parameters() {
    let good = WheeledRobotParams::default();
    for bad in BAD {
        for params in [
            WheeledRobotParams { speed_mps: bad, ..good },
            WheeledRobotParams { acceleration_mps2: bad, ..good },
            WheeledRobotParams { wheel_radius_m: bad, ..good },
            WheeledRobotParams { wheel_separation_m: bad, ..good },
            WheeledRobotParams { left_radius_error: bad, ..good },
            WheeledRobotParams { right_radius_error: bad, ..good },
            WheeledRobotParams { wheel_separation_error: bad, ..good },
            WheeledRobotParams { motor_lag_s: bad, ..good },
            WheeledRobotParams { lookahead_m: bad, ..good },
            WheeledRobotParams { slip: WheelSlipParams { slip_sigma: bad, ..good.slip }, ..good },
            WheeledRobotParams { slip: WheelSlipParams { correlation_time_s: bad, ..good.slip }, ..good },
            WheeledRobotParams { slip: WheelSlipParams { wheel_correlation: bad, ..good.slip }, ..good },
        ] {
            assert_refused(params.validate(), bad);
        }
        let wheels = WheelOdometryParams::default();
        assert_refused(WheelOdometryParams { wheel_radius_m: bad, ..wheels }.validate(), bad);
        assert_refused(WheelOdometryParams { wheel_separation_m: bad, ..wheels }.validate(), bad);
        assert_refused(WheelOdometryParams { travel_sigma_share: bad, ..wheels }.validate(), bad);
        let gaussian = GaussianOdometryParams::default();
        assert_refused(
            GaussianOdometryParams { increment_position_sigma_m: bad, ..gaussian }.validate(),
            bad,
        );
        assert_refused(
            GaussianOdometryParams { increment_heading_sigma_rad: bad, ..gaussian }.validate(),
            bad,
        );
    }
    let wheels = WheelOdometryParams::default();
    assert_refused(WheelOdometryParams { ticks_per_turn: Some(0), ..wheels }.validate(), 0.0);
    assert_refused(WheelOdometryParams { period_ms: 0, ..wheels }.validate(), 0.0);
    assert_refused(
        GaussianOdometryParams { period_ms: 0, ..GaussianOdometryParams::default() }.validate(),
        0.0,
    );
}

#[test]
fn routes() {
    let mut streams = streams(1);
    let rng = streams.of(RandomStreamPurpose::Route);
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        let rectangle = RoundedRectangleRoute { length_m: 9.0, width_m: 9.0, corner_radius_m: 1.0 };
        let points = RandomWaypointRoute { n_waypoints: 2, half_width_m: 5.0, turn_radius_m: 1.0 };
        for route in [
            CircleRoute { radius_m: bad }.route(),
            RoundedRectangleRoute { length_m: bad, ..rectangle }.route(),
            RoundedRectangleRoute { width_m: bad, ..rectangle }.route(),
            RoundedRectangleRoute { corner_radius_m: bad, ..rectangle }.route(),
            RandomWaypointRoute { half_width_m: bad, ..points }.route(rng),
            RandomWaypointRoute { turn_radius_m: bad, ..points }.route(rng),
        ] {
            assert_refused(route.map(drop), bad);
        }
    }
    let start = Pose2::new(0.0, 0.0, 0.0);
    assert!(Route::open(start, vec![]).is_err());
    let straight = RoutePiece { length_m: 1.0, curvature_per_m: 0.0 };
    assert_refused(Route::closed(start, vec![straight]).map(drop), 1.0);
    assert!(Route::open(Pose2::new(f64::NAN, 0.0, 0.0), vec![straight]).is_err());
    let cramped = RandomWaypointRoute { n_waypoints: 2, half_width_m: 0.1, turn_radius_m: 1e3 };
    let no_room = SimulationError::NoRoom { what: "waypoints", placed: 0, wanted: 2 };
    assert_eq!(cramped.route(rng), Err(no_room));
}

#[test]
fn worlds() {
    let mut streams = streams(1);
    let rng = streams.of(RandomStreamPurpose::Landmarks);
    let route = CircleRoute { radius_m: 2.0 }.route().expect("valid");
    for bad in BAD {
        let field = UniformLandmarkField { n_landmarks: 2, half_width_m: 5.0, separation_m: 0.0 };
        assert_refused(UniformLandmarkField { half_width_m: bad, ..field }.plan(rng).map(drop), bad);
        assert_refused(UniformLandmarkField { separation_m: bad, ..field }.plan(rng).map(drop), bad);
        let corridor = CorridorLoop { length_m: 20.0, width_m: 10.0, corridor_m: 2.0, spacing_m: 1.0 };
        assert_refused(CorridorLoop { length_m: bad, ..corridor }.plan(rng).map(drop), bad);
        assert_refused(CorridorLoop { corridor_m: bad, ..corridor }.plan(rng).map(drop), bad);
        assert_refused(CorridorLoop { spacing_m: bad, ..corridor }.plan(rng).map(drop), bad);
        let floor = OfficeFloor {
            length_m: 28.0,
            width_m: 17.0,
            corridor_m: 2.0,
            n_rooms: 5,
            room_m: 4.0,
            room_depth_m: 3.0,
            door_m: 0.9,
            spacing_m: 5.0,
        };
        for floor in [
            OfficeFloor { length_m: bad, ..floor },
            OfficeFloor { width_m: bad, ..floor },
            OfficeFloor { corridor_m: bad, ..floor },
            OfficeFloor { room_m: bad, ..floor },
            OfficeFloor { room_depth_m: bad, ..floor },
            OfficeFloor { door_m: bad, ..floor },
            OfficeFloor { spacing_m: bad, ..floor },
        ] {
            assert_refused(floor.plan(rng).map(drop), bad);
        }
        assert_refused(OfficeFloor { n_rooms: 8, ..floor }.plan(rng).map(drop), 32.0);
        let crowded = OfficeFloor { spacing_m: 1e-300, ..floor };
        assert!(matches!(crowded.plan(rng), Err(SimulationError::TooMany { .. })));
        let rocks = RoadsideLandmarks { n_landmarks: 2, clear_m: 1.0, verge_m: 1.0 };
        assert_refused(RoadsideLandmarks { clear_m: bad, ..rocks }.plan(&route, rng).map(drop), bad);
        assert_refused(RoadsideLandmarks { verge_m: bad, ..rocks }.plan(&route, rng).map(drop), bad);
    }
    let crowded = UniformLandmarkField { n_landmarks: 100, half_width_m: 1.0, separation_m: 1.0 };
    assert!(matches!(crowded.plan(rng), Err(SimulationError::NoRoom { wanted: 100, .. })));
    let tight = CorridorLoop { length_m: 20.0, width_m: 10.0, corridor_m: 2.0, spacing_m: 1e-300 };
    assert!(matches!(tight.plan(rng), Err(SimulationError::TooMany { .. })));
}

#[test]
fn simulations_scenarios_and_the_monobot() {
    let nothing = world(&[]);
    let simulation = Simulation::new(&nothing, CircleRoute { radius_m: 2.0 }.route().expect("valid"));
    let run = |simulation: Simulation<'_>| simulation.run(&mut [], &mut streams(1)).map(drop);
    assert_refused(run(Simulation { truth_period_ms: 0, ..simulation.clone() }), 0.0);
    let forever = run(Simulation { duration_ms: u64::MAX, ..simulation.clone() });
    assert!(matches!(forever, Err(SimulationError::TooMany { got: u64::MAX, .. })));
    assert_refused(simulation.run(&mut [Box::new(Stopped)], &mut streams(1)).map(drop), 0.0);

    assert!(matches!(Scenario::named("nowhere"), Err(SimulationError::UnknownScenario { .. })));
    for bad in BAD {
        let motion = MonobotParams { motion_sigma_share: bad, ..MonobotParams::default() };
        assert_refused(motion.simulate(&mut streams(1)).map(drop), bad);
        let range = MonobotParams { range_sigma_share: bad, ..MonobotParams::default() };
        assert_refused(range.simulate(&mut streams(1)).map(drop), bad);
        let external = MonobotParams { external_position_sigma_m: bad, ..MonobotParams::default() };
        assert_refused(external.simulate(&mut streams(1)).map(drop), bad);
    }
    let endless = MonobotParams { n_steps: usize::MAX, ..MonobotParams::default() };
    assert!(matches!(endless.simulate(&mut streams(1)), Err(SimulationError::TooMany { .. })));

    let mut scenario = Scenario::named("rough_known").expect("a known name");
    let ScenarioParams::Planar(params) = &mut scenario.params else { panic!("planar") };
    params.other_robots[0].speed_mps = f64::NAN;
    assert_refused(params.simulate(&mut streams(1)).map(drop), f64::NAN);
}

/// A sensor whose clock stands still.
struct Stopped;

impl SimulatedSensor for Stopped {
    fn period_ms(&self) -> u32 {
        0
    }
    fn sense(
        &mut self,
        _: &TrueState<'_>,
        _: &mut wayfix_scene_sim::random::RandomStreams,
    ) -> Option<SensorReading> {
        None
    }
}
