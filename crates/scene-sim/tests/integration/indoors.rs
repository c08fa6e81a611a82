//! Stores and the lab: what is seen, where one drives, what changes.

use approx::abs_diff_eq;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_estimation_traits::Pose2;
use wayfix_scene_sim::drive::WheeledRobotParams;
use wayfix_scene_sim::indoors::{
    AmbientLightParams, Building, IndoorDrive, IndoorDriveParams, IndoorDriveStep, Laboratory,
    OmniCameraParams, RetailStore, RetailStoreParams, calibrated_robot,
};
use wayfix_scene_sim::random::RandomStreams;
use wayfix_scene_sim::scenery::RgbPicture;
use wayfix_scene_sim::world::SensorWorld;

const SEED: u64 = 41;

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(SEED)
}

fn area() -> RetailStore {
    RetailStore::draw(RetailStoreParams::area(), &mut rng()).expect("the area is a store")
}

fn tour(building: &Building, params: IndoorDriveParams, length_m: f64, seed: u64) -> Vec<IndoorDriveStep> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let route = building.aisles().tour(length_m, &mut rng).expect("there are aisles");
    IndoorDrive::new(building, route, params, RandomStreams::new(rng))
        .expect("the parameters are sound")
        .collect()
}

fn look(building: &Building, pose: Pose2<f64>) -> RgbPicture {
    let camera = OmniCameraParams { pixel_noise_sigma: 0.0, ..OmniCameraParams::default() };
    building.render_view(&pose, camera, &mut rng()).expect("the camera is sound")
}

/// Root mean square difference, grey values.
fn difference(a: &RgbPicture, b: &RgbPicture) -> f64 {
    let squares = a.rgb.iter().zip(&b.rgb).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2));
    (squares.sum::<f64>() / a.rgb.len() as f64).sqrt()
}

fn columns_moved(view: &RgbPicture, by: usize) -> RgbPicture {
    let at = |i: usize| (i / view.width) * view.width + (i % view.width + by) % view.width;
    let rgb =
        (0..view.width * view.height).flat_map(|i| view.rgb[3 * at(i)..3 * at(i) + 3].to_vec()).collect();
    RgbPicture { rgb, ..view.clone() }
}

#[test]
fn who_turns_left_sees_the_same_farther_right() {
    let building = area().building();
    let at = building.aisles().station();
    let turned = Pose2::new(at.x(), at.y(), at.heading() + 10.0 * std::f64::consts::TAU / 120.0);
    let (before, after) = (look(&building, at), look(&building, turned));
    // What was in column k is in column k + 10.
    assert!(difference(&before, &columns_moved(&after, 10)) < 1.0);
    assert!(difference(&before, &after) > 5.0);
}

#[test]
fn the_front_is_in_the_middle_and_the_floor_below() {
    let building = Laboratory::draw(&mut rng()).building();
    // Half a metre before the wall of low x: only half the picture shows things farther than a metre away, that to the front.
    let view = look(&building, Pose2::new(-7.0, 0.0, 0.0));
    let variation = |columns: std::ops::Range<usize>| {
        let bytes: Vec<f64> = columns.map(|column| f64::from(view.rgb[3 * (10 * 120 + column)])).collect();
        bytes.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>()
    };
    assert!(variation(40..80) > variation(0..20) + variation(100..120), "desks ahead, a wall behind");
}

#[test]
fn views_differ_more_the_farther_apart_they_are() {
    let building = area().building();
    let at = building.aisles().place([0, 1]);
    let moved = |x: f64, y: f64| look(&building, Pose2::new(at.x + 4.0 + x, at.y + y, 0.0));
    let here = moved(0.0, 0.0);
    let steps = [0.02, 0.1, 0.5, 1.5].map(|x| difference(&here, &moved(x, 0.0)));
    assert!(steps.is_sorted(), "{steps:?}");
    // Nothing flickers: two centimetres change a view by little more than rounding, and the way there and back is smooth.
    assert!(steps[0] < 0.2 * steps[3], "{steps:?}");
}

