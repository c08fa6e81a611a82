//! What a laser says of known walls, with and without its sins.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use std::f64::consts::FRAC_PI_2;
use wayfix_estimation_traits::{Pose2, nalgebra::Vector2};
use wayfix_scene_sim::sensor::laser::People;
use wayfix_scene_sim::sensor::range_bearing::RangeDependentSigma;
use wayfix_scene_sim::sensor::{Laser, LaserParams, SimulatedSensor, TrueState};
use wayfix_scene_sim::world::{FloorPlan, PlanarWorld, Wall};
use wayfix_sensor_log::{LaserScan, RecordData};

use crate::support::{assert_near, assert_share, deviation, mean, streams};

/// No error at all.
fn exact() -> LaserParams {
    LaserParams {
        range_noise: RangeDependentSigma::default(),
        bearing_sigma_rad: 0.0,
        range_resolution_m: 0.0,
        mixed_pixel_share: 0.0,
        ..LaserParams::default()
    }
}

fn wall(from: (f64, f64), to: (f64, f64)) -> Wall {
    Wall { from: Vector2::new(from.0, from.1), to: Vector2::new(to.0, to.1) }
}

/// A wall 4 m ahead, and before its left half another one at 2 m.
fn step() -> Vec<Wall> {
    vec![wall((4.0, -50.0), (4.0, 50.0)), wall((2.0, 0.01), (2.0, 50.0))]
}

fn scans(params: LaserParams, walls: Vec<Wall>, n: u64, seed: u64) -> Vec<LaserScan> {
    let world = PlanarWorld::new(FloorPlan { landmarks: vec![], walls });
    let mut laser = Laser::new(params).expect("valid parameters");
    let mut streams = streams(seed);
    (0..n)
        .map(|k| {
            let pose = Pose2::new(0.0, 0.0, 0.0);
            let moment = TrueState { milliseconds: k * 200, pose, wheel_angles: [0.0; 2], world: &world };
            match laser.sense(&moment, &mut streams).map(|reading| reading.data) {
                Some(RecordData::Scan(scan)) => scan,
                other => unreachable!("a laser only makes scans, not {other:?}"),
            }
        })
        .collect()
}

#[test]
fn without_errors_a_beam_ends_on_the_nearest_wall() {
    for scan in scans(exact(), step(), 1, 1) {
        for (beam, range) in scan.ranges.iter().enumerate() {
            let bearing = scan.bearing(beam);
            let away = if bearing.tan() > 0.01 / 2.0 { 2.0 } else { 4.0 };
            let expected = away / bearing.cos();
            let (in_reach, seen) = (expected <= 30.0, *range < scan.range_max);
            assert_eq!(in_reach, seen, "beam {beam} at {range} m");
            assert!(!seen || (range - expected).abs() < 1e-9, "beam {beam}: {range}, not {expected}");
        }
    }
}

#[test]
fn a_turned_and_moved_robot_sees_the_same_wall_from_there() {
    let world =
        PlanarWorld::new(FloorPlan { landmarks: vec![], walls: vec![wall((-50.0, 3.0), (50.0, 3.0))] });
    let pose = Pose2::new(7.0, 1.0, FRAC_PI_2);
    let moment = TrueState { milliseconds: 0, pose, wheel_angles: [0.0; 2], world: &world };
    let reading = Laser::new(exact()).expect("valid").sense(&moment, &mut streams(1));
    let Some(RecordData::Scan(scan)) = reading.map(|reading| reading.data) else { panic!("no scan") };
    assert_abs_diff_eq!(scan.ranges[90], 2.0, epsilon = 1e-9);
    assert_abs_diff_eq!(scan.ranges[30], 4.0, epsilon = 1e-9);
}

#[test]
fn ranges_err_as_stated_and_are_whole_centimetres() {
    let noisy = LaserParams {
        range_bias_m: 0.02,
        range_noise: RangeDependentSigma { constant_m: 0.03, per_meter: 0.0 },
        ..exact()
    };
    let ahead = |params| -> Vec<f64> {
        scans(params, step(), 4000, 2)
            .iter()
            .map(|scan| scan.ranges[89] - 4.0 / 1_f64.to_radians().cos())
            .collect()
    };
    let errors = ahead(noisy);
    assert_near("bias", mean(&errors), 0.02, 0.03 / 4000_f64.sqrt());
    assert_near("deviation", deviation(&errors), 0.03, 0.03 / 8000_f64.sqrt());
    for scan in scans(LaserParams { range_resolution_m: 0.01, ..noisy }, step(), 20, 2) {
        assert!(scan.echoes().all(|(_, range)| (range * 100.0 - (range * 100.0).round()).abs() < 1e-6));
    }
    let turned = ahead(LaserParams { bearing_sigma_rad: 0.002, ..exact() });
    // d(4/cos φ)/dφ = 4 tan φ / cos φ at 1°.
    let slope = 4.0 * 1_f64.to_radians().tan();
    assert_near("deviation of the direction", deviation(&turned), 0.002 * slope, 0.012 * 0.002 * slope);
}

