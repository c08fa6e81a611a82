//! The renderer against rays cast one by one, which share no code with it beyond the map's planes: every pixel of every view must agree.
//!
//! They may differ where a ray passes an edge within rounding. Poses are drawn from continuous distributions, and of some 10⁷ pixels none comes
//! that close: so the tests ask for equality, without an allowance. A pose on a grid is another matter: see `on_a_grid`.

use std::sync::Arc;

use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_color_map::{
    ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera, PostBand,
    nalgebra::{Quaternion, UnitQuaternion, Vector3},
};
use wayfix_estimation_traits::{LieGroup, Pose3};

use crate::support::{cast_labels, first_difference, random_camera, random_pose};

const N_COLORS: u8 = 7;

fn names() -> Vec<String> {
    (0..N_COLORS).map(|i| i.to_string()).collect()
}

/// Compares `n` random views from within `reach` and returns the share of labelled pixels.
fn compare(map: &Arc<ColorMap>, n: usize, reach: f64, rng: &mut ChaCha8Rng) -> f64 {
    let (mut n_labelled, mut n_pixels) = (0, 0);
    for i in 0..n {
        let camera = random_camera(rng);
        let pose = random_pose(rng, reach);
        let got = MapRenderer::new(Arc::clone(map), camera).labels(&pose).expect("a valid pose");
        let expected = cast_labels(map, &camera, &pose);
        assert_eq!(first_difference(&got, &expected), None, "view {i}: {pose:?} {camera:?}");
        n_labelled += got.pixels().iter().flatten().count();
        n_pixels += got.pixels().len();
    }
    n_labelled as f64 / n_pixels as f64
}

#[cfg(feature = "serde")]
#[test]
fn the_field_from_within_around_and_below() {
    let map = Arc::new(crate::support::field());
    let share = compare(&map, 2000, 3.0, &mut ChaCha8Rng::seed_from_u64(41));
    assert!(share > 0.1, "too little to see to say anything: {share}");
}

/// Triangles through each other everywhere: each is cut by many planes.
#[test]
fn surfaces_that_pierce_each_other() {
    let mut rng = ChaCha8Rng::seed_from_u64(44);
    for n in [2, 5, 30] {
        let mut shapes = Vec::new();
        for i in 0..n {
            let mut corner = || Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let vertices = vec![corner(), corner(), corner()];
            shapes.push(ColoredShape::Polygon { color: ColorId(i % N_COLORS), vertices });
        }
        let map = Arc::new(ColorMap::new(names(), shapes).unwrap());
        let share = compare(&map, 150, 1.5, &mut rng);
        assert!(share > 0.02, "{n} triangles: {share}");
    }
}

/// Three boards of which each hides a part of the next one, all the way round: no order of whole boards is right.
#[test]
fn a_cycle_of_hiding() {
    let board = |color, turn: f64| {
        let (sin, cos) = turn.sin_cos();
        let corner = |x: f64, y: f64, z: f64| Vector3::new(x * cos - y * sin, x * sin + y * cos, z);
        let vertices = vec![
            corner(-1.5, 0.4, 0.5),
            corner(1.5, 0.4, -0.5),
            corner(1.5, 0.8, -0.5),
            corner(-1.5, 0.8, 0.5),
        ];
        ColoredShape::Polygon { color: ColorId(color), vertices }
    };
    let third = std::f64::consts::TAU / 3.0;
    let shapes = vec![board(0, 0.0), board(1, third), board(2, 2.0 * third)];
    let map = Arc::new(ColorMap::new(names(), shapes).unwrap());
    assert!(compare(&map, 300, 3.0, &mut ChaCha8Rng::seed_from_u64(45)) > 0.02);
}