#[test]
fn a_seed_gives_the_same_drive_and_another_seed_another() {
    let building = area().building();
    let params = IndoorDriveParams { n_people: 3, ..IndoorDriveParams::default() };
    let drive = |seed| tour(&building, params, 20.0, seed);
    assert_eq!(drive(1), drive(1));
    assert_ne!(drive(1), drive(2));
    assert_ne!(
        drive(1)[0].view,
        tour(&area().rearranged(0.5, &mut rng()).unwrap().building(), params, 20.0, 1)[0].view
    );
}

#[test]
fn people_and_the_light_do_not_disturb_where_the_robot_drives() {
    let building = area().building();
    let poses = |params| {
        tour(&building, params, 20.0, 1).iter().map(|step| (step.pose, step.odometry)).collect::<Vec<_>>()
    };
    let ambient_light =
        AmbientLightParams { mean_lamp_switching_s: Some(1.0), ..AmbientLightParams::default() };
    assert_eq!(
        poses(IndoorDriveParams { n_people: 9, ambient_light, ..IndoorDriveParams::default() }),
        poses(IndoorDriveParams::default())
    );
}

#[test]
fn tours_keep_clear_of_the_shelves_and_see_every_aisle() {
    let store = RetailStore::draw(RetailStoreParams::home_store(), &mut rng()).unwrap().building();
    for (building, aisles_m) in
        [(store, 1200.0), (area().building(), 150.0), (Laboratory::draw(&mut rng()).building(), 150.0)]
    {
        let camera = OmniCameraParams {
            n_columns: 4,
            n_rings: 1,
            rays_per_pixel: [1, 1],
            ..OmniCameraParams::default()
        };
        let params = IndoorDriveParams { camera, ..IndoorDriveParams::default() };
        let steps = tour(&building, params, 2.0 * aisles_m, 3);
        let walls = building.walls();
        for step in &steps {
            let clear = walls.iter().map(|wall| distance(wall, &step.pose)).fold(f64::INFINITY, f64::min);
            assert!(clear > 0.2, "{clear} m at {:?}", step.pose);
        }
        for crossing in building.aisles().crossings() {
            let place = building.aisles().place(crossing);
            // Corners are cut by (√2 − 1) of the turning circle, beside the play.
            assert!(steps.iter().any(|step| (step.pose.translation - place).norm() < 1.2), "{crossing:?}");
        }
    }
}

fn distance(wall: &wayfix_scene_sim::world::Wall, pose: &Pose2<f64>) -> f64 {
    let (side, off) = (wall.to - wall.from, pose.translation - wall.from);
    (off - side * (off.dot(&side) / side.norm_squared()).clamp(0.0, 1.0)).norm()
}

#[test]
fn calibrated_wheels_drift_by_what_is_said_of_them() {
    const N: u64 = 40;
    let building = area().building();
    let camera =
        OmniCameraParams { n_columns: 4, n_rings: 1, rays_per_pixel: [1, 1], ..OmniCameraParams::default() };
    let (mut squares, mut expected) = (0.0, 0.0);
    for seed in 0..N {
        let robot: WheeledRobotParams = calibrated_robot(&mut ChaCha8Rng::seed_from_u64(100 + seed));
        let steps =
            tour(&building, IndoorDriveParams { robot, camera, ..IndoorDriveParams::default() }, 100.0, seed);
        let headings = [0, steps.len() - 1].map(|k| steps[k].pose.heading());
        let turned: f64 = steps.iter().filter_map(|step| step.odometry).map(|moved| moved.heading()).sum();
        squares += Pose2::new(0.0, 0.0, turned - (headings[1] - headings[0])).heading().powi(2);
        // 10⁻⁴ rad/m over 100 m, 0.115° on the first metre growing with the root, and 0.3 % of what it turned.
        expected += 0.01_f64.powi(2) + 0.02_f64.powi(2) + (3e-3 * turned).powi(2);
    }
    // σ of the mean of 40 squares of Gaussian numbers is √(2/40) of it.
    assert!(
        abs_diff_eq!(squares / expected, 1.0, epsilon = 4.0 * (2.0 / N as f64).sqrt()),
        "{squares} {expected}"
    );
}

#[test]
fn rearranging_nothing_changes_nothing() {
    let store = area();
    assert_eq!(store.rearranged(0.0, &mut rng()).unwrap(), store);
    let (some, all) =
        (store.rearranged(0.2, &mut rng()).unwrap(), store.rearranged(1.0, &mut rng()).unwrap());
    let at = store.building().aisles().station();
    let view = |store: &RetailStore| look(&store.building(), at);
    assert!(difference(&view(&store), &view(&some)) < difference(&view(&store), &view(&all)));
}