#[test]
fn only_beams_on_an_edge_mix_two_surfaces() {
    let mixing = LaserParams { mixed_pixel_share: 0.4, ..exact() };
    // The nearer wall begins 5 mrad to the left of straight ahead: beam 90 is cut by it when the beam is 12 mrad wide.
    let wide = LaserParams { beam_width_rad: 0.012, ..mixing };
    // Short walls: on one seen at a very flat angle so wide a beam finds an edge where there is none.
    let walls = vec![wall((4.0, -6.0), (4.0, 6.0)), wall((2.0, 0.01), (2.0, 6.0))];
    let (plain, mixed) = (scans(exact(), walls.clone(), 1, 3), scans(wide, walls, 2000, 3));
    let n_between = mixed.iter().filter(|scan| (2.001..3.999).contains(&scan.ranges[90])).count();
    assert_share("mixed beams on the edge", n_between, 2000, 0.4);
    for scan in &mixed {
        for (beam, range) in scan.ranges.iter().enumerate().filter(|(beam, _)| *beam != 90) {
            assert_eq!(range.to_bits(), plain[0].ranges[beam].to_bits(), "beam {beam} is on no edge");
        }
    }
}

#[test]
fn lost_and_short_beams_have_their_rates_and_others_are_kept() {
    let plain = scans(exact(), step(), 100, 4);
    let pairs = |params| -> Vec<(f64, f64)> {
        let sinful = scans(params, step(), 100, 4);
        let ranges =
            |scans: &[LaserScan]| scans.iter().flat_map(|scan| scan.ranges.clone()).collect::<Vec<f64>>();
        ranges(&plain).into_iter().zip(ranges(&sinful)).filter(|(range, _)| *range < 80.0).collect()
    };
    let lost = pairs(LaserParams { dropout_share: 0.2, ..exact() });
    assert_share("lost", lost.iter().filter(|(_, range)| *range == 81.91).count(), lost.len(), 0.2);
    assert!(lost.iter().all(|(before, after)| *after == 81.91 || after == before));
    let dusty = pairs(LaserParams { spurious_share: 0.1, ..exact() });
    assert_share("dust", dusty.iter().filter(|(before, after)| after < before).count(), dusty.len(), 0.1);
    assert!(dusty.iter().all(|(before, after)| after <= before));
}

#[test]
fn people_stand_before_walls_and_hide_as_much_as_they_are_wide() {
    let crowd = People { mean: 1.0, radius_m: 0.25, nearest_m: 1.0, farthest_m: 1.5 };
    let scans = scans(LaserParams { people: crowd, ..exact() }, step(), 400, 5);
    let hidden: usize =
        scans.iter().map(|scan| scan.ranges.iter().filter(|range| **range < 1.5).count()).sum();
    // A person at distance d covers 2 asin(0.25/d); the mean of that over 1 to 1.5 m, by Simpson's rule, in beams of 1°; at the ends of
    // the view half of it is out of sight. Persons cover each other: 1 - exp(-share) instead of the share.
    let width = |d: f64| 2.0 * (0.25 / d).asin().to_degrees();
    let covered = (width(1.0) + 4.0 * width(1.25) + width(1.5)) / 6.0;
    let expected = 1.0 - (-covered / 181.0_f64).exp();
    // Poisson: 400 persons, 5 %; and what is out of sight at the ends, covered/4 of 181 beams at most: 4 %.
    let share = hidden as f64 / (400.0 * 181.0);
    assert!(abs_diff_eq!(share / expected, 1.0, epsilon = 4.0 * 0.05 + 0.04), "{share}, expected {expected}");
}

#[test]
fn one_scan_of_no_beams_is_empty() {
    let scan = scans(LaserParams { n_beams: 0, ..exact() }, step(), 1, 6).remove(0);
    assert!(scan.ranges.is_empty());
}
