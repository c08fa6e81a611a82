use nalgebra::{Vector2, Vector3};
use rand::Rng;
use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PostBand};

use crate::SimulationError;
use crate::random::deviate::uniform;

/// The map colours, in the order of their [`ColorId`]s.
pub const COLOR_NAMES: [&str; 5] = ["green", "white", "yellow", "cyan", "pink"];
/// Number of map colours.
pub const N_COLORS: usize = COLOR_NAMES.len();

pub(super) const GREEN: ColorId = ColorId(0);
pub(super) const WHITE: ColorId = ColorId(1);
const YELLOW: ColorId = ColorId(2);
const CYAN: ColorId = ColorId(3);
const PINK: ColorId = ColorId(4);

/// Half the length and half the width of the carpet inside the boards, metres.
pub(super) const HALF_LENGTH_M: f64 = 2.1;
pub(super) const HALF_WIDTH_M: f64 = 1.35;
const CORNER_M: f64 = 0.25;
const BOARD_M: f64 = 0.1;
const LINE_M: f64 = 0.025;
const CIRCLE_M: f64 = 0.18;
const CIRCLE_PIECES: usize = 16;
const PENALTY_DEPTH_M: f64 = 0.5;
const PENALTY_HALF_WIDTH_M: f64 = 0.65;
const GOAL_HALF_WIDTH_M: f64 = 0.3;
const GOAL_DEPTH_M: f64 = 0.3;
const GOAL_M: f64 = 0.3;
const BEACON_RADIUS_M: f64 = 0.05;

/// The field of the four-legged league in the manner of its rules of 2003: six beacons, boards all round, sky-blue goal at positive x.
///
/// Carpet of 4.2 × 2.7 m with its corners cut off, boards 0.1 m high, goals 0.6 m wide and 0.3 m high and deep, lines 25 mm
/// wide, a centre circle of 0.36 m diameter, beacons 0.1 m thick and 0.4 m high. Their upper halves are two bands: pink, and the
/// colour of the near goal or, on the half-way line, green; pink is on top at negative y. Boards are upright here (the rules
/// lean them), and the field is a model of no particular venue.
///
/// ```
/// let map = wayfix_scene_sim::league::field_map()?;
/// assert_eq!(map.colors(), wayfix_scene_sim::league::COLOR_NAMES);
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
///
/// # Errors
/// Returns the errors of the map; none occur, because the shapes are constant.
pub fn field_map() -> Result<ColorMap, SimulationError> {
    let mut shapes = carpet();
    shapes.extend(lines());
    shapes.extend(boards());
    shapes.extend([-1.0, 1.0].into_iter().flat_map(goal));
    shapes.extend(beacons());
    Ok(ColorMap::new(COLOR_NAMES.map(str::to_owned).to_vec(), shapes)?)
}

/// Distinctive points for the camera to point at: the middles of the beacons' bands and of the goals, m.
pub fn landmarks() -> Vec<Vector3<f64>> {
    let beacons = beacon_places().map(|(x, y)| Vector3::new(x, y, 0.3));
    let goals = [-1.0, 1.0].map(|side| Vector3::new(side * (HALF_LENGTH_M + GOAL_DEPTH_M), 0.0, 0.15));
    beacons.into_iter().chain(goals).collect()
}

/// Anywhere on the carpet, at least `margin_m` from the boards.
pub(super) fn spot<R: Rng + ?Sized>(margin_m: f64, rng: &mut R) -> Vector2<f64> {
    let mut within = |half: f64| uniform(margin_m - half, half - margin_m, rng);
    Vector2::new(within(HALF_LENGTH_M), within(HALF_WIDTH_M))
}

fn polygon(color: ColorId, corners: &[[f64; 3]]) -> ColoredShape {
    ColoredShape::Polygon { color, vertices: corners.iter().map(|&c| Vector3::from(c)).collect() }
}

/// A rectangle on the ground.
fn flat(color: ColorId, x: [f64; 2], y: [f64; 2]) -> ColoredShape {
    polygon(color, &[[x[0], y[0], 0.0], [x[1], y[0], 0.0], [x[1], y[1], 0.0], [x[0], y[1], 0.0]])
}

/// An upright rectangle from the ground up.
fn upright(color: ColorId, from: [f64; 2], to: [f64; 2], height: f64) -> ColoredShape {
    let [[ax, ay], [bx, by]] = [from, to];
    polygon(color, &[[ax, ay, 0.0], [bx, by, 0.0], [bx, by, height], [ax, ay, height]])
}

