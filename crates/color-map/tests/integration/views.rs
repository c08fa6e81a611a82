//! Views that can be computed by hand.

use std::sync::Arc;

use wayfix_color_map::{
    ColorId, ColorMap, ColoredShape, LabelImage, MapRenderer, PinholeCamera, PixelSpan, PostBand,
    nalgebra::{UnitQuaternion, Vector3},
};
use wayfix_estimation_traits::{LieGroup, Pose3};

const RED: ColorId = ColorId(0);
const BLUE: ColorId = ColorId(1);
const GREY: ColorId = ColorId(2);

fn map(shapes: Vec<ColoredShape>) -> Arc<ColorMap> {
    Arc::new(ColorMap::new(["red", "blue", "grey"].map(String::from).to_vec(), shapes).expect("a valid map"))
}

/// A board across the x axis, between two y and two z.
fn board(color: ColorId, x: f64, y: [f64; 2], z: [f64; 2]) -> ColoredShape {
    let corners = [[y[0], z[0]], [y[1], z[0]], [y[1], z[1]], [y[0], z[1]]];
    ColoredShape::Polygon { color, vertices: corners.map(|[y, z]| Vector3::new(x, y, z)).to_vec() }
}

/// A rectangle on the floor.
fn rug(color: ColorId, x: [f64; 2], y: [f64; 2]) -> ColoredShape {
    let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
    ColoredShape::Polygon { color, vertices: corners.map(|[x, y]| Vector3::new(x, y, 0.0)).to_vec() }
}

/// 100 pixels of focal length, the axis in the middle of 100 × 80 pixels.
fn camera() -> PinholeCamera {
    PinholeCamera::new(100, 80, 100.0, 100.0, 50.0, 40.0).expect("a valid camera")
}

fn see(map: &Arc<ColorMap>, pose: &Pose3<f64>) -> LabelImage {
    MapRenderer::new(Arc::clone(map), camera()).labels(pose).expect("a valid pose")
}

fn at(x: f64, y: f64, z: f64) -> Pose3<f64> {
    Pose3 { translation: Vector3::new(x, y, z), ..Pose3::identity() }
}

#[test]
fn a_wall_at_two_metres() {
    // u = 50 - 100 y / 2: y = 0.404 and -0.25 appear at 29.8 and 62.5; v = 40 - 100 z / 2: z = 0.31 and -0.4 at 24.5 and 60.
    // The first column with its centre at or right of 29.8 is 30, of 62.5 it is 62; the rows are 24 to 59.
    let map = map(vec![board(RED, 2.0, [-0.25, 0.404], [-0.4, 0.31])]);
    let mut spans = Vec::new();
    MapRenderer::new(map, camera()).spans(&Pose3::identity(), &mut |span| spans.push(span)).unwrap();
    let expected: Vec<_> = (24..60).map(|row| PixelSpan { row, start: 30, end: 62, color: RED }).collect();
    assert_eq!(spans, expected);
}

#[test]
fn the_camera_looks_where_its_pose_says() {
    // The wall of above is at y = 2 now, and a camera turned by 90° to the left sees the same.
    let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
    let corners = [[-0.404, -0.4], [0.25, -0.4], [0.25, 0.31], [-0.404, 0.31]];
    let vertices = corners.map(|[x, z]| Vector3::new(x, 2.0, z)).to_vec();
    let labels = see(
        &map(vec![ColoredShape::Polygon { color: RED, vertices }]),
        &Pose3 { rotation: turned, ..at(0.0, 0.0, 0.0) },
    );
    assert_eq!(labels.count(RED), 32 * 36);
    assert_eq!((labels.get(30, 40), labels.get(61, 40)), (Some(RED), Some(RED)));
    assert_eq!((labels.get(29, 40), labels.get(62, 40)), (None, None));
}

#[test]
fn what_is_nearer_hides_what_is_behind_in_any_order_of_the_map() {
    let near = board(RED, 2.0, [-0.2, 0.2], [-0.2, 0.2]);
    let far = board(BLUE, 4.0, [-0.8, 0.8], [-0.8, 0.8]);
    for shapes in [vec![near.clone(), far.clone()], vec![far, near]] {
        let labels = see(&map(shapes), &Pose3::identity());
        assert_eq!((labels.count(RED), labels.count(BLUE)), (20 * 20, 40 * 40 - 20 * 20));
    }
}

#[test]
fn of_two_decals_the_later_one_is_on_top_from_both_sides() {
    let big = board(RED, 2.0, [-0.6, 0.6], [-0.6, 0.6]);
    let small = board(BLUE, 2.0, [-0.2, 0.2], [-0.2, 0.2]);
    let from_behind = Pose3 {
        rotation: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI),
        ..at(4.0, 0.0, 0.0)
    };
    for pose in [Pose3::identity(), from_behind] {
        let labels = see(&map(vec![big.clone(), small.clone()]), &pose);
        assert_eq!((labels.count(RED), labels.count(BLUE)), (60 * 60 - 20 * 20, 20 * 20));
        let labels = see(&map(vec![small.clone(), big.clone()]), &pose);
        assert_eq!((labels.count(RED), labels.count(BLUE)), (60 * 60, 0));
    }
}

