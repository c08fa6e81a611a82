//! Layouts put landmarks and walls where they say.

use crate::support::streams;
use approx::assert_abs_diff_eq;
use wayfix_estimation_traits::nalgebra::Vector2;
use wayfix_scene_sim::random::RandomStreamPurpose;
use wayfix_scene_sim::route::{CircleRoute, Route, RoutePiece};
use wayfix_scene_sim::world::{
    CorridorLoop, FloorPlan, OfficeFloor, OtherRobot, PlanarWorld, RoadsideLandmarks, SensorWorld,
    UniformLandmarkField,
};
use wayfix_sensor_log::{DetectionTarget, TrueLandmark};

const SEED: u64 = 11;

fn points(plan: &FloorPlan) -> Vec<Vector2<f64>> {
    plan.landmarks.iter().map(|l| Vector2::new(l.x, l.y)).collect()
}

#[test]
fn a_field_fills_its_square_and_keeps_landmarks_apart() {
    let field = UniformLandmarkField { n_landmarks: 100, half_width_m: 10.0, separation_m: 1.0 };
    let plan = field.plan(streams(SEED).of(RandomStreamPurpose::Landmarks)).expect("valid");
    let points = points(&plan);
    for (k, p) in points.iter().enumerate() {
        assert!(p.amax() <= 10.0 && points[..k].iter().all(|q| (p - q).norm() >= 1.0), "{p:?}");
    }
    // A hundred uniform points leave a quadrant empty with probability 4 · 0.75^100 = 1e-12.
    assert!(
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
            .iter()
            .all(|(x, y)| points.iter().any(|p| p.x * x > 0.0 && p.y * y > 0.0))
    );
    assert!(plan.landmarks.iter().zip(0..).all(|(l, id)| l.id == id), "numbered in order");
}

#[test]
fn corridor_landmarks_are_on_walls_and_hidden_behind_corners() {
    let corridor = CorridorLoop { length_m: 20.0, width_m: 10.0, corridor_m: 2.0, spacing_m: 2.0 };
    let plan = corridor.plan(streams(SEED).of(RandomStreamPurpose::Landmarks)).expect("valid");
    for p in points(&plan) {
        let outer = (p.x.abs() - 11.0).max(p.y.abs() - 6.0);
        let inner = (p.x.abs() - 9.0).max(p.y.abs() - 4.0);
        assert!(outer.abs() < 1e-9 || inner.abs() < 1e-9, "{p:?} hangs in the air");
    }
    // Outer wall 2 (22 + 12) m, inner 2 (18 + 8) m, one landmark every 2 m.
    assert_eq!(plan.landmarks.len(), 34 + 26);
    let world = PlanarWorld::new(plan);
    let at = Vector2::new;
    assert!(world.occludes(&at(0.0, -5.0), &at(0.0, 5.0)), "across the block");
    assert!(!world.occludes(&at(0.0, -5.0), &at(9.5, -5.0)), "along the corridor");
    let own_side = points(&world.plan).into_iter().filter(|p| (p.y + 4.0).abs() < 1e-9 && p.x.abs() < 8.0);
    assert!(
        own_side.into_iter().all(|p| !world.occludes(&at(p.x, -5.0), &p)),
        "a landmark hides behind its own wall"
    );
}