/// Posts of all sizes in the midst of a slanted board, a floor and a table: cut, and from inside, above and below.
#[test]
fn posts_cut_by_planes() {
    let mut rng = ChaCha8Rng::seed_from_u64(46);
    let mut shapes = Vec::new();
    let square = |color, z: f64, slope: f64| ColoredShape::Polygon {
        color: ColorId(color),
        vertices: [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| Vector3::new(x, y, z + slope * x))
            .to_vec(),
    };
    shapes.extend([square(0, 0.0, 0.0), square(1, 0.3, 0.0), square(2, 0.2, 0.7)]);
    for (i, (x, y)) in [(-0.8, 0.1), (0.5, 0.5), (0.1, -0.6), (1.0, -0.2)].into_iter().enumerate() {
        let color = |k: usize| ColorId(3 + ((i + k) % 4) as u8);
        let mut z = rng.random_range(-0.3..0.1);
        let mut band = |k| {
            let from = z + if k == 2 { 0.1 } else { 0.0 };
            z = from + rng.random_range(0.05..0.4);
            PostBand { color: color(k), from, to: z }
        };
        let bands = vec![band(0), band(1), band(2)];
        shapes.push(ColoredShape::Post { x, y, radius: rng.random_range(0.05..0.3), bands });
    }
    let map = Arc::new(ColorMap::new(names(), shapes).unwrap());
    assert!(compare(&map, 600, 1.5, &mut rng) > 0.2);
}

/// Where rays hit edges exactly, the two may take different sides. So the same view is drawn from a hair's breadth around it: a pixel
/// that shows one colour from all of them must show it from the grid, too.
#[test]
fn on_a_grid() {
    let board = |color, x: f64, y: f64, z: f64| ColoredShape::Polygon {
        color: ColorId(color),
        vertices: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
            .map(|[right, up]| Vector3::new(x, y - right, z + up))
            .to_vec(),
    };
    // Four boards that share edges, and one behind them: a gap between two would show it.
    let front = [
        board(0, 2.0, 1.0, 0.0),
        board(1, 2.0, 0.0, 0.0),
        board(2, 2.0, 1.0, -1.0),
        board(3, 2.0, 0.0, -1.0),
    ];
    let mut shapes = front.to_vec();
    shapes.push(ColoredShape::Polygon {
        color: ColorId(4),
        vertices: [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]]
            .map(|[y, z]| Vector3::new(4.0, y, z))
            .to_vec(),
    });
    let map = Arc::new(ColorMap::new(names(), shapes).unwrap());
    // Pixel centres at multiples of 1/8 m on the front boards.
    let camera = PinholeCamera::new(33, 33, 16.0, 16.0, 16.5, 16.5).unwrap();
    let mut renderer = MapRenderer::new(Arc::clone(&map), camera);
    for (y, z) in [(0.0, 0.0), (0.125, 0.0), (0.0, -0.25), (0.5, 0.125)] {
        let labels_at = |dy: f64, dz: f64, renderer: &mut MapRenderer| {
            let pose = Pose3 { translation: Vector3::new(0.0, y + dy, z + dz), ..Pose3::identity() };
            renderer.labels(&pose).unwrap()
        };
        let exact = labels_at(0.0, 0.0, &mut renderer);
        let around = [(1e-9, 1e-9), (-1e-9, 1e-9), (1e-9, -1e-9), (-1e-9, -1e-9)]
            .map(|(dy, dz)| labels_at(dy, dz, &mut renderer));
        for (i, label) in exact.pixels().iter().enumerate() {
            assert!(around.iter().any(|labels| labels.pixels()[i] == *label), "pixel {i} from {y}, {z}");
        }
        // 16 x 16 pixels with a centre on the boards, or one more where both borders go through centres: to the left and top they count.
        let n_front: usize = (0..4).map(|color| exact.count(ColorId(color))).sum();
        assert_eq!(n_front, 16 * 16);
    }
}