#[test]
fn floor_behind_the_camera_fills_rows_below_the_horizon() {
    // Half a metre above the floor; its far end, 10 m ahead, is at v = 40 + 100 * 0.5 / 10 = 45.
    let labels = see(&map(vec![rug(GREY, [-10.0, 10.0], [-20.0, 20.0])]), &at(0.0, 0.0, 0.5));
    assert_eq!(labels.count(GREY), 100 * (80 - 45));
    // From below, it is the rows above 35 instead.
    let labels = see(&map(vec![rug(GREY, [-10.0, 10.0], [-20.0, 20.0])]), &at(0.0, 0.0, -0.5));
    assert_eq!(labels.count(GREY), 100 * 35);
    // In the plane of the floor there is nothing to see.
    assert_eq!(see(&map(vec![rug(GREY, [-10.0, 10.0], [-20.0, 20.0])]), &at(0.0, 0.0, 0.0)).count(GREY), 0);
}

#[test]
fn what_is_behind_beside_and_above_is_not_seen() {
    let behind = board(RED, -2.0, [-1.0, 1.0], [-1.0, 1.0]);
    let beside = board(RED, 2.0, [1.01, 3.0], [-1.0, 1.0]); // the image ends at y = 1
    let above = board(RED, 2.0, [-1.0, 1.0], [0.81, 3.0]); // and at z = 0.8
    let labels = see(&map(vec![behind, beside, above]), &Pose3::identity());
    assert_eq!(labels.count(RED), 0);
}

#[test]
fn bands_of_a_post_are_above_each_other() {
    let bands =
        vec![PostBand { color: RED, from: 0.0, to: 0.2 }, PostBand { color: BLUE, from: 0.2, to: 0.4 }];
    let post = ColoredShape::Post { x: 1.0, y: 0.0, radius: 0.05, bands };
    let labels = see(&map(vec![post]), &at(0.0, 0.0, 0.2));
    // The border is at the eye's height: the horizon. Half the width, at the silhouette, is 100 tan(asin(0.05)) = 5.006 for the cylinder; the
    // prism that stands for it lies within 0.7 % outside and 1.3 % inside of that: 4.94 to 5.04, which covers the same pixel centres.
    for (row, color) in [(39, BLUE), (40, RED)] {
        let columns: Vec<u32> = (0..100).filter(|&column| labels.get(column, row) == Some(color)).collect();
        assert_eq!(columns, (45..55).collect::<Vec<_>>(), "row {row}");
    }
    // Its ends are at v = 40 -+ 100 * 0.2 / depth, with the rim's depth between 0.95 and 1.05.
    let rows: Vec<u32> = (0..80).filter(|&row| labels.get(50, row).is_some()).collect();
    assert_eq!(rows, (19..61).collect::<Vec<_>>());
}

#[test]
fn a_post_is_not_seen_from_inside() {
    let bands = vec![PostBand { color: RED, from: 0.0, to: 1.0 }];
    let labels =
        see(&map(vec![ColoredShape::Post { x: 0.0, y: 0.0, radius: 0.3, bands }]), &at(0.0, 0.0, 0.5));
    assert_eq!(labels.count(RED), 0);
}

#[test]
fn a_wide_image_is_covered_across_its_words() {
    let camera = PinholeCamera::new(16384, 2, 100.0, 100.0, 8192.0, 1.0).unwrap();
    let map =
        map(vec![board(RED, 1.0, [-200.0, 200.0], [-1.0, 1.0]), board(BLUE, 0.5, [-0.1, 0.1], [-1.0, 1.0])]);
    let labels = MapRenderer::new(map, camera).labels(&Pose3::identity()).unwrap();
    assert_eq!((labels.count(BLUE), labels.count(RED)), (2 * 40, 2 * (16384 - 40)));
}

#[test]
fn a_renderer_remembers_nothing_of_the_last_view() {
    let map = map(vec![rug(GREY, [-2.0, 2.0], [-2.0, 2.0]), board(RED, 1.0, [-0.5, 0.5], [0.0, 0.5])]);
    let mut renderer = MapRenderer::new(Arc::clone(&map), camera());
    let first = renderer.labels(&at(0.0, 0.1, 0.3)).unwrap();
    renderer.labels(&at(-1.0, 0.0, 0.4)).unwrap();
    assert_eq!(renderer.labels(&at(0.0, 0.1, 0.3)).unwrap(), first);
}