#[test]
fn an_office_floor_is_closed_but_for_its_doors() {
    let floor = OfficeFloor {
        length_m: 28.4,
        width_m: 17.4,
        corridor_m: 2.0,
        n_rooms: 5,
        room_m: 4.0,
        room_depth_m: 3.0,
        door_m: 0.9,
        spacing_m: 5.0,
    };
    let plan = floor.plan(streams(SEED).of(RandomStreamPurpose::Landmarks)).expect("valid");
    // From the corridor into all directions: no sight leads out of the building, which ends 1 m (short sides, and the niches' depth) or 4 m
    // (long sides) beyond the centre line, and none into the block.
    for (eye, into_block) in [((0.0, -8.7), 1.0), ((0.0, 8.7), -1.0), ((14.2, 0.0), 0.0), ((-14.2, 0.0), 0.0)]
    {
        let eye = Vector2::new(eye.0, eye.1);
        for k in 0..3600 {
            let direction = wayfix_scene_sim::plane::direction(f64::from(k).to_radians() / 10.0 + 1e-4);
            let hit = plan.walls.iter().filter_map(|wall| wall.distance(&eye, &direction)).reduce(f64::min);
            let hit = eye + direction * hit.unwrap_or(f64::INFINITY);
            assert!(hit.x.abs() <= 15.3 + 1e-9 && hit.y.abs() <= 12.7 + 1e-9, "{hit:?} from {eye:?}");
            assert!(
                hit.x.abs() >= 13.2 - 1e-9 || hit.y.abs() >= 7.7 - 1e-9,
                "{hit:?} is in the block, from {eye:?}"
            );
            assert!(
                direction.y * into_block <= 0.9 || (hit.y - eye.y).abs() <= 1.0 + 1e-9,
                "through the block: {hit:?}"
            );
        }
    }
    // On each long side five doors of 0.9 m are open: so much of the wall is missing, less what the leaves hide, 4 mm each, and two steps of 1 mm.
    let samples = 20_000;
    let open = (0..samples).filter(|k| {
        let x = -10.0 + 20.0 * f64::from(*k) / f64::from(samples);
        let (inside, outside) = (Vector2::new(x, -9.6), Vector2::new(x, -9.71));
        !plan.walls.iter().any(|wall| wall.occludes(&inside, &outside))
    });
    assert_abs_diff_eq!(open.count() as f64 * 20.0 / f64::from(samples), 5.0 * 0.9, epsilon = 0.04);
}

#[test]
fn rocks_lie_on_both_verges_of_the_road() {
    let road = CircleRoute { radius_m: 20.0 }.route().expect("valid");
    let rocks = RoadsideLandmarks { n_landmarks: 100, clear_m: 1.5, verge_m: 3.0 };
    let plan = rocks.plan(&road, streams(SEED).of(RandomStreamPurpose::Landmarks)).expect("valid");
    let offsets: Vec<f64> = points(&plan).iter().map(|p| p.norm() - 20.0).collect();
    assert!(offsets.iter().all(|o| (1.5 - 1e-9..=4.5 + 1e-9).contains(&o.abs())));
    // Binomial: 50 ± 5 on each side.
    let outside = offsets.iter().filter(|o| **o > 0.0).count();
    assert!((30..=70).contains(&outside), "{outside} of 100 outside");
}

#[test]
fn other_robots_follow_routes_and_targets_keep_order() {
    let straight = RoutePiece { length_m: 10.0, curvature_per_m: 0.0 };
    let start = wayfix_estimation_traits::Pose2::new(1.0, 0.0, 0.0);
    let route = Route::open(start, vec![straight]).expect("valid");
    let landmark = TrueLandmark { id: 4, x: 0.0, y: 3.0 };
    let world = PlanarWorld {
        unknown_codes: vec![(99, Vector2::new(5.0, 5.0))],
        other_robots: vec![OtherRobot { id: 2, route, speed_mps: 0.5 }],
        ..PlanarWorld::new(FloorPlan { landmarks: vec![landmark], walls: vec![] })
    };
    for seconds in [0.0, 6.0, 60.0] {
        let kinds: Vec<DetectionTarget> = world.targets(seconds).iter().map(|(target, _)| *target).collect();
        assert_eq!(
            kinds,
            [DetectionTarget::Landmark(4), DetectionTarget::UnknownCode(99), DetectionTarget::Robot(2)]
        );
        assert_abs_diff_eq!(
            world.targets(seconds)[2].1,
            Vector2::new(1.0 + 0.5 * seconds, 0.0),
            epsilon = 1e-12
        );
    }
}