fn carpet() -> Vec<ColoredShape> {
    let (x, y, cut) = (HALF_LENGTH_M, HALF_WIDTH_M, CORNER_M);
    let corners = [
        [x, cut - y, 0.0],
        [x, y - cut, 0.0],
        [x - cut, y, 0.0],
        [cut - x, y, 0.0],
        [-x, y - cut, 0.0],
        [-x, cut - y, 0.0],
        [cut - x, -y, 0.0],
        [x - cut, -y, 0.0],
    ];
    let in_goal = |side: f64| {
        let (near, far) = (side * x, side * (x + GOAL_DEPTH_M));
        flat(GREEN, [near.min(far), near.max(far)], [-GOAL_HALF_WIDTH_M, GOAL_HALF_WIDTH_M])
    };
    vec![polygon(GREEN, &corners), in_goal(-1.0), in_goal(1.0)]
}

fn lines() -> Vec<ColoredShape> {
    let half = 0.5 * LINE_M;
    let mut lines = vec![flat(WHITE, [-half, half], [-HALF_WIDTH_M, HALF_WIDTH_M])];
    lines.extend((0..CIRCLE_PIECES).map(circle_piece));
    for side in [-1.0, 1.0] {
        let across = |x: f64, half_width: f64| {
            flat(WHITE, [side * x - half, side * x + half], [-half_width, half_width])
        };
        lines.push(across(HALF_LENGTH_M - half, GOAL_HALF_WIDTH_M));
        let front = HALF_LENGTH_M - PENALTY_DEPTH_M;
        lines.push(across(front, PENALTY_HALF_WIDTH_M + half));
        let ends = [side * front, side * HALF_LENGTH_M];
        let x = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        for y in [-PENALTY_HALF_WIDTH_M, PENALTY_HALF_WIDTH_M] {
            lines.push(flat(WHITE, x, [y - half, y + half]));
        }
    }
    lines
}

fn circle_piece(idx: usize) -> ColoredShape {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / CIRCLE_PIECES as f64;
    let at = |k: usize, radius: f64| {
        let (sin, cos) = libm::sincos(angle(k));
        [radius * cos, radius * sin, 0.0]
    };
    let (inner, outer) = (CIRCLE_M - 0.5 * LINE_M, CIRCLE_M + 0.5 * LINE_M);
    polygon(WHITE, &[at(idx, inner), at(idx, outer), at(idx + 1, outer), at(idx + 1, inner)])
}

fn boards() -> Vec<ColoredShape> {
    let (x, y, cut, goal) = (HALF_LENGTH_M, HALF_WIDTH_M, CORNER_M, GOAL_HALF_WIDTH_M);
    let board = |from, to| upright(WHITE, from, to, BOARD_M);
    let mut boards = Vec::new();
    for side in [-1.0, 1.0] {
        boards.push(board([cut - x, side * y], [x - cut, side * y]));
        for end in [-1.0, 1.0] {
            boards.push(board([side * x, end * goal], [side * x, end * (y - cut)]));
            boards.push(board([side * x, end * (y - cut)], [side * (x - cut), end * y]));
        }
    }
    boards
}

fn goal(side: f64) -> [ColoredShape; 3] {
    let color = goal_color(side);
    let (mouth, back, y) = (side * HALF_LENGTH_M, side * (HALF_LENGTH_M + GOAL_DEPTH_M), GOAL_HALF_WIDTH_M);
    [
        upright(color, [back, -y], [back, y], GOAL_M),
        upright(color, [mouth, -y], [back, -y], GOAL_M),
        upright(color, [mouth, y], [back, y], GOAL_M),
    ]
}

fn goal_color(side: f64) -> ColorId {
    if side > 0.0 { CYAN } else { YELLOW }
}

/// Three on either side, just behind the boards.
fn beacon_places() -> [(f64, f64); 6] {
    let (x, y) = (HALF_LENGTH_M + 0.05, HALF_WIDTH_M + 0.07);
    [(-x, -y), (0.0, -y), (x, -y), (-x, y), (0.0, y), (x, y)]
}

fn beacons() -> impl Iterator<Item = ColoredShape> {
    beacon_places().into_iter().map(|(x, y)| {
        let own = if x == 0.0 { GREEN } else { goal_color(x) };
        let (low, high) = if y < 0.0 { (own, PINK) } else { (PINK, own) };
        let band = |color, from, to| PostBand { color, from, to };
        let bands = vec![band(WHITE, 0.0, 0.2), band(low, 0.2, 0.3), band(high, 0.3, 0.4)];
        ColoredShape::Post { x, y, radius: BEACON_RADIUS_M, bands }
    })
}