/// A floor that walls cut into many pieces stays one floor: nothing shows through the seams, not even where a ray hits one exactly.
#[test]
fn no_gap_between_the_pieces_of_a_surface() {
    let mut shapes = vec![ColoredShape::Polygon {
        color: ColorId(0),
        vertices: [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]]
            .map(|[x, y]| Vector3::new(x, y, 0.0))
            .to_vec(),
    }];
    // Short pieces of wall through the floor, whose planes go on to the floor's ends.
    for i in 0..6 {
        let at = f64::from(i) * 0.375 - 1.0;
        for (x, y) in [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8)] {
            let corner = |along: f64, z: f64| Vector3::new(at * y + along * x, at * x - along * y, z);
            let vertices = vec![corner(2.5, -0.1), corner(2.6, -0.1), corner(2.6, 0.1), corner(2.5, 0.1)];
            shapes.push(ColoredShape::Polygon { color: ColorId(1), vertices });
        }
    }
    let map = Arc::new(ColorMap::new(names(), shapes).unwrap());
    let camera = PinholeCamera::new(97, 65, 16.0, 16.0, 48.5, 32.5).unwrap();
    let mut renderer = MapRenderer::new(map, camera);
    let mut rng = ChaCha8Rng::seed_from_u64(47);
    // Straight down on a camera whose rays hit multiples of 1/16 m, of 1/8 m, and between.
    let down = Quaternion::new(1.0, 0.0, 1.0, 0.0);
    for i in 0..400 {
        let roll = if i < 100 { 0.0 } else { rng.random_range(-0.3..0.3) };
        let rotation = UnitQuaternion::from_quaternion(down * Quaternion::new(1.0, roll, 0.0, 0.0));
        let cell = |n: i32| f64::from(n) / 16.0;
        let translation = Vector3::new(cell(i % 10), cell(i / 10 % 10), if i % 2 == 0 { 1.0 } else { 0.5 });
        let labels = renderer.labels(&Pose3 { translation, rotation }).unwrap();
        let gaps = labels.pixels().iter().filter(|label| label.is_none()).count();
        assert_eq!(gaps, 0, "view {i}");
    }
}

/// Axis-parallel boxes on a grid of cells, so that they are disjoint, on a floor.
fn boxes() -> impl Strategy<Value = ColorMap> {
    let cell = (0.05..0.95, 0.05..0.95, 0.1..0.9, 0.05..1.5, any::<bool>());
    prop::collection::vec(cell, 1..10).prop_map(|cells| {
        let mut shapes = vec![ColoredShape::Polygon {
            color: ColorId(0),
            vertices: [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]
                .map(|[x, y]| Vector3::new(x, y, 0.0))
                .to_vec(),
        }];
        for (i, (width, depth, place, height, round)) in cells.into_iter().enumerate() {
            let corner = Vector3::new((i % 3) as f64 - 1.5, (i / 3) as f64 - 1.5, 0.0);
            let size = Vector3::new(width, depth, height);
            let color = |face: usize| ColorId(1 + ((i + face) % 6) as u8);
            if round {
                let radius = 0.4 * place;
                let bands = vec![PostBand { color: color(0), from: 0.0, to: height }];
                shapes.push(ColoredShape::Post { x: corner.x + 0.5, y: corner.y + 0.5, radius, bands });
                continue;
            }
            for axis in 0..3 {
                for far in [false, true] {
                    let vertices = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| {
                        let mut share = Vector3::zeros();
                        share[axis] = f64::from(u8::from(far));
                        (share[(axis + 1) % 3], share[(axis + 2) % 3]) = (a, b);
                        corner + size.component_mul(&share)
                    });
                    shapes.push(ColoredShape::Polygon {
                        color: color(axis * 2 + usize::from(far)),
                        vertices: vertices.to_vec(),
                    });
                }
            }
        }
        ColorMap::new(names(), shapes).expect("boxes in cells of their own")
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_boxes_and_posts(
        map in boxes(),
        at in prop::array::uniform3(-2.5..2.5),
        turn in prop::array::uniform4(0.01..1.0_f64),
        signs in prop::array::uniform4(any::<bool>()),
    ) {
        let [w, i, j, k]: [f64; 4] = std::array::from_fn(|n| if signs[n] { turn[n] } else { -turn[n] });
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
        let pose = Pose3 { translation: Vector3::from(at), rotation };
        let camera = PinholeCamera::from_field_of_view(70, 50, 1.3, 1.0).unwrap();
        let map = Arc::new(map);
        let got = MapRenderer::new(Arc::clone(&map), camera).labels(&pose).unwrap();
        prop_assert_eq!(first_difference(&got, &cast_labels(&map, &camera, &pose)), None);
    }
}