#[test]
fn switching_changes_the_lab_and_leaves_the_default_alone() {
    let building = Laboratory::draw(&mut rng()).building();
    let creeping = WheeledRobotParams { speed_mps: 1e-4, ..IndoorDriveParams::default().robot };
    let change = |mean_lamp_switching_s| {
        let ambient_light = AmbientLightParams {
            mean_lamp_switching_s,
            daylight_log_sigma: 0.0,
            ..AmbientLightParams::default()
        };
        let params = IndoorDriveParams { robot: creeping, ambient_light, ..IndoorDriveParams::default() };
        let route = building.aisles().tour(1.0, &mut rng()).expect("there are aisles");
        let drive = IndoorDrive::new(&building, route, params, RandomStreams::new(rng())).expect("sound");
        let views: Vec<RgbPicture> = drive.take(120).map(|step| step.view).collect();
        difference(&views[0], &views[views.len() - 1])
    };
    assert!(change(Some(10.0)) > 2.0 * change(None), "{} {}", change(Some(10.0)), change(None));
}

#[test]
fn numbers_without_a_meaning_are_refused() {
    let building = area().building();
    let aisles = building.aisles();
    for length_m in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(aisles.tour(length_m, &mut rng()).is_err(), "{length_m}");
    }
    assert!(aisles.tour_from([99, 0], 10.0, &mut rng()).is_err() && aisles.laps(0, &mut rng()).is_err());
    for share in [-0.1, 1.1, f64::NAN] {
        assert!(
            area().rearranged(share, &mut rng()).is_err()
                && Laboratory::draw(&mut rng()).rearranged(share, &mut rng()).is_err()
        );
    }
    let good = RetailStoreParams::area();
    for bad in [
        RetailStoreParams { length_m: 5.0, ..good },
        RetailStoreParams { width_m: f64::NAN, ..good },
        RetailStoreParams { width_m: 3.0, ..good },
        RetailStoreParams { length_m: 1e6, ..good },
        RetailStoreParams { n_blocks: 0, ..good },
        RetailStoreParams { n_departments: 0, ..good },
        RetailStoreParams { shelf_height_m: -1.0, ..good },
        RetailStoreParams { end_display_share: 2.0, ..good },
    ] {
        assert!(RetailStore::draw(bad, &mut rng()).is_err(), "{bad:?}");
    }
    let camera = OmniCameraParams::default();
    for bad in [
        OmniCameraParams { n_columns: 0, ..camera },
        OmniCameraParams { n_columns: 121, ..camera },
        OmniCameraParams { n_rings: 0, ..camera },
        OmniCameraParams { rays_per_pixel: [0, 1], ..camera },
        OmniCameraParams { max_elevation_rad: 1.6, ..camera },
        OmniCameraParams { min_elevation_rad: f64::NAN, ..camera },
        OmniCameraParams { height_m: 9.0, ..camera },
        OmniCameraParams { pixel_noise_sigma: -1.0, ..camera },
    ] {
        assert!(building.render_view(&aisles.station(), bad, &mut rng()).is_err(), "{bad:?}");
    }
    assert!(building.render_view(&Pose2::new(f64::NAN, 0.0, 0.0), camera, &mut rng()).is_err());
    let standing = WheeledRobotParams { speed_mps: 0.0, ..WheeledRobotParams::default() };
    let params = IndoorDriveParams::default();
    for bad in [
        IndoorDriveParams { robot: standing, ..params },
        IndoorDriveParams { view_period_ms: 505, ..params },
        IndoorDriveParams { view_period_ms: 0, ..params },
        IndoorDriveParams { n_people: 1 << 20, ..params },
        IndoorDriveParams {
            ambient_light: AmbientLightParams {
                mean_lamp_switching_s: Some(0.0),
                ..AmbientLightParams::default()
            },
            ..params
        },
    ] {
        let route = aisles.tour(10.0, &mut rng()).unwrap();
        assert!(IndoorDrive::new(&building, route, bad, RandomStreams::new(rng())).is_err(), "{bad:?}");
    }
}
